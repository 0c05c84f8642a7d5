//! Which frames are there, which have to be drawn, and what the film is made of.

use super::FrameSource;
use super::error::FilmError;
use super::manifest;
use super::settings::{FilmSettings, Video};
use super::video::Encoding;
use crate::render::AdapterInfo;
use crate::store::{OutputDir, sha256_hex};
use std::collections::BTreeMap;
use std::ops::Range;

/// SHA-256 of the PNG file of each finished frame.
pub(super) type Finished = BTreeMap<u64, String>;

/// The film of all frames.
const FILM: &str = "film.mp4";

/// Names of the files that [`super::produce`] writes for these frames, with the film of all frames or without.
#[must_use]
pub fn file_names(frames: Range<u64>, with_film: bool) -> Vec<String> {
    frames.map(frame_name).chain([manifest::NAME.to_owned()]).chain(with_film.then(|| FILM.to_owned())).collect()
}

/// Name of a frame's file in the output directory.
pub(super) fn frame_name(index: u64) -> String {
    format!("frames/{index:06}.png")
}

#[derive(Debug)]
pub(super) struct Plan {
    /// Frames asked for.
    pub selected: Range<u64>,
    /// What decides a frame besides the parameters of the directory.
    pub frame_key: String,
    /// All trusted frames, also beyond the selected ones.
    pub finished: Finished,
    /// The film to make, if all its frames will be there.
    pub film: Option<FilmPlan>,
}

#[derive(Debug)]
pub(super) struct FilmPlan {
    pub name: String,
    pub frames: Range<u64>,
}

impl Plan {
    pub fn new(
        settings: &FilmSettings,
        output: &OutputDir,
        adapter: &AdapterInfo,
        source: &dyn FrameSource,
    ) -> Result<Self, FilmError> {
        settings.check()?;
        let count = source.count();
        let selected = settings.selected(count)?;
        let [width, height] = settings.size;
        // Another device draws slightly other pixels: its frames are not mixed in.
        let mut frame_key = format!("{width}x{height} {} {}", adapter.backend, adapter.adapter);
        if settings.supersampling > 1 {
            frame_key.push_str(&format!(" {} times as large", settings.supersampling));
        }
        let trusted = |index| Some((index, output.trusted(&frame_name(index), &frame_key)?.sha256));
        let finished: Finished = (0..count).filter_map(trusted).collect();
        let film = match settings.video {
            Video::None => None,
            Video::Selected if selected != (0..count) => {
                let name = format!("film-{:06}-{:06}.mp4", selected.start, selected.end - 1);
                Some(FilmPlan { name, frames: selected.clone() })
            }
            Video::Whole | Video::Selected => Some(FilmPlan { name: FILM.to_owned(), frames: 0..count }),
        };
        let complete = |frames: &Range<u64>| frames.clone().all(|i| selected.contains(&i) || finished.contains_key(&i));
        let film = film.filter(|film| complete(&film.frames));
        Ok(Self { selected, frame_key, finished, film })
    }

    /// Names of the files that are written, or were.
    pub fn file_names(&self) -> Vec<String> {
        let film = self.film.as_ref().map(|film| film.name.clone());
        file_names(self.selected.clone(), false).into_iter().chain(film).collect()
    }

    /// Whether no frame has to be drawn.
    pub fn nothing_to_draw(&self) -> bool {
        self.selected.clone().all(|index| self.finished.contains_key(&index))
    }
}

impl FilmPlan {
    /// What decides the film: its frames and how they are encoded.
    pub fn key(&self, settings: &FilmSettings, finished: &Finished) -> String {
        let frames: Vec<_> = finished.range(self.frames.clone()).map(|(_, sum)| sum.as_str()).collect();
        let sum = sha256_hex(frames.join("\n").as_bytes());
        format!("frames {sum}, {} per second, {}", settings.frames_per_second, Encoding::of(settings).key())
    }
}
