//! What all commands share: `--json`, `-q`, `-o`, `--force`, and the document they print.

use anyhow::{Context, ensure};
use clap::Args;
use serde_json::{Map, Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub struct Common {
    /// Print exactly one JSON document on standard output.
    #[arg(long)]
    pub json: bool,
    /// No progress and no logs.
    #[arg(short, long)]
    pub quiet: bool,
    /// Where files go.
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Replace existing output that other parameters made.
    #[arg(long)]
    pub force: bool,
}

impl Common {
    /// For commands that only print.
    pub fn no_files(&self, command: &str) -> anyhow::Result<()> {
        ensure!(
            self.output.is_none(),
            "`{command}` writes no files: leave out -o and take its standard output (--json)"
        );
        Ok(())
    }
}

/// Refuses a file that is there already, before anything is computed for it.
pub fn refuse_existing(path: &Path, force: bool) -> anyhow::Result<()> {
    ensure!(force || !path.exists(), "{} exists: replace it with --force", path.display());
    Ok(())
}

/// The JSON document of a command.
#[derive(Debug)]
pub struct Document(Map<String, Value>);

impl Document {
    pub fn new(command: &str, parameters: Value) -> Self {
        let mut fields = Map::new();
        fields.insert("stickslip".to_owned(), json!(env!("CARGO_PKG_VERSION")));
        fields.insert("command".to_owned(), json!(command));
        fields.insert("parameters".to_owned(), parameters);
        Self(fields)
    }

    pub fn with(mut self, key: &str, value: Value) -> Self {
        self.0.insert(key.to_owned(), value);
        self
    }

    pub fn text(&self) -> anyhow::Result<String> {
        serde_json::to_string_pretty(&self.0).context("the result could not be written as JSON")
    }
}

/// Writes to standard output; a reader that has gone away is no error.
pub fn print(text: &str) -> anyhow::Result<()> {
    match writeln!(std::io::stdout(), "{text}") {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error).context("standard output"),
        _ => Ok(()),
    }
}
