//! A minimal reader of MP4 files (ISO/IEC 14496-12 and -15) and of H.264 parameter sets (ITU-T H.264, 7.3.2.1.1 and E.1.1),
//! written from the standards.

use openh264::decoder::Decoder;
use openh264::formats::YUVSource;

/// Boxes of one level: type and content.
pub fn boxes(mut bytes: &[u8]) -> Vec<(String, &[u8])> {
    let mut found = Vec::new();
    while !bytes.is_empty() {
        let size = u32_at(bytes, 0) as usize;
        let kind = String::from_utf8(bytes[4..8].to_vec()).unwrap();
        assert!((8..=bytes.len()).contains(&size), "box {kind} of {size} bytes where {} are left", bytes.len());
        found.push((kind, &bytes[8..size]));
        bytes = &bytes[size..];
    }
    found
}

/// Content of the only box at a path such as `moov/trak`.
pub fn at<'a>(bytes: &'a [u8], path: &str) -> &'a [u8] {
    path.split('/').fold(bytes, |bytes, kind| {
        let all = boxes(bytes);
        let fitting: Vec<_> = all.iter().filter(|(found, _)| found == kind).collect();
        assert_eq!(fitting.len(), 1, "{kind} of {path}");
        fitting[0].1
    })
}

pub fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap())
}

fn u16_at(bytes: &[u8], at: usize) -> u16 {
    u16::from_be_bytes(bytes[at..at + 2].try_into().unwrap())
}

/// What a film file says of itself.
pub struct Movie<'a> {
    pub size: [u16; 2],
    /// Ticks per second.
    pub timescale: u32,
    /// Ticks of each frame.
    pub durations: Vec<u32>,
    pub sps: &'a [u8],
    pps: &'a [u8],
    /// Frames as length-prefixed NAL units.
    samples: Vec<&'a [u8]>,
    /// Frames, counted from 1, where decoding can begin.
    pub key_frames: Vec<u32>,
}

pub fn read(file: &[u8]) -> Movie<'_> {
    let media = at(file, "moov/trak/mdia");
    let table = at(media, "minf/stbl");
    let entry = at(&at(table, "stsd")[8..], "avc1");
    // The visual sample entry has 78 bytes before its boxes.
    let avcc = at(&entry[78..], "avcC");
    assert_eq!((avcc[4] & 3, avcc[5] & 31), (3, 1), "lengths of 4 bytes, one parameter set");
    let sps_length = usize::from(u16_at(avcc, 6));
    let sps = &avcc[8..8 + sps_length];
    let pps = &avcc[8 + sps_length..];
    assert_eq!(pps[0], 1);

    let stts = at(table, "stts");
    let runs = (0..u32_at(stts, 4) as usize).map(|run| (u32_at(stts, 8 + 8 * run), u32_at(stts, 12 + 8 * run)));
    let durations = runs.flat_map(|(count, ticks)| (0..count).map(move |_| ticks)).collect();
    let stss = at(table, "stss");
    Movie {
        size: [u16_at(entry, 24), u16_at(entry, 26)],
        timescale: u32_at(at(media, "mdhd"), 12),
        durations,
        sps,
        pps: &pps[3..3 + usize::from(u16_at(pps, 1))],
        samples: samples(file, table),
        key_frames: (0..u32_at(stss, 4) as usize).map(|n| u32_at(stss, 8 + 4 * n)).collect(),
    }
}

/// The bytes of each frame: sizes from `stsz`, places from `stco` and `stsc`.
fn samples<'a>(file: &'a [u8], table: &[u8]) -> Vec<&'a [u8]> {
    let (stsz, stco, stsc) = (at(table, "stsz"), at(table, "stco"), at(table, "stsc"));
    assert_eq!(u32_at(stsz, 4), 0, "sizes are listed");
    let sizes: Vec<_> = (0..u32_at(stsz, 8) as usize).map(|n| u32_at(stsz, 12 + 4 * n) as usize).collect();
    let chunks = (0..u32_at(stco, 4) as usize).map(|n| u32_at(stco, 8 + 4 * n) as usize);
    assert_eq!(u32_at(stsc, 4), 1, "all chunks alike");
    let per_chunk = u32_at(stsc, 12) as usize;
    let mut found = Vec::new();
    for mut place in chunks {
        for _ in 0..per_chunk {
            let size = sizes[found.len()];
            found.push(&file[place..place + size]);
            place += size;
        }
    }
    assert_eq!(found.len(), sizes.len());
    found
}

/// One decoded frame: 8-bit planes without padding.
pub struct Planes {
    pub size: [usize; 2],
    pub y: Vec<u8>,
    pub u: Vec<u8>,
    pub v: Vec<u8>,
}

impl Movie<'_> {
    /// All frames, decoded.
    pub fn decode(&self) -> Vec<Planes> {
        let mut decoder = Decoder::new().unwrap();
        let start = [0, 0, 0, 1];
        decoder.decode(&[&start, self.sps, &start, self.pps].concat()).unwrap();
        let mut pictures = Vec::new();
        for mut sample in self.samples.iter().copied() {
            let mut stream = Vec::new();
            while !sample.is_empty() {
                let end = 4 + u32_at(sample, 0) as usize;
                stream.extend_from_slice(&start);
                stream.extend_from_slice(&sample[4..end]);
                sample = &sample[end..];
            }
            pictures.extend(decoder.decode(&stream).unwrap().map(|picture| planes(&picture)));
        }
        pictures.extend(decoder.flush_remaining().unwrap().iter().map(planes));
        pictures
    }
}

fn planes(picture: &impl YUVSource) -> Planes {
    let (width, height) = picture.dimensions();
    let (sy, su, sv) = picture.strides();
    let cut = |plane: &[u8], stride: usize, w: usize, h: usize| -> Vec<u8> {
        (0..h).flat_map(|y| plane[y * stride..y * stride + w].to_vec()).collect()
    };
    Planes {
        size: [width, height],
        y: cut(picture.y(), sy, width, height),
        u: cut(picture.u(), su, width / 2, height / 2),
        v: cut(picture.v(), sv, width / 2, height / 2),
    }
}

/// Colour description of a baseline or main profile parameter set: full range, primaries, transfer, matrix.
pub fn colour_description(sps: &[u8]) -> Option<(bool, [u32; 3])> {
    // Emulation prevention: 0 0 3 stands for 0 0.
    let mut plain: Vec<u8> = Vec::new();
    for &byte in sps {
        if byte != 3 || !plain.ends_with(&[0, 0]) {
            plain.push(byte);
        }
    }
    let mut bits = Bits { bytes: &plain, at: 0 };
    bits.skip(8);
    let profile = bits.read(8);
    assert!(profile == 66 || profile == 77, "profile {profile} has other fields");
    bits.skip(16);
    bits.exp_golomb(); // seq_parameter_set_id
    bits.exp_golomb(); // log2_max_frame_num_minus4
    match bits.exp_golomb() {
        0 => _ = bits.exp_golomb(), // log2_max_pic_order_cnt_lsb_minus4
        2 => {}
        other => panic!("pic_order_cnt_type {other} is not used for such films"),
    }
    bits.exp_golomb(); // max_num_ref_frames
    bits.skip(1); // gaps_in_frame_num_value_allowed_flag
    bits.exp_golomb(); // pic_width_in_mbs_minus1
    bits.exp_golomb(); // pic_height_in_map_units_minus1
    assert_eq!(bits.read(1), 1, "frame_mbs_only_flag: not interlaced");
    bits.skip(1); // direct_8x8_inference_flag
    if bits.read(1) == 1 {
        (0..4).for_each(|_| _ = bits.exp_golomb()); // frame cropping
    }
    if bits.read(1) == 0 {
        return None; // vui_parameters_present_flag
    }
    assert_eq!(bits.read(1), 0, "aspect_ratio_info_present_flag");
    if bits.read(1) == 1 {
        bits.skip(1); // overscan
    }
    if bits.read(1) == 0 {
        return None; // video_signal_type_present_flag
    }
    bits.skip(3); // video_format
    let full_range = bits.read(1) == 1;
    (bits.read(1) == 1).then(|| (full_range, [bits.read(8), bits.read(8), bits.read(8)]))
}

struct Bits<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Bits<'_> {
    fn read(&mut self, count: usize) -> u32 {
        (0..count).fold(0, |value, _| {
            let bit = self.bytes[self.at / 8] >> (7 - self.at % 8) & 1;
            self.at += 1;
            value << 1 | u32::from(bit)
        })
    }

    fn skip(&mut self, count: usize) {
        self.at += count;
    }

    fn exp_golomb(&mut self) -> u32 {
        let mut zeros = 0;
        while self.read(1) == 0 {
            zeros += 1;
        }
        (1 << zeros) - 1 + self.read(zeros)
    }
}
