//! `frames.json`: what the frames are. It says nothing about the run that made them, so that it is the same after any interruption.

use super::error::FilmError;
use super::plan::{Plan, frame_name};
use super::settings::{Encoder, FilmSettings};
use super::video::Encoding;
use super::{FrameSource, FrameState};
use crate::render::AdapterInfo;
use crate::store::{OutputDir, sha256_hex};
use serde::Serialize;

pub(super) const NAME: &str = "frames.json";

#[derive(Serialize)]
struct Manifest<'a> {
    stickslip: &'static str,
    parameters_sha256: &'a str,
    width: u32,
    height: u32,
    frames_per_second: u32,
    backend: &'a str,
    adapter: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    film: Option<Film<'a>>,
    frames: Vec<Frame<'a>>,
}

#[derive(Serialize)]
struct Film<'a> {
    file: &'a str,
    #[serde(flatten)]
    encoding: Encoding,
}

#[derive(Serialize)]
struct Frame<'a> {
    index: u64,
    /// Seconds from the beginning of the whole film.
    time: f64,
    file: String,
    sha256: &'a str,
    #[serde(flatten)]
    state: Option<FrameState>,
}

impl<'a> Frame<'a> {
    fn new(index: u64, sha256: &'a str, settings: &FilmSettings, source: &dyn FrameSource) -> Self {
        let time = index as f64 / f64::from(settings.frames_per_second);
        Self { index, time, file: frame_name(index), sha256, state: source.state(index) }
    }
}

/// Writes the list of all finished frames and how the film is encoded, unless it is there already.
pub(super) fn write(
    settings: &FilmSettings,
    output: &OutputDir,
    adapter: &AdapterInfo,
    source: &dyn FrameSource,
    plan: &Plan,
) -> Result<(), FilmError> {
    // The built-in encoder is that of the version; frames drawn without a film by several machines then have the manifest of one.
    let film = plan.film.as_ref().filter(|_| settings.encoder != Encoder::OpenH264);
    let manifest = Manifest {
        stickslip: env!("CARGO_PKG_VERSION"),
        parameters_sha256: output.parameters_sha256(),
        width: settings.size[0],
        height: settings.size[1],
        frames_per_second: settings.frames_per_second,
        backend: &adapter.backend,
        adapter: &adapter.adapter,
        film: film.map(|film| Film { file: &film.name, encoding: Encoding::of(settings) }),
        frames: plan.finished.iter().map(|(&index, sha256)| Frame::new(index, sha256, settings, source)).collect(),
    };
    let failed = |error: serde_json::Error| FilmError::Encode { index: 0, format: "JSON", reason: error.to_string() };
    let mut text = serde_json::to_vec_pretty(&manifest).map_err(failed)?;
    text.push(b'\n');
    let key = sha256_hex(&text);
    if output.trusted(NAME, &key).is_none() {
        output.write(NAME, &key, |writer| writer.write_all(&text))?;
    }
    Ok(())
}
