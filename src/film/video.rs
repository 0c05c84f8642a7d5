//! Who encodes the film.

use super::error::FilmError;
use super::ffmpeg::{FfmpegEncoder, arguments};
use super::h264::{H264Encoder, Packets};
use super::settings::{Encoder, FilmSettings};
use crate::store::OutputDir;
use image::RgbaImage;
use serde::Serialize;
use std::fs::File;
use std::io::{self, Write};

/// Takes pictures in order.
pub(super) enum VideoEncoder {
    BuiltIn(Box<H264Encoder>),
    Ffmpeg(Box<FfmpegEncoder>),
}

/// An encoded film.
pub(super) enum Film {
    BuiltIn(Packets),
    /// Complete, under a temporary name that is gone already.
    Ffmpeg(File),
}

impl VideoEncoder {
    pub fn new(settings: &FilmSettings, output: &OutputDir) -> Result<Self, FilmError> {
        Ok(match &settings.encoder {
            Encoder::OpenH264 => Self::BuiltIn(Box::new(H264Encoder::new(settings)?)),
            Encoder::Ffmpeg(ffmpeg) => {
                Self::Ffmpeg(Box::new(FfmpegEncoder::new(settings, ffmpeg, output.temporary()?)?))
            }
        })
    }

    /// Encodes the next picture; `index` is for errors.
    pub fn push(&mut self, index: u64, image: &RgbaImage) -> Result<(), FilmError> {
        match self {
            Self::BuiltIn(encoder) => encoder.push(index, image),
            Self::Ffmpeg(encoder) => encoder.push(image),
        }
    }

    pub fn finish(self, settings: &FilmSettings) -> Result<Film, FilmError> {
        Ok(match self {
            Self::BuiltIn(encoder) => Film::BuiltIn(encoder.into_packets(settings.video_size())),
            Self::Ffmpeg(encoder) => Film::Ffmpeg(encoder.finish()?),
        })
    }
}

impl Film {
    pub fn write(self, writer: &mut (dyn Write + Send)) -> io::Result<()> {
        match self {
            Self::BuiltIn(packets) => packets.write(writer),
            Self::Ffmpeg(mut file) => io::copy(&mut file, writer).map(|_| ()),
        }
    }
}

/// How the film is encoded, for the manifest.
#[derive(Debug, Serialize)]
pub(super) struct Encoding {
    encoder: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    version: Option<String>,
    /// Of H.264; ffmpeg holds it on average.
    quantiser: u8,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    arguments: Vec<String>,
}

impl Encoding {
    pub fn of(settings: &FilmSettings) -> Self {
        let quantiser = settings.quantiser;
        match &settings.encoder {
            Encoder::OpenH264 => Self { encoder: "openh264", version: None, quantiser, arguments: Vec::new() },
            Encoder::Ffmpeg(ffmpeg) => {
                let version = Some(ffmpeg.version.clone());
                Self { encoder: "ffmpeg", version, quantiser, arguments: arguments(settings) }
            }
        }
    }

    /// What decides the film's bytes besides its frames and their rate.
    pub fn key(&self) -> String {
        match &self.version {
            None => format!("quantiser {}", self.quantiser),
            Some(version) => format!("{version}, {}", self.arguments.join(" ")),
        }
    }
}
