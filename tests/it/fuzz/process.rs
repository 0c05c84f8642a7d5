//! The program with bounds: processor time, memory and size of files.

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, Stdio};

/// Seconds of processor time, of the development build.
const SECONDS: u32 = 30;
/// Address space in kB: 1 GB, and the share of shared libraries and stacks of threads that is never touched.
const MEMORY: u32 = 1_200_000;

/// How a run ended.
#[derive(Debug, Clone, PartialEq)]
pub enum End {
    Status(i32),
    /// It ran out of its time, but had said that it is at work, as in the last line that it said.
    Announced(String),
}

/// Runs in `folder`; a fault is what must never happen.
pub fn run(arguments: &[String], folder: &Path) -> Result<End, String> {
    let limits = format!(
        "ulimit -c 0; ulimit -t {SECONDS}; ulimit -v {MEMORY}; trap '' XFSZ; ulimit -f 200000; exec \"$0\" \"$@\""
    );
    let mut command = Command::new("timeout");
    command.args(["-s", "KILL", "600", "sh", "-c", &limits, env!("CARGO_BIN_EXE_stickslip")]).args(arguments);
    command.current_dir(folder).stdin(Stdio::null());
    // Stacks of threads count as address space.
    command.env("RAYON_NUM_THREADS", "2").env_remove("RUST_LOG").env("RUST_BACKTRACE", "0");
    // Into a file: the result of a run may be large.
    let printed = folder.join("printed");
    command.stdout(fs::File::create(&printed).map_err(|error| error.to_string())?);
    let output = command.output().map_err(|error| error.to_string())?;
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    let told = || format!("{}\n{}", arguments.join(" "), message.chars().take(1500).collect::<String>());
    if message.contains("panicked") {
        return Err(format!("panic: {}", told()));
    }
    match (output.status.code(), output.status.signal()) {
        (Some(status @ (0 | 1)), _) => Ok(End::Status(status)),
        (Some(2), _) => {
            refusal(arguments, &message).map(|()| End::Status(2)).map_err(|fault| format!("{fault}: {}", told()))
        }
        // Killed at the end of its time, by the kernel or by `timeout`.
        (Some(137), _) | (None, Some(9 | 24)) if is_at_work(&message) => {
            Ok(End::Announced(message.lines().last().unwrap_or_default().to_owned()))
        }
        (Some(137), _) | (None, Some(9 | 24)) => Err(format!("no end within {SECONDS} s, and no word: {}", told())),
        (code, signal) => Err(format!("exit status {code:?}, signal {signal:?}: {}", told())),
    }
}

/// A heartbeat, `3 of 100 frames`, or an estimate of the time.
fn is_at_work(message: &str) -> bool {
    let number = |text: &str| text.starts_with(|c: char| c.is_ascii_digit());
    let counts = |line: &str| {
        let words: Vec<&str> = line.split(' ').collect();
        words.windows(3).any(|w| number(w[0]) && w[1] == "of" && number(w[2]))
    };
    message.lines().any(|line| counts(line) || line.contains("estimate") || line.contains(" left"))
}

/// A refusal is short, and names an option, a field or a file.
fn refusal(arguments: &[String], message: &str) -> Result<(), String> {
    // Help that is given in the place of an error.
    if message.contains("Usage:") && !message.contains("error:") {
        return Ok(());
    }
    if message.len() >= 1000 {
        return Err(format!("a message of {} bytes", message.len()));
    }
    // As a word of the message, be it as short as a digit.
    let is_word = |part: &str| {
        let inner = |c: Option<char>| c.is_some_and(char::is_alphanumeric);
        let mut places = message.match_indices(part);
        !part.is_empty()
            && places.any(|(at, _)| {
                !inner(message[..at].chars().next_back()) && !inner(message[at + part.len()..].chars().next())
            })
    };
    let named = |argument: &String| {
        let (name, value) = argument.split_once('=').unwrap_or((argument, argument));
        is_word(name) || is_word(value)
    };
    let marks = ["`", "--", "field ", "subcommand", " = ", ".csv", ".json", ".toml", ".parquet", "left out ..."];
    if arguments.iter().skip(1).any(named) || marks.iter().any(|mark| message.contains(mark)) {
        return Ok(());
    }
    Err("a message that names neither option nor field nor file".to_owned())
}
