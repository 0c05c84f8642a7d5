//! Pages in a real browser, headless: no console errors, all pictures load, nothing wider than the screen, at phone and desktop width,
//! light and dark. Skipped with a word where no Chromium is installed.
//!
//! A browser window cannot be as narrow as a phone, so the page is shown in frames of either width, with a script at its end that
//! reports what it sees to the page around it.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

const WIDTHS: [u32; 2] = [375, 1440];
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Sent to the page around it when everything is loaded.
const REPORTER: &str = r#"<script>addEventListener("load", () => {
  const images = [...document.images], small = [...document.querySelectorAll("p, td, th, li, summary")];
  parent.postMessage({
    width: innerWidth, needed: document.documentElement.scrollWidth, images: images.length,
    missing: images.filter(image => !image.complete || image.naturalWidth === 0).length,
    dark: matchMedia("(prefers-color-scheme: dark)").matches, background: getComputedStyle(document.body).backgroundColor,
    smallest: Math.min(...small.map(element => parseFloat(getComputedStyle(element).fontSize))),
  }, "*");
});</script>"#;

const HOST: &str = r#"<!DOCTYPE html><meta name="color-scheme" content="light dark"><title>frames</title><body><script>
addEventListener("message", event => { const pre = document.createElement("pre"); pre.textContent = "report:" + JSON.stringify(event.data); document.body.append(pre); });
</script>FRAMES</body>"#;

/// What the browser saw of a page.
pub struct Seen {
    /// One per width and colour scheme.
    pub reports: Vec<Value>,
    pub console: Vec<String>,
}

fn browser() -> Option<&'static str> {
    NAMES
        .into_iter()
        .find(|name| Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success()))
}

/// `None` where there is no browser.
pub fn look_at(page: &Path) -> Option<Seen> {
    let Some(browser) = browser() else {
        eprintln!("skipped: none of {NAMES:?} is installed");
        return None;
    };
    let folder = tempfile::tempdir().unwrap();
    let copy = fs::read_to_string(page).unwrap() + REPORTER;
    fs::write(folder.path().join("page.html"), copy).unwrap();
    let frames: String = WIDTHS
        .iter()
        .map(|width| format!(r#"<iframe src="page.html" width="{width}" height="900" style="border:0"></iframe>"#))
        .collect();
    let host = folder.path().join("host.html");
    fs::write(&host, HOST.replace("FRAMES", &frames)).unwrap();
    let mut seen = Seen { reports: Vec::new(), console: Vec::new() };
    // 0 is dark, 1 light.
    for scheme in ["0", "1"] {
        let profile = tempfile::tempdir().unwrap();
        let output = Command::new(browser)
            .args([
                "--headless=new",
                "--no-sandbox",
                "--disable-gpu",
                "--enable-logging=stderr",
                "--window-size=1900,1000",
            ])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg(format!("--blink-settings=preferredColorScheme={scheme}"))
            .args(["--virtual-time-budget=10000", "--dump-dom"])
            .arg(format!("file://{}", host.display()))
            .output()
            .unwrap();
        let dom = String::from_utf8_lossy(&output.stdout).into_owned();
        let reports = dom.split("<pre>report:").skip(1).filter_map(|rest| rest.split("</pre>").next());
        seen.reports.extend(reports.map(|text| serde_json::from_str::<Value>(&text.replace("&amp;", "&")).unwrap()));
        let log = String::from_utf8_lossy(&output.stderr).into_owned();
        seen.console.extend(log.lines().filter(|line| line.contains("CONSOLE")).map(str::to_owned));
    }
    Some(seen)
}

/// What is wrong with a page, in words; empty if nothing is.
pub fn faults(seen: &Seen) -> Vec<String> {
    let mut faults = seen.console.clone();
    if seen.reports.len() != 2 * WIDTHS.len() {
        faults.push(format!("{} of {} reports came", seen.reports.len(), 2 * WIDTHS.len()));
    }
    for report in &seen.reports {
        let number = |key: &str| report[key].as_f64().unwrap_or(f64::NAN);
        if number("needed") > number("width") {
            faults.push(format!("{} pixels wide on a screen of {}", number("needed"), number("width")));
        }
        if number("missing") > 0.0 {
            faults.push(format!("{} pictures do not load", number("missing")));
        }
        // The size of ordinary print at arm's length.
        if number("smallest") < 14.0 {
            faults.push(format!("letters of {} px", number("smallest")));
        }
    }
    for dark in [true, false] {
        let of = |report: &&Value| report["dark"] == dark;
        let grounds: Vec<_> = seen.reports.iter().filter(of).map(|report| report["background"].to_string()).collect();
        let expected = if dark { "\"rgb(20, 23, 26)\"" } else { "\"rgb(255, 255, 255)\"" };
        if grounds.len() != WIDTHS.len() || grounds.iter().any(|ground| ground != expected) {
            faults.push(format!("dark = {dark}: backgrounds {grounds:?}"));
        }
    }
    faults
}

#[test]
fn the_page_of_the_paper_is_readable_at_every_width_light_and_dark() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_str().unwrap();
    crate::cli::document(&["paper", "--quick", "--only", "fig2,fig10,basin", "-o", path, "--json"]);
    let Some(seen) = look_at(&folder.path().join("index.html")) else { return };
    assert_eq!(faults(&seen), Vec::<String>::new());
    assert!(seen.reports.iter().all(|report| report["images"] == 3));
}

#[test]
fn a_page_that_is_wrong_is_found_out() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("wrong.html");
    let body = r#"<p style="width: 3000px; font-size: 9px">wide</p><img src="data:image/png;base64,AAAA"><script>console.error("broken")</script>"#;
    fs::write(&page, format!("<!DOCTYPE html><title>x</title>{body}")).unwrap();
    let Some(seen) = look_at(&page) else { return };
    let faults = faults(&seen).join("\n");
    for word in ["broken", "pixels wide", "do not load", "letters of 9 px", "backgrounds"] {
        assert!(faults.contains(word), "{word}: {faults}");
    }
}
