//! Progress on standard error: a bar on a terminal, a plain line now and then elsewhere, nothing with `-q`.

use super::streams::tell;
use crate::film;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Time between two plain lines.
const HEARTBEAT: Duration = Duration::from_secs(5);

pub enum Progress {
    Bar(ProgressBar),
    Plain { last: Option<Instant> },
    Silent,
}

impl Progress {
    pub fn new(quiet: bool) -> Self {
        if quiet {
            return Self::Silent;
        }
        if !std::io::stderr().is_terminal() {
            return Self::Plain { last: None };
        }
        let style = ProgressStyle::with_template("{prefix} [{bar:40}] {pos}/{len} frames, {per_sec}, {eta} left")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        Self::Bar(ProgressBar::new(0).with_style(style.progress_chars("=> ")).with_prefix("film"))
    }

    /// One line of news.
    pub fn say(&self, line: &str) {
        match self {
            Self::Bar(bar) => bar.suspend(|| tell(line)),
            Self::Plain { .. } => tell(line),
            Self::Silent => {}
        }
    }

    pub fn frame(&mut self, at: film::Progress) {
        match self {
            Self::Bar(bar) => {
                bar.set_length(at.total);
                bar.set_position(at.done);
                if at.done == at.total {
                    bar.finish();
                }
            }
            Self::Plain { last } => {
                if at.done == at.total || last.is_none_or(|last| last.elapsed() >= HEARTBEAT) {
                    tell(&format!("film: {} of {} frames ({} reused)", at.done, at.total, at.reused));
                    *last = Some(Instant::now());
                }
            }
            Self::Silent => {}
        }
    }
}

/// Progress of a long computation on several threads: one line now and then on standard error, with an estimate of the time that is left.
pub struct Heartbeat {
    quiet: bool,
    what: &'static str,
    unit: &'static str,
    start: Instant,
    last: Mutex<Instant>,
}

impl Heartbeat {
    pub fn new(quiet: bool, what: &'static str, unit: &'static str) -> Self {
        let start = Instant::now();
        Self { quiet, what, unit, start, last: Mutex::new(start) }
    }

    pub fn at(&self, done: usize, all: usize) {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if !self.quiet && last.elapsed() >= HEARTBEAT {
            let left = self.start.elapsed().as_secs_f64() * (all - done) as f64 / done.max(1) as f64;
            tell(&format!("{}: {done} of {all} {}, about {} left", self.what, self.unit, duration(left)));
            *last = Instant::now();
        }
    }
}

/// Seconds as one reads them: `40 s`, `7 min`, `3.5 h`, `12 days`.
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 6000.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.0} days", s / 86_400.0),
    }
}
