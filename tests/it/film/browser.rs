//! The film plays in a browser: headless Chromium says its size and length, and shows the pictures that were stored.

use super::fake::{finish, origin, settings};
use super::marked::{Marked, PATCH, PATCH_COLOUR};
use super::video::least_psnr;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;
use stickslip::film::{FilmSettings, produce};
use stickslip::render::{RendererChoice, open};
use stickslip::store::{Existing, OutputDir};

const FILM: [u32; 2] = [1280, 720];
const COUNT: u64 = 12;
/// Middle, last, first: always another than the one before, so that the browser has to show a new picture.
const SHOWN: [u64; 3] = [6, 11, 0];

/// Says length and size of `film.mp4`, and of each frame in `asked.shown`, sought by its time, the mean colour of a part of it and the ratio
/// of signal to noise (luma, dB) against each of the `asked.count` stored pictures.
///
/// The page counts as loaded, and Chromium prints it, when the document in the inner frame is closed.
const PAGE: &str = r#"<!doctype html><body><video id="film" preload="auto" muted></video><p id="found"></p><script>
const asked = ASKED, film = document.getElementById("film");
const inner = document.body.appendChild(document.createElement("iframe")).contentDocument;
inner.open();
const say = found => { document.getElementById("found").textContent = JSON.stringify(found); inner.close(); };
const pixels = picture => {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [film.videoWidth, film.videoHeight];
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(picture, 0, 0);
  return context.getImageData(0, 0, canvas.width, canvas.height).data;
};
const load = async index => {
  const picture = new Image();
  picture.src = "frames/" + String(index).padStart(6, "0") + ".png";
  await picture.decode();
  return pixels(picture);
};
// "seeked" may come before the new picture: the time of the picture that is shown decides.
const seek = index => new Promise(done => {
  const shown = (_, picture) =>
    Math.abs(picture.mediaTime * asked.rate - index) < 0.5 ? done() : film.requestVideoFrameCallback(shown);
  film.requestVideoFrameCallback(shown);
  film.currentTime = (index + 0.5) / asked.rate;
});
const noise = (a, b) => {
  let squares = 0;
  for (let i = 0; i < a.length; i += 4) {
    const luma = 0.2126 * (a[i] - b[i]) + 0.7152 * (a[i + 1] - b[i + 1]) + 0.0722 * (a[i + 2] - b[i + 2]);
    squares += luma * luma;
  }
  return 10 * Math.log10(255 * 255 * a.length / 4 / Math.max(squares, 1e-9));
};
const mean = (a, [left, top, right, bottom]) => {
  const sum = [0, 0, 0];
  for (let y = top; y < bottom; y++)
    for (let x = left; x < right; x++)
      for (let i = 0; i < 3; i++) sum[i] += a[4 * (y * film.videoWidth + x) + i];
  return sum.map(value => value / (right - left) / (bottom - top));
};
film.onerror = () => say({ error: film.error.message });
// Data of the first frame are there: it has been decoded.
film.onloadeddata = async () => {
  try {
    const stored = [], found = { seconds: film.duration, size: [film.videoWidth, film.videoHeight], colours: [], noise: [] };
    for (let index = 0; index < asked.count; index++) stored.push(await load(index));
    for (const index of asked.shown) {
      await seek(index);
      const shown = pixels(film);
      found.colours.push(mean(shown, asked.part));
      found.noise.push(stored.map(picture => noise(shown, picture)));
    }
    say(found);
  } catch (error) { say({ error: String(error) }); }
};
film.src = "film.mp4";
</script></body>"#;

/// How far the mean of an even colour may be off, levels. Rounding to 8 bits of limited range: 0.6 from luma and, in blue where it is largest,
/// 1.1 from chroma. The mean of a block, a quarter of its first coefficient: 5/24 of the quantiser's step of 6.5, 1.6 levels from luma and 2.9
/// from chroma. A film read by the other usual matrix, BT.601, would be off by 13 levels in red and green.
const COLOUR: f64 = 6.2;

/// What the page says of the film in `folder`; `None`, with a word, where there is no browser.
fn played(folder: &Path, asked: &Value) -> Option<Value> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let browser = names.into_iter().find(|name| Command::new(name).arg("--version").output().is_ok());
    let Some(browser) = browser else {
        println!("skipped: no Chromium among {names:?}");
        return None;
    };
    fs::write(folder.join("page.html"), PAGE.replace("ASKED", &asked.to_string())).unwrap();
    let output = Command::new("timeout")
        .args(["60", browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"])
        // Pixels of files can be read by the page beside them, and have no other colours than sRGB's.
        .args(["--allow-file-access-from-files", "--force-color-profile=srgb"])
        .arg(format!("--user-data-dir={}", folder.join("profile").display()))
        .args(["--dump-dom", &format!("file://{}", folder.join("page.html").display())])
        .output()
        .unwrap();
    let page = String::from_utf8_lossy(&output.stdout).into_owned();
    let said = page.split("\"found\">").nth(1).and_then(|rest| rest.split("</p>").next());
    Some(said.and_then(|text| serde_json::from_str(text).ok()).unwrap_or_else(|| panic!("no answer: {page}")))
}

#[test]
fn the_film_plays_in_a_browser_with_its_size_and_length() {
    let place = tempfile::tempdir().unwrap();
    let film = FilmSettings { size: [320, 180], ..settings() };
    finish(place.path(), &film, 45);
    let asked = json!({ "rate": 25, "count": 0, "shown": [], "part": [] });
    if let Some(said) = played(place.path(), &asked) {
        // 45 frames at 25 a second.
        assert_eq!((&said["seconds"], &said["size"]), (&json!(1.8), &json!([320, 180])));
        // Negative control: a damaged file is no film.
        let bytes = fs::read(place.path().join("film.mp4")).unwrap();
        fs::write(place.path().join("film.mp4"), &bytes[..200]).unwrap();
        assert!(played(place.path(), &asked).unwrap()["error"].is_string());
    }
}

/// Quantisation of luma alone, as `least_psnr` has it with half a decibel for rounding, to full range: an error is 255/219 times as large there.
fn least_shown(quantiser: u8) -> f64 {
    least_psnr(quantiser) - 20.0 * (255.0_f64 / 219.0).log10()
}

#[test]
fn the_pictures_in_the_browser_are_those_of_the_frames() {
    let place = tempfile::tempdir().unwrap();
    let output = OutputDir::open(place.path(), &origin(), Existing::Resume).unwrap();
    let settings = FilmSettings { size: FILM, ..settings() };
    let mut cpu = open(RendererChoice::Cpu).unwrap();
    produce(&settings, &output, cpu.as_mut(), &Marked::new(FILM, COUNT), &mut |_| ()).unwrap();
    // Without the rim, where colours of neighbours are mixed in.
    let inner = [PATCH[0] + 8, PATCH[1] + 8, PATCH[2] - 8, PATCH[3] - 8];
    let asked = json!({ "rate": settings.frames_per_second, "count": COUNT, "shown": SHOWN, "part": inner });
    let Some(said) = played(place.path(), &asked) else { return };
    assert_eq!((&said["seconds"], &said["size"]), (&json!(0.48), &json!(FILM)), "{said}");
    let limit = least_shown(settings.quantiser);
    for (row, index) in SHOWN.into_iter().enumerate() {
        let noise: Vec<f64> = (0..COUNT as usize).map(|stored| said["noise"][row][stored].as_f64().unwrap()).collect();
        println!("frame {index}: {noise:.1?} dB; {}", said["colours"][row]);
        // Its own picture is within the limit; as negative controls all others, the neighbours too, are not.
        let passing: Vec<u64> = (0..COUNT).filter(|&stored| noise[stored as usize] > limit).collect();
        assert_eq!(passing, [index], "{noise:.1?}, at least {limit:.1}");
        let [_, drawn @ ..] = PATCH_COLOUR.to_be_bytes();
        for (channel, drawn) in drawn.into_iter().enumerate() {
            let shown = said["colours"][row][channel].as_f64().unwrap();
            assert!((shown - f64::from(drawn)).abs() <= COLOUR, "{said}");
        }
    }
}
