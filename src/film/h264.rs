//! H.264 in MP4, as browsers play it: one quantiser for all frames, BT.709, header before the pictures.
//!
//! The encoder runs on one thread and drops no frame, so the bytes are the same every time. A film of a single frame lasts only one
//! tick of the file's clock, 1/90000 s: its length is taken from the distance to the next frame.

use super::error::FilmError;
use super::settings::FilmSettings;
use super::yuv::Planes;
use image::RgbaImage;
use muxide::api::{MuxerBuilder, MuxerError, VideoCodec};
use openh264::encoder::{
    Encoder, EncoderConfig, FrameRate, FrameType, IntraFramePeriod, QpRange, RateControlMode, UsageType, VuiConfig,
};
use openh264::{OpenH264API, Timestamp};
use std::io::{self, Write};

const FORMAT: &str = "H.264";

/// One encoded frame, Annex B.
struct Packet {
    bytes: Vec<u8>,
    is_key: bool,
}

/// Encodes pictures in order and holds the packets.
pub(super) struct H264Encoder {
    encoder: Encoder,
    planes: Planes,
    packets: Vec<Packet>,
    frames_per_second: u32,
}

impl H264Encoder {
    pub fn new(settings: &FilmSettings) -> Result<Self, FilmError> {
        let FilmSettings { frames_per_second, quantiser, .. } = *settings;
        let config = EncoderConfig::new()
            .usage_type(UsageType::CameraVideoRealTime)
            // This mode keeps to the range of quantisers and has no means to drop a frame. With rate control off the range is ignored; the
            // quality mode drops frames or complains on standard error.
            .rate_control_mode(RateControlMode::Bufferbased)
            .qp(QpRange::new(quantiser, quantiser))
            // Each of these changes the quantiser or leaves out what moves little.
            .adaptive_quantization(false)
            .background_detection(false)
            .scene_change_detect(false)
            .max_frame_rate(FrameRate::from_hz(frames_per_second as f32))
            // A key frame every two seconds, to jump to.
            .intra_frame_period(IntraFramePeriod::from_num_frames(2 * frames_per_second))
            .num_threads(1)
            .vui(VuiConfig::bt709());
        let encoder = Encoder::with_api_config(OpenH264API::from_source(), config)
            .map_err(|error| FilmError::Encode { index: 0, format: FORMAT, reason: error.to_string() })?;
        Ok(Self { encoder, planes: Planes::new(settings.video_size()), packets: Vec::new(), frames_per_second })
    }

    /// Encodes the next picture; `index` is for errors.
    pub fn push(&mut self, index: u64, image: &RgbaImage) -> Result<(), FilmError> {
        let failed = |reason: String| FilmError::Encode { index, format: FORMAT, reason };
        self.planes.fill(image);
        let milliseconds = 1000 * self.packets.len() as u64 / u64::from(self.frames_per_second);
        let encoded = self
            .encoder
            .encode_at(&self.planes, Timestamp::from_millis(milliseconds))
            .map_err(|error| failed(error.to_string()))?;
        let is_key = match encoded.frame_type() {
            FrameType::IDR => true,
            FrameType::I | FrameType::P => false,
            other => return Err(failed(format!("the encoder answered {other:?}"))),
        };
        self.packets.push(Packet { bytes: encoded.to_vec(), is_key });
        Ok(())
    }

    pub fn into_packets(self, size: [u32; 2]) -> Packets {
        Packets { packets: self.packets, size, frames_per_second: self.frames_per_second }
    }
}

/// An encoded film in memory.
pub(super) struct Packets {
    packets: Vec<Packet>,
    size: [u32; 2],
    frames_per_second: u32,
}

impl Packets {
    pub fn write(self, writer: &mut (dyn Write + Send)) -> io::Result<()> {
        let [width, height] = self.size;
        let rate = f64::from(self.frames_per_second);
        let builder = MuxerBuilder::new(writer).video(VideoCodec::H264, width, height, rate).with_fast_start(true);
        let mut muxer = builder.build().map_err(io_error)?;
        // Packets are given up one by one: the muxer holds its own copy.
        for (number, packet) in self.packets.into_iter().enumerate() {
            muxer.write_video(number as f64 / rate, &packet.bytes, packet.is_key).map_err(io_error)?;
        }
        muxer.finish().map_err(io_error)
    }
}

/// A full disk has to stay recognisable as one.
fn io_error(error: MuxerError) -> io::Error {
    match error {
        MuxerError::Io(error) => error,
        other => io::Error::other(other.to_string()),
    }
}
