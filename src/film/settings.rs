use super::error::FilmError;
use super::ffmpeg::Ffmpeg;
use std::ops::{Range, RangeInclusive};

/// Limits of the built-in encoder (openh264): level 5.2.
const LEAST_SIDE: u32 = 16;
const LONG_SIDE: u32 = 3840;
const SHORT_SIDE: u32 = 2160;
/// H.264 has 0 to 51, of which openh264 takes those below 12 for 12.
const QUANTISERS: RangeInclusive<u8> = 12..=51;
/// Frame times have to stay apart in the film file's clock of 90 kHz, and displays end far below.
const MOST_FRAMES_PER_SECOND: u32 = 1000;

/// Beyond, more samples are not seen.
const MOST_SUPERSAMPLING: u32 = 4;

/// Which film file is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Video {
    /// Frames only.
    None,
    /// `film.mp4` of all frames of the source, as soon as all of them are there.
    Whole,
    /// A film of the frames of [`FilmSettings::frames`] alone, `film-FIRST-LAST.mp4`; of all frames where that is `None`.
    Selected,
}

/// What makes the film file of the frames.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Encoder {
    /// openh264, a part of this program.
    #[default]
    OpenH264,
    /// An installed ffmpeg with libx264: smaller files.
    Ffmpeg(Ffmpeg),
}

/// How frames become files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FilmSettings {
    /// Width and height in pixels. Frames have exactly this size; a film needs even sides, so its last column or row is repeated
    /// where one is odd.
    pub size: [u32; 2],
    pub frames_per_second: u32,
    /// Frames are drawn this many times as wide and high, and made smaller: 1 to 4.
    pub supersampling: u32,
    /// H.264 quantiser: 12 best, 51 worst; measured at 1280x720: 18 gives about 48 dB, 22 about 46 dB. For ffmpeg its constant rate
    /// factor, which means about the same.
    pub quantiser: u8,
    /// Draw these frames only; `None` for all.
    pub frames: Option<Range<u64>>,
    pub video: Video,
    pub encoder: Encoder,
}

impl Default for FilmSettings {
    /// 1280x720, 30 frames per second, quantiser 20, all frames, one film by the built-in encoder.
    fn default() -> Self {
        Self {
            size: [1280, 720],
            frames_per_second: 30,
            supersampling: 1,
            quantiser: 20,
            frames: None,
            video: Video::Whole,
            encoder: Encoder::default(),
        }
    }
}

impl FilmSettings {
    /// The frames to draw of `count` there are.
    pub(super) fn selected(&self, count: u64) -> Result<Range<u64>, FilmError> {
        let range = self.frames.clone().unwrap_or(0..count);
        if count == 0 {
            return Err(FilmError::NoFrames);
        }
        if range.is_empty() || range.end > count {
            return Err(FilmError::Range { start: range.start, end: range.end, count });
        }
        Ok(range)
    }

    pub(super) fn check(&self) -> Result<(), FilmError> {
        let Self { size: [width, height], frames_per_second, quantiser, .. } = *self;
        if !(1..=MOST_FRAMES_PER_SECOND).contains(&frames_per_second) {
            return Err(FilmError::FrameRate { frames_per_second, limit: MOST_FRAMES_PER_SECOND });
        }
        if !(1..=MOST_SUPERSAMPLING).contains(&self.supersampling) {
            return Err(FilmError::Supersampling { found: self.supersampling, limit: MOST_SUPERSAMPLING });
        }
        if !QUANTISERS.contains(&quantiser) {
            let (best, worst) = QUANTISERS.into_inner();
            return Err(FilmError::Quantiser { quantiser, best, worst });
        }
        let [wide, high] = self.video_size();
        let fits = wide.min(high) >= LEAST_SIDE && wide.max(high) <= LONG_SIDE && wide.min(high) <= SHORT_SIDE;
        if self.video != Video::None && self.encoder == Encoder::OpenH264 && !fits {
            let (least, long, short) = (LEAST_SIDE, LONG_SIDE, SHORT_SIDE);
            return Err(FilmError::VideoSize { width, height, least, long, short });
        }
        Ok(())
    }

    /// Size in which frames are drawn.
    pub(super) fn drawn_size(&self) -> [u32; 2] {
        self.size.map(|side| side.saturating_mul(self.supersampling))
    }

    /// Size of the film: the frames', made even.
    pub(super) fn video_size(&self) -> [u32; 2] {
        self.size.map(|side| side.saturating_add(side % 2))
    }
}
