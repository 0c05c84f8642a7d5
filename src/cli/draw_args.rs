//! Options of drawing: what draws, which frames, which encoder.

use crate::film::{Encoder, Ffmpeg};
use crate::render::RendererChoice;
use anyhow::ensure;
use clap::{Args, ValueEnum};
use std::ops::Range;

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum EncoderName {
    /// The built-in one.
    Openh264,
    /// An installed ffmpeg with libx264: slower, and smaller files.
    Ffmpeg,
}

/// How a picture is drawn.
#[derive(Debug, Args)]
#[command(next_help_heading = "Drawing")]
pub struct PictureArgs {
    /// What draws the frames.
    #[arg(long, value_enum, default_value_t = RendererChoice::Auto)]
    pub renderer: RendererChoice,
    /// Draw frames this many times as wide and high and make them smaller: smoother edges for as much more time, squared.
    #[arg(long, value_name = "FACTOR", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4))]
    pub supersample: u32,
}

/// How a film is drawn, and which part of it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Drawing")]
pub struct DrawArgs {
    #[command(flatten)]
    pub picture: PictureArgs,
    /// Draw the frames from A up to, not including, B only, and no film.
    #[arg(long, value_name = "A:B", value_parser = parse_frames)]
    pub frames: Option<Range<u64>>,
    /// Draw the Kth of N equal parts of the frames only, and no film; for many machines that share a directory, or whose directories are
    /// put together: all frames in one, and its outputs.jsonl followed by the others'.
    #[arg(long, value_name = "K/N", value_parser = parse_shard, conflicts_with = "frames")]
    pub shard: Option<[u64; 2]>,
    /// What makes film.mp4 of the frames.
    #[arg(long, value_enum, default_value_t = EncoderName::Openh264)]
    pub encoder: EncoderName,
}

/// `A:B`
pub fn parse_frames(text: &str) -> Result<Range<u64>, String> {
    match text.split_once(':').map(|(a, b)| (a.parse(), b.parse())) {
        Some((Ok(a), Ok(b))) if a < b => Ok(a..b),
        _ => Err("give two whole numbers A:B from 0, A smaller than B".to_owned()),
    }
}

/// `K/N`
fn parse_shard(text: &str) -> Result<[u64; 2], String> {
    match text.split_once('/').map(|(k, n)| (k.parse(), n.parse())) {
        Some((Ok(k), Ok(n))) if 1 <= k && k <= n => Ok([k, n]),
        _ => Err("give two whole numbers K/N, K from 1 to N".to_owned()),
    }
}

impl DrawArgs {
    /// The frames to draw of a film of `count`; `None` for all.
    pub fn selected(&self, count: u64) -> Option<Range<u64>> {
        let part = |[k, n]: [u64; 2]| (k - 1) * count / n..k * count / n;
        self.frames.clone().or(self.shard.map(part))
    }

    /// Refuses frames beyond a film that has at most `most`, before anything is computed; the motion may end early. Refuses an encoder
    /// that is not there.
    pub fn check(&self, most: u64) -> anyhow::Result<()> {
        self.encoder()?;
        self.check_frames(most, &format!("it has at most {most} frames"))
    }

    /// The same of the film, its motion known. What was within the most frames it might have is beyond them only where it ended early.
    pub fn check_of(&self, count: u64) -> anyhow::Result<()> {
        self.check_frames(count, &format!("its motion ended early and left it {count} frames"))
    }

    fn check_frames(&self, count: u64, film: &str) -> anyhow::Result<()> {
        if let Some([k, n]) = self.shard {
            ensure!(n <= count, "--shard {k}/{n} is too small a part of the film: {film}");
        }
        if let Some(Range { start, end }) = self.frames {
            ensure!(end <= count, "--frames {start}:{end} is beyond the film: {film}");
        }
        Ok(())
    }

    pub fn encoder(&self) -> anyhow::Result<Encoder> {
        Ok(match self.encoder {
            EncoderName::Openh264 => Encoder::OpenH264,
            EncoderName::Ffmpeg => Encoder::Ffmpeg(Ffmpeg::find()?),
        })
    }
}
