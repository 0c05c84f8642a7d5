//! The film plays in a browser: headless Chromium reads its size and length.

use super::fake::{finish, settings};
use std::fs;
use std::path::Path;
use std::process::Command;
use stickslip::film::FilmSettings;

const PAGE: &str = r#"<!doctype html><body><video id="film" preload="auto" muted></video><p id="found">nothing yet</p><script>
const film = document.getElementById("film"), found = document.getElementById("found");
const say = words => { found.textContent = "found " + words + "."; };
film.onerror = () => say("error " + film.error.message);
// Data of the first frame are there: it has been decoded.
film.onloadeddata = () => say(film.duration.toFixed(4) + " s, " + film.videoWidth + " x " + film.videoHeight);
film.src = "film.mp4";
</script></body>"#;

/// What the page says of `film.mp4` beside it; `None`, with a word, where there is no browser.
fn played(folder: &Path) -> Option<String> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let browser = names.into_iter().find(|name| Command::new(name).arg("--version").output().is_ok());
    let Some(browser) = browser else {
        println!("skipped: no Chromium among {names:?}");
        return None;
    };
    fs::write(folder.join("page.html"), PAGE).unwrap();
    let flags =
        ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--virtual-time-budget=8000"];
    let output = Command::new("timeout")
        .args(["60", browser])
        .args(flags)
        .arg(format!("--user-data-dir={}", folder.join("profile").display()))
        .args(["--dump-dom", &format!("file://{}", folder.join("page.html").display())])
        .output()
        .unwrap();
    let page = String::from_utf8_lossy(&output.stdout).into_owned();
    let said = page.split("\"found\">found ").nth(1).and_then(|rest| rest.split(".</p>").next());
    Some(said.map_or_else(|| format!("no answer: {page}"), str::to_owned))
}

#[test]
fn the_film_plays_in_a_browser_with_its_size_and_length() {
    let place = tempfile::tempdir().unwrap();
    let film = FilmSettings { size: [320, 180], ..settings() };
    finish(place.path(), &film, 45);
    // 45 frames at 25 a second.
    if let Some(said) = played(place.path()) {
        assert_eq!(said, "1.8000 s, 320 x 180");
        // Negative control: a damaged file is no film.
        let bytes = fs::read(place.path().join("film.mp4")).unwrap();
        fs::write(place.path().join("film.mp4"), &bytes[..200]).unwrap();
        let said = played(place.path()).unwrap();
        assert!(said.starts_with("error"), "{said}");
    }
}
