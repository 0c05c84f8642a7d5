//! `render`: frames and film of a scene or a stored trajectory, without the cross-check.

use super::case_args::SceneArgs;
use super::common::{Common, Document, print, refuse_existing};
use super::draw_args::DrawArgs;
use super::film;
use super::progress::Progress;
use super::run::default_directory;
use super::shown::Shown;
use super::trajectory_table::from_table;
use super::{Verdict, motions};
use crate::film::encode_png;
use crate::render::shrunk;
use crate::scene::{Case, Film};
use crate::stage::Solution;
use crate::store::{Existing, Origin, OutputDir, read_table, read_whole, sha256_hex, write_atomically};
use anyhow::{Context, ensure};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// A period of 2 pi has some 25 samples then; fewer show corners that are not there.
const COARSEST_SAMPLE: f64 = 0.25;

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Solver {
    Exact,
    Rapier,
}

/// Make frames and film of a scene or a stored trajectory. Finished frames are kept and not drawn again.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  stickslip render scenes/chaos.toml --with exact -o renders/chaos\n  \
    stickslip simulate --xi1 -0.1 --sample 0.04 -o t.csv && stickslip render --trajectory t.csv -o renders/t\n  \
    stickslip render scenes/chaos.toml --at 42.5 --size 3840x2160 -o chaos.png")]
pub struct RenderArgs {
    #[command(flatten)]
    input: SceneArgs,
    /// A trajectory written by `simulate`, in place of a scene.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scene", "solver", "xi1", "xi2", "kappa", "gamma", "precision", "joints", "scheme", "substeps", "steps_per_period", "dt"])]
    trajectory: Option<PathBuf>,
    /// Which solution to show.
    #[arg(long = "with", id = "solver", value_enum, default_value_t = Solver::Rapier)]
    solver: Solver,
    /// Draw only the picture at this time of the motion, in the units of the scene, and write it to -o.
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, conflicts_with_all = ["frames", "shard", "encoder"])]
    at: Option<f64>,
    #[command(flatten)]
    draw: DrawArgs,
    #[command(flatten)]
    common: Common,
}

pub fn run(args: &RenderArgs) -> anyhow::Result<Verdict> {
    let mut progress = Progress::new(args.common.quiet);
    let (case, stored) = match &args.trajectory {
        Some(path) => args.stored(path).map(|(case, shown)| (case, Some(shown)))?,
        None => (args.input.case()?, None),
    };
    // Computed only after all that can be refused without.
    let shown = || stored.map_or_else(|| args.computed(&case), Ok);
    let parameters = args.parameters(&case)?;
    if let Some(time) = args.at {
        return args.still(&case, shown, (time, parameters), &progress);
    }
    args.draw.check(case.frame_count())?;
    let input = args.input.scene.as_deref().or(args.trajectory.as_deref());
    // The plain name belongs to `run`.
    let directory =
        args.common.output.clone().unwrap_or_else(|| default_directory(input, &format!("-{}", args.solution_name())));
    let existing = if args.common.force { Existing::Replace } else { Existing::Resume };
    let names = film::file_names(&case.film, &args.draw, case.frame_count());
    let mut renderer = film::renderer(&args.draw.picture, &progress)?;
    let output = OutputDir::open_for(&directory, &Origin::new("render", parameters.clone()), existing, &names)?;
    let stage = shown()?.stage(&case, args.draw.picture.supersample, &progress)?;
    let made = film::make(vec![stage], &case.film, &args.draw, &output, renderer.as_mut(), &mut progress)?;
    if args.common.json {
        let document =
            Document::new("render", parameters).with("frames", made.frames_json()).with("files", json!(output.files()));
        print(&document.text()?)?;
    } else {
        print(&format!("{}", made.report.film.as_deref().unwrap_or(&directory).display()))?;
    }
    Ok(Verdict::Done)
}

impl RenderArgs {
    fn solution_name(&self) -> &'static str {
        match (&self.trajectory, self.solver) {
            (Some(_), _) => "stored",
            (None, Solver::Exact) => "exact",
            (None, Solver::Rapier) => "rapier",
        }
    }

    /// What the pictures were made with.
    fn parameters(&self, case: &Case) -> anyhow::Result<Value> {
        // Two trajectories of one case differ by how they were computed: the bytes tell.
        let stored = self.trajectory.as_deref().map(|path| anyhow::Ok(sha256_hex(&read_whole(path)?))).transpose()?;
        let with = self.solution_name();
        Ok(json!({ "case": case, "with": with, "trajectory": self.trajectory, "trajectory_sha256": stored }))
    }

    /// `--at`: one picture.
    fn still(
        &self,
        case: &Case,
        shown: impl FnOnce() -> anyhow::Result<Shown>,
        (time, mut parameters): (f64, Value),
        progress: &Progress,
    ) -> anyhow::Result<Verdict> {
        let path = self.common.output.as_deref().context("--at needs -o FILE.png: where the picture goes")?;
        ensure!(
            path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")),
            "{} is no PNG file: end its name in .png",
            path.display()
        );
        refuse_existing(path, self.common.force)?;
        let scale = case.scales.time;
        let check = |end: f64| {
            ensure!(
                (0.0..=end).contains(&(time / scale)),
                "--at {time} is not in the motion: it lasts from 0 to {}",
                end * scale
            );
            Ok(())
        };
        // Before the motion is computed, and again of the motion, which may have ended early.
        check(case.duration)?;
        let mut renderer = film::renderer(&self.draw.picture, progress)?;
        let stage = shown()?.stage(case, self.draw.picture.supersample, progress)?;
        check(stage.end())?;
        let (image, _) = renderer.draw(&stage.frame_at(time / scale))?;
        let bytes =
            encode_png(&shrunk(&image, self.draw.picture.supersample)).context("the picture could not be encoded")?;
        write_atomically(path, |writer| writer.write_all(&bytes))?;
        if self.common.json {
            parameters["at"] = json!(time);
            print(&Document::new("render", parameters).with("files", json!([path])).text()?)?;
        } else {
            print(&path.display().to_string())?;
        }
        Ok(Verdict::Done)
    }

    fn computed(&self, case: &Case) -> anyhow::Result<Shown> {
        let (start, sampling) = (motions::start(case)?, motions::film_sampling(case));
        match self.solver {
            Solver::Exact => Shown::of(case, &motions::exactly(case, &start, sampling)?, Solution::Exact),
            Solver::Rapier => Shown::of_engine(case, &motions::in_engine(case, &start, sampling)?),
        }
    }

    fn stored(&self, path: &Path) -> anyhow::Result<(Case, Shown)> {
        let fault = || format!("trajectory {}", path.display());
        let (case, trajectory) = from_table(&read_table(path)?).with_context(fault)?;
        ensure!(
            self.input.film.t_end.is_none(),
            "--t-end cannot change a stored trajectory: give it to `simulate`, or a scene to `render`"
        );
        let coarsest = trajectory.samples.windows(2).map(|w| w[1].time - w[0].time).fold(0.0, f64::max);
        ensure!(
            coarsest <= COARSEST_SAMPLE,
            "{} has samples {coarsest} apart, too coarse to show the motion: at most {COARSEST_SAMPLE} non-dimensional time units; make it with --sample 0.05",
            path.display()
        );
        let mut film = Film { speed: Film::default().speed * case.scales.time, ..Film::default() };
        [film.width, film.height] = self.input.film.size.unwrap_or([film.width, film.height]);
        film.fps = self.input.film.fps.unwrap_or(film.fps);
        film.speed = self.input.film.speed.unwrap_or(film.speed);
        film.theme = self.input.film.theme.unwrap_or(film.theme);
        film.background = self.input.film.background.unwrap_or(film.background);
        let case = case.refilmed(film, &path.display().to_string())?;
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let shown = Shown::of(&case, &trajectory, Solution::Stored(name.into_owned()))?;
        Ok((case, shown))
    }
}
