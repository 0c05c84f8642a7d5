//! `run --story`: several scenes simulated, checked and filmed as one film with cuts.

use super::Verdict;
use super::common::{Document, print};
use super::film::{self, Made};
use super::progress::Progress;
use super::run::{Checked, DOCUMENT, RunArgs};
use crate::scene::{Case, Story};
use crate::store::{Existing, Origin, OutputDir};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// `story` names the file; the built-in one without it.
pub fn run(args: &RunArgs, story: Option<&Path>) -> anyhow::Result<Verdict> {
    let mut progress = Progress::new(args.common.quiet);
    let cases = cases(args, story)?;
    let most = cases.iter().map(Case::frame_count).sum();
    args.draw.check(most)?;
    let parts: Vec<Value> = cases.iter().map(Checked::parameters).collect();
    let parameters = json!({ "story": parts });
    let name = story.and_then(Path::file_stem).map_or("story".into(), |stem| stem.to_string_lossy());
    let directory = args.common.output.clone().unwrap_or_else(|| PathBuf::from("renders").join(&*name));
    let existing = if args.common.force { Existing::Replace } else { Existing::Resume };
    let mut names = film::file_names(&cases[0].film, &args.draw, most);
    names.extend(
        (1..=cases.len()).flat_map(|number| Checked::table_names(&prefix(number))).chain([DOCUMENT.to_owned()]),
    );
    let mut renderer = film::renderer(&args.draw.picture, &progress)?;
    let output = OutputDir::open_for(&directory, &Origin::new("story", parameters.clone()), existing, &names)?;

    let (mut stages, mut results, mut passed) = (Vec::new(), Vec::new(), true);
    for (number, case) in cases.iter().enumerate() {
        let checked = Checked::new(case)?;
        progress.say(&format!("scene {}, {}: {}", number + 1, case.title, checked.verdict_line()));
        checked.write_trajectories(case, &output, &prefix(number + 1))?;
        passed &= checked.agreement.passed;
        results.push(json!({ "title": case.title, "engine": checked.engine_json(), "agreement": checked.agreement }));
        stages.push(checked.shown(case)?.stage(case, args.draw.picture.supersample, &progress)?);
    }
    let made = film::make(stages, &cases[0].film, &args.draw, &output, renderer.as_mut(), &mut progress)?;
    let document = document(parameters, results, &made, &output)?;
    if args.common.json {
        print(&document)?;
    } else {
        print(&format!(
            "{} scenes, agreement with the exact solution {}\n{}",
            cases.len(),
            if passed { "passed" } else { "FAILED" },
            made.report.film.as_deref().unwrap_or(&directory).display()
        ))?;
    }
    Ok(if passed { Verdict::Done } else { Verdict::Failed })
}

/// How the names of a scene's files begin; scenes are counted from 1.
fn prefix(number: usize) -> String {
    format!("{number}-")
}

fn cases(args: &RunArgs, path: Option<&Path>) -> anyhow::Result<Vec<Case>> {
    let mut story = match path {
        Some(path) => Story::load(path)?,
        None => Story::built_in()?,
    };
    story.scene.iter_mut().for_each(|scene| args.input.film.apply(scene));
    let origin = path.map_or_else(|| "built-in story".to_owned(), |path| path.display().to_string());
    Ok(story.cases(&origin)?)
}

/// Writes [`DOCUMENT`] and returns it.
fn document(parameters: Value, scenes: Vec<Value>, made: &Made, output: &OutputDir) -> anyhow::Result<String> {
    let document = Document::new("run", parameters)
        .with("scenes", json!(scenes))
        .with("frames", made.frames_json())
        .with("files", json!(super::run::files_with(output, DOCUMENT)));
    let text = document.text()?;
    output.write(DOCUMENT, "", |writer| writeln!(writer, "{text}"))?;
    Ok(text)
}
