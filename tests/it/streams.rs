//! Standard error and standard output that cannot be written: full, closed, or read by nobody.
//!
//! News and messages that cannot be written are lost and change nothing. A reader of the result that has gone away
//! changes nothing either. A result that cannot be written for another reason is exit status 2.

use rayon::prelude::*;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Output, Stdio};

const SCENE: &str = include_str!("../inputs/short.toml");
const DISK: &str = include_str!("../inputs/disk.toml");
const MISTUNED: &str = include_str!("../inputs/mistuned.toml");

/// What is run: arguments, with `@` for a folder of its own. Every command, and a refusal of every kind.
const RUNS: &[&str] = &[
    "run @/scene.toml --renderer cpu -o @/run",
    "run @/scene.toml --renderer cpu -o @/run --json",
    "run @/nowhere.toml -o @/run",
    "simulate --t-end 5 -o @/t.csv",
    "simulate --gamma 7",
    "render @/scene.toml --with exact --renderer cpu -o @/film",
    "render @/scene.toml --with exact --renderer cpu --at 1 -o @/still.png",
    "contact-sheet @/kept --count 2 -o @/sheet.png",
    "animate @/kept --frames 0:2 -o @/a.gif",
    "animate @/nowhere -o @/a.gif",
    "gallery --only nothing -o @/gallery",
    "orbit --xi1 -0.03",
    "orbit --xi1 0.5",
    "branch --from -0.001 --to -0.01",
    "hopf --json",
    "lyapunov --t-end 60 --transient 20",
    "poincare --t-end 60 --transient 20",
    "diagram --from -0.01 --to -0.02 --count 2 --t-end 60 --transient 20",
    "slow-flow fold",
    "slow-flow hopf",
    "paper --quick --only fig1 -o @/paper",
    "paper --only nothing -o @/paper",
    "conformance export -o @/setups",
    "conformance judge @/limit_cycle.csv",
    "conformance judge @/wrong/limit_cycle.csv",
    "conformance judge @/nowhere.csv",
    "conformance --compare @/nowhere.json",
    "modes @/disk.toml",
    "disk waves @/disk.toml",
    "disk simulate @/disk.toml --t-end 5 -o @/d.csv",
    "disk cycle @/disk.toml",
    "disk flutter @/mistuned.toml --samples 2 --periods 20",
    "schema scene",
    "completions bash",
    "man",
    "--version",
    "--help",
    "--licences",
    "run --help",
    "run --nonsense",
    "diagram --count -1",
    "orbit --xi1 many",
    "nonsense",
];

/// Where a stream goes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Sink {
    Kept,
    /// A device on which no space is left.
    Full,
    /// A pipe whose reader has gone.
    Broken,
}

impl Sink {
    fn open(self) -> Stdio {
        match self {
            Self::Kept => Stdio::piped(),
            Self::Full => File::options().write(true).open("/dev/full").unwrap().into(),
            Self::Broken => {
                let (reader, writer) = std::io::pipe().unwrap();
                drop(reader);
                writer.into()
            }
        }
    }
}

fn put(folder: &Path, name: &str, text: &str) {
    let path = folder.join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
}

/// A folder with all the inputs.
fn inputs() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    put(folder.path(), "scene.toml", SCENE);
    put(folder.path(), "disk.toml", DISK);
    put(folder.path(), "mistuned.toml", MISTUNED);
    let run = |line: &str| program(line, folder.path()).output().unwrap();
    let made = run("conformance export -q -o @/setups");
    assert!(made.status.success(), "{made:?}");
    let reference = fs::read_to_string(folder.path().join("setups/limit_cycle.csv")).unwrap();
    fs::remove_dir_all(folder.path().join("setups")).unwrap();
    put(folder.path(), "limit_cycle.csv", &reference);
    // Twice the amplitude is wrong.
    let wrong = |line: &str| {
        line.split(',').enumerate().map(|(n, cell)| if n == 1 { "2.0" } else { cell }).collect::<Vec<_>>().join(",")
    };
    let (head, rows) = reference.split_once('\n').unwrap();
    let rows: Vec<String> = rows.lines().map(wrong).collect();
    put(folder.path(), "wrong/limit_cycle.csv", &format!("{head}\n{}\n", rows.join("\n")));
    let made = run("render @/scene.toml --with exact --renderer cpu -q -o @/kept");
    assert!(made.status.success(), "{made:?}");
    folder
}

fn program(line: &str, folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stickslip"));
    let place = folder.to_str().unwrap();
    command.args(line.split(' ').map(|argument| argument.replace('@', place)));
    // Logs too: of everything.
    command.env("RUST_LOG", "trace");
    command
}

/// The inputs anew, so that no run finds what another has left.
fn copied(inputs: &Path) -> tempfile::TempDir {
    fn copy(from: &Path, to: &Path) {
        fs::create_dir_all(to).unwrap();
        for entry in fs::read_dir(from).unwrap().map(|entry| entry.unwrap().path()) {
            let to = to.join(entry.file_name().unwrap());
            if entry.is_dir() { copy(&entry, &to) } else { fs::copy(&entry, &to).map(|_| ()).unwrap() }
        }
    }
    let folder = tempfile::tempdir().unwrap();
    copy(inputs, folder.path());
    folder
}

fn run(line: &str, inputs: &Path, stdout: Sink, stderr: Sink) -> Output {
    let folder = copied(inputs);
    program(line, folder.path()).stdin(Stdio::null()).stdout(stdout.open()).stderr(stderr.open()).output().unwrap()
}

/// With a stream closed by the shell that starts the program.
fn run_without(line: &str, inputs: &Path, stream: &str) -> Output {
    let folder = copied(inputs);
    let inner = program(line, folder.path());
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("exec \"$0\" \"$@\" {stream}>&-")]).arg(inner.get_program()).args(inner.get_args());
    shell.env("RUST_LOG", "trace").output().unwrap()
}

#[test]
fn streams_that_cannot_be_written_never_panic_and_leave_the_exit_status() {
    let inputs = inputs();
    let inputs = inputs.path();
    let faults: Vec<String> = RUNS
        .par_iter()
        .flat_map_iter(|line| {
            let usual = run(line, inputs, Sink::Kept, Sink::Kept);
            let status = usual.status.code();
            let message = String::from_utf8_lossy(&usual.stderr).into_owned();
            assert!(matches!(status, Some(0..=2)), "{line}: {status:?}: {message}");
            assert!(!message.contains("panicked"), "{line}: {message}");
            let mut faults = Vec::new();
            let mut expect = |what: &str, output: &Output, expected: Option<i32>| {
                let found = output.status.code();
                if found != expected {
                    let message = String::from_utf8_lossy(&output.stderr);
                    faults.push(format!("{line}, {what}: {found:?} instead of {expected:?}: {message}"));
                }
            };
            for sink in [Sink::Full, Sink::Broken] {
                let output = run(line, inputs, Sink::Kept, sink);
                expect(&format!("standard error {sink:?}"), &output, status);
                if output.stdout.is_empty() != usual.stdout.is_empty() {
                    expect(&format!("standard error {sink:?}: the result is lost"), &output, Some(99));
                }
            }
            expect("standard error closed", &run_without(line, inputs, "2"), status);
            expect("standard output closed", &run_without(line, inputs, "1"), status);
            expect("standard output broken", &run(line, inputs, Sink::Broken, Sink::Kept), status);
            expect("both broken", &run(line, inputs, Sink::Broken, Sink::Broken), status);
            // A result that is lost is no success, and no failed check either.
            let full = if usual.stdout.is_empty() { status } else { Some(2) };
            let output = run(line, inputs, Sink::Full, Sink::Kept);
            expect("standard output full", &output, full);
            if full == Some(2) && status != Some(2) {
                let message = String::from_utf8_lossy(&output.stderr).into_owned();
                if !message.contains("error: standard output") {
                    faults.push(format!("{line}: a result that is lost is not told: {message}"));
                }
            }
            faults
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn the_runs_reach_every_exit_status() {
    // Otherwise the test above would compare refusals with refusals.
    let inputs = inputs();
    let statuses: Vec<i32> =
        RUNS.par_iter().map(|line| run(line, inputs.path(), Sink::Kept, Sink::Kept).status.code().unwrap()).collect();
    let count = |status| statuses.iter().filter(|found| **found == status).count();
    let told: Vec<_> = RUNS.iter().zip(&statuses).collect();
    assert!(count(0) > 25 && count(1) >= 1 && count(2) > 8, "{told:#?}");
}

#[test]
fn a_whole_number_that_is_negative_is_refused_with_its_option_and_what_is_allowed() {
    let folder = tempfile::tempdir().unwrap();
    for (line, words) in [
        ("diagram --count -1", ["'-1'", "--count", "whole number that is not negative"]),
        ("diagram --count 2.5", ["'2.5'", "--count", "whole number"]),
        ("hopf --xi2 much", ["'much'", "--xi2", "a number, such as 0.05"]),
        ("lyapunov --seed -7", ["'-7'", "--seed", "not negative"]),
        ("lyapunov --seed 123456789012345678901234567890", ["'1234", "--seed", "fewer digits"]),
        ("run --substeps -3", ["'-3'", "--substeps", "not negative"]),
        ("slow-flow fold --nodes -2", ["'-2'", "--nodes", "not negative"]),
        ("slow-flow doublings --count -2", ["'-2'", "--count", "not negative"]),
        ("disk flutter x.toml --samples -2", ["'-2'", "--samples", "not negative"]),
        ("disk cycle x.toml --steps -2", ["'-2'", "--steps", "not negative"]),
        ("contact-sheet x --columns -2", ["-2", "--columns", "1..=20"]),
        ("render --frames -3:5", ["-3:5", "--frames", "A:B"]),
        ("render --shard -1/4", ["-1/4", "--shard", "K/N"]),
        ("run --size -64x64", ["-64x64", "--size", "1280x720"]),
    ] {
        let output = program(line, folder.path()).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{line}: {message}");
        for word in words {
            assert!(message.contains(word), "{line}: {word:?} is not in: {message}");
        }
        assert!(!message.contains("unexpected argument"), "{line}: {message}");
    }
}

#[test]
fn messages_stay_short_whatever_they_quote() {
    let folder = tempfile::tempdir().unwrap();
    let long = "y".repeat(100_000);
    for line in [
        format!("orbit --xi1 {long}"),
        long.clone(),
        format!("run {long}"),
        format!("simulate --initial {long}"),
        format!("conformance judge {long}/a.csv"),
    ] {
        let output = program(&line, folder.path()).env_remove("RUST_LOG").output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(!output.stderr.is_empty() && output.stderr.len() < 1000, "{} bytes", output.stderr.len());
    }
}
