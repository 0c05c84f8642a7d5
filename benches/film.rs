//! Frames per second of the built-in scene at 1280x720 with the CPU rasteriser, and where the time goes: simulate, draw, read back,
//! overlay, encode. `cargo bench --bench film`

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use stickslip::dynamics::{Flow, Sampling, State, Trajectory};
use stickslip::engine::{EngineFlow, EngineSettings};
use stickslip::film::{FilmReport, FilmSettings, FrameSource, SourceError, Video, produce};
use stickslip::model::TwoMassRig;
use stickslip::render::{DrawList, RendererChoice};
use stickslip::scene::{Case, Initial, Scene};
use stickslip::stage::{Beside, Motion, Stage};
use stickslip::store::{Existing, Origin, OutputDir};

const FRAMES: u64 = 24;

struct Source(Stage);

impl FrameSource for Source {
    fn count(&self) -> u64 {
        FRAMES
    }

    /// From the middle of the film, where the plots are full.
    fn frame(&self, index: u64) -> Result<DrawList, SourceError> {
        Ok(self.0.frame(300 + index))
    }
}

/// The motion of the film, as the main job computes it.
fn simulate(case: &Case) -> Trajectory {
    let Initial::State { state } = case.initial else { panic!("the built-in scene gives its state") };
    let rig = TwoMassRig::new(case.parameters).unwrap();
    let interval = case.frame_interval() / 7.0;
    let flow = EngineFlow::new(rig.chain(), EngineSettings::dividing(interval, case.longest_step)).unwrap();
    flow.trajectory(&State::two_mass(state), Sampling { interval, t_end: case.duration }).unwrap()
}

fn film(source: &Source) -> FilmReport {
    let folder = tempfile::tempdir().unwrap();
    let output =
        OutputDir::open(folder.path(), &Origin::new("bench", serde_json::json!({})), Existing::Resume).unwrap();
    let mut renderer = stickslip::render::open(RendererChoice::Cpu).unwrap();
    let settings = FilmSettings { video: Video::Whole, ..FilmSettings::default() };
    produce(&settings, &output, renderer.as_mut(), source, &mut |_| {}).unwrap()
}

fn benchmark(criterion: &mut Criterion) {
    let (_, case) = Scene::built_in().unwrap();
    let mut group = criterion.benchmark_group("film");
    group.sample_size(10);
    group.throughput(Throughput::Elements(case.frame_count()));
    group.bench_function("simulate (whole film)", |b| b.iter(|| black_box(simulate(&case))));
    let source = Source(Stage::new(case.clone(), Motion::new(&simulate(&case)).unwrap(), Beside::default()));
    group.throughput(Throughput::Elements(FRAMES));
    group.bench_function("draw and encode (1280x720)", |b| b.iter(|| black_box(film(&source))));
    group.finish();
    let report = film(&source);
    let ms = |time: std::time::Duration| time.as_secs_f64() * 1e3 / FRAMES as f64;
    let t = report.times;
    println!(
        "ms per frame: list {:.2}, draw {:.2}, read back {:.2}, overlay {:.2}, png {:.2}, video {:.2}; wall {:.2}",
        ms(t.scene),
        ms(t.draw),
        ms(t.read_back),
        ms(t.overlay),
        ms(t.encode_png),
        ms(t.encode_video),
        ms(report.wall)
    );
}

criterion_group!(benches, benchmark);
criterion_main!(benches);
