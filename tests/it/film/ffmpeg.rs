//! Films by an ffmpeg: what it is sent, what is said when it fails, and the film of a real one.

use super::fake::{SIZE, Stop, finish, index_of, picture, run, settings};
use super::mp4::Planes;
use super::video::{bt709, least_psnr, luma_psnr};
use crate::small_disk::names_in;
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use stickslip::film::{Encoder, Ffmpeg, FilmError, FilmSettings};

/// Bytes of a 4:2:0 picture.
const PICTURE: usize = (SIZE[0] * SIZE[1] * 3 / 2) as usize;

/// A stand-in for ffmpeg that answers when asked who it is, and otherwise runs `work`, in which `$last` is the name of the film.
fn stand_in(folder: &Path, work: &str) -> Ffmpeg {
    let program = folder.join("ffmpeg");
    let script = format!(
        "#!/bin/sh\nif [ \"$1\" = -version ]; then echo 'ffmpeg version stand-in'; exit; fi\nfor last; do :; done\ncd '{}'\n{work}\n",
        folder.display()
    );
    // Another process writes it: a copy of our file handle in a child that another test starts just now would keep it from running.
    let mut shell = Command::new("sh");
    shell.args(["-c", "cat > \"$0\" && chmod +x \"$0\""]).arg(&program).stdin(Stdio::piped());
    let mut shell = shell.spawn().unwrap();
    shell.stdin.take().unwrap().write_all(script.as_bytes()).unwrap();
    assert!(shell.wait().unwrap().success());
    Ffmpeg::at(program).unwrap()
}

fn by(ffmpeg: Ffmpeg) -> FilmSettings {
    FilmSettings { encoder: Encoder::Ffmpeg(ffmpeg), ..settings() }
}

fn planes(bytes: &[u8]) -> Planes {
    let [width, height] = SIZE.map(|side| side as usize);
    let (y, chroma) = bytes.split_at(width * height);
    let (u, v) = chroma.split_at(chroma.len() / 2);
    Planes { size: [width, height], y: y.to_vec(), u: u.to_vec(), v: v.to_vec() }
}

/// Every picture once, in order, and each the one that was drawn.
fn check_pictures(bytes: &[u8], count: u64, limit: f64) {
    assert_eq!(bytes.len(), PICTURE * count as usize);
    for (index, bytes) in (0..).zip(bytes.chunks(PICTURE)) {
        let planes = planes(bytes);
        assert_eq!(index_of(&bt709(&planes)), index);
        let psnr = luma_psnr(&planes, &picture(SIZE, index));
        assert!(psnr > limit, "frame {index}: {psnr:.1} dB, at least {limit:.1} expected");
    }
}

#[cfg(unix)]
#[test]
fn ffmpeg_is_sent_every_picture_once_and_its_file_becomes_the_film() {
    let (tools, place) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let ffmpeg = stand_in(tools.path(), "printf '%s\\n' \"$@\" > arguments; tee sent > \"$last\"");
    let (report, drawn) = finish(place.path(), &by(ffmpeg.clone()), 40);
    assert_eq!((drawn.len(), report.film), (40, Some(place.path().join("film.mp4"))));
    let sent = fs::read(tools.path().join("sent")).unwrap();
    // Rounding to 8 bits alone costs at most half a level: 20 log10(255 / 0.5) = 54 dB.
    check_pictures(&sent, 40, 54.0);
    assert_eq!(fs::read(place.path().join("film.mp4")).unwrap(), sent);
    let names = names_in(place.path());
    assert!(!names.iter().any(|name| name.contains("partial")), "{names:?}");
    // What it was told is in the manifest, but for the temporary name.
    let manifest: Value = serde_json::from_slice(&fs::read(place.path().join("frames.json")).unwrap()).unwrap();
    let film = &manifest["film"];
    assert_eq!([&film["encoder"], &film["version"]], ["ffmpeg", "ffmpeg version stand-in"]);
    let told = fs::read_to_string(tools.path().join("arguments")).unwrap();
    let told: Vec<&str> = told.lines().collect();
    let noted: Vec<&str> = film["arguments"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
    assert_eq!(noted, told[..told.len() - 1]);
    assert!(told.windows(2).any(|pair| pair == ["-video_size", "64x48"]) && told.contains(&"libx264"));
    // A second run has nothing to do; the other encoder makes its own film of the same frames.
    fs::remove_file(tools.path().join("sent")).unwrap();
    assert_eq!(finish(place.path(), &by(ffmpeg), 40).1, [0; 0]);
    assert!(!tools.path().join("sent").exists());
    finish(place.path(), &settings(), 40);
    assert_ne!(fs::read(place.path().join("film.mp4")).unwrap(), sent);
}

#[cfg(unix)]
#[test]
fn what_ffmpeg_complains_about_is_in_the_error_and_the_frames_are_kept() {
    for (work, words) in [
        ("echo 'Unknown encoder libx264' >&2; exit 3", ["Unknown encoder libx264", "exit status: 3"]),
        ("cat > /dev/null; echo 'disk full' >&2; exit 1", ["disk full", "exit status: 1"]),
        ("cat > /dev/null", ["wrote nothing", "--encoder openh264"]),
    ] {
        let (tools, place) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let (report, _) = run(place.path(), &by(stand_in(tools.path(), work)), 30, Stop::Never);
        let error = report.unwrap_err();
        assert!(matches!(error, FilmError::Ffmpeg { .. }), "{error}");
        assert!(words.iter().all(|word| error.to_string().contains(word)), "{error}");
        let names = names_in(place.path());
        assert!(!names.iter().any(|name| name == "film.mp4" || name.contains("partial")), "{names:?}");
        let (report, drawn) = finish(place.path(), &settings(), 30);
        assert!(report.reused > 0 && drawn.len() < 30, "no frame was kept");
    }
}

#[test]
fn a_program_that_is_no_ffmpeg_is_refused() {
    for (program, word) in [("/no/such/ffmpeg", "/no/such/ffmpeg"), ("/bin/false", "exit status: 1")] {
        let error = Ffmpeg::at(PathBuf::from(program)).unwrap_err().to_string();
        assert!(error.contains(word) && error.contains("install"), "{error}");
    }
}

#[test]
fn an_installed_ffmpeg_makes_the_film() {
    let Ok(ffmpeg) = Ffmpeg::find() else {
        println!("skipped: no ffmpeg on the search path");
        return;
    };
    let program = ffmpeg.program.clone();
    let place = tempfile::tempdir().unwrap();
    finish(place.path(), &by(ffmpeg), 60);
    let film = place.path().join("film.mp4");
    let decode = ["-v", "error", "-f", "rawvideo", "-pix_fmt", "yuv420p", "-"];
    let decoded = Command::new(program).arg("-i").arg(&film).args(decode).output().unwrap();
    assert!(decoded.status.success(), "{}", String::from_utf8_lossy(&decoded.stderr));
    // A constant rate factor lets the quantiser of pictures that are not referred to rise: by 2.3 for those between two others
    // (x264's ratios 1.4 and 1.3, 6 log2 1.3 = 2.3).
    check_pictures(&decoded.stdout, 60, least_psnr(settings().quantiser + 3));
}
