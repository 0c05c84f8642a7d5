//! `--plot`: the result of an analysis command as a picture.

use crate::report::Chart;
use anyhow::ensure;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct PlotArgs {
    /// Also draw the result to this file, .svg or .png.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
}

impl PlotArgs {
    /// Refuses before anything is computed what could not be written after.
    pub fn check(&self, force: bool) -> anyhow::Result<()> {
        let Some(path) = &self.plot else { return Ok(()) };
        let known = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("svg") || e.eq_ignore_ascii_case("png"));
        ensure!(known, "--plot {}: name a file ending in .svg or .png", path.display());
        ensure!(
            force || !path.exists(),
            "--plot {} exists: choose another file, or replace it with --force",
            path.display()
        );
        Ok(())
    }

    pub fn draw(&self, chart: impl FnOnce() -> anyhow::Result<Chart>) -> anyhow::Result<()> {
        match &self.plot {
            Some(path) => Ok(chart()?.write(path)?),
            None => Ok(()),
        }
    }
}
