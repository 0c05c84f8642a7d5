//! Inputs that are nearly right, by a seed: scenes, stories, stored trajectories, set-ups and baselines of conformance,
//! finished films, command lines. None may make the program panic, run without an end or a word, take more than 1 GB of
//! memory, or end with an exit status other than 0, 1 and 2; and a refusal is shorter than 1 kB and names an option, a
//! field or a file.
//!
//! Texts and tables are read in this process, thousands a second; a part of them, and all command lines, by the program
//! itself under limits. `STICKSLIP_FUZZ=10000 cargo test --test it fuzz -- --nocapture` runs so many inputs;
//! `STICKSLIP_FUZZ_SEED` takes others, and `STICKSLIP_FUZZ_ONLY` a single one by its number.

mod commands;
mod dice;
mod process;
mod tables;
mod texts;

use commands::Grammar;
use dice::Dice;
use process::End;
use rayon::prelude::*;
use std::any::Any;
use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;
use stickslip::conformance::{Baseline, Setup, setups};
use stickslip::scene::{BUILT_IN, BUILT_IN_DISKS, Scene, Story};
use stickslip::store::{Table, read_table};

/// Inputs of the usual tests.
const SLICE: u64 = 400;
/// An input in this process takes milliseconds.
const PATIENCE: u64 = 60;

const SCENE: &str = include_str!("../../inputs/short.toml");
const DISK: &str = include_str!("../../inputs/disk.toml");
const MISTUNED: &str = include_str!("../../inputs/mistuned.toml");
const BASELINE: &str = r#"{"stickslip": "0.1.0", "command": "conformance baseline", "parameters": {"depth":"quick"},
"engines": ["rapier3d"], "rows": {
"chaos | | f64": {
"256 | bounded": {"verdict":"passed","physics":"right","found":1.0,"tolerance":0.0}
}}}
"#;

/// What inputs are made from.
struct Corpus {
    scenes: Vec<String>,
    stories: Vec<String>,
    tables: Vec<Table>,
    setups: Vec<Setup>,
    /// Names and bytes of the files of a film that is finished.
    film: Vec<(String, Vec<u8>)>,
    grammars: Vec<Grammar>,
}

fn variable(name: &str) -> Option<u64> {
    std::env::var(name).ok().map(|text| text.parse().unwrap_or_else(|_| panic!("{name}={text} is no number")))
}

fn words(line: &str) -> Vec<String> {
    line.split(' ').map(str::to_owned).collect()
}

impl Corpus {
    fn new() -> Self {
        let built_in = BUILT_IN.iter().chain(&BUILT_IN_DISKS).map(|(_, text)| (*text).to_owned());
        let own = [SCENE.to_owned(), DISK.to_owned(), MISTUNED.to_owned()];
        let scenes: Vec<String> = built_in.chain(own).collect();
        let part = SCENE.replace("\n[", "\n[scene.");
        let stories =
            vec![include_str!("../../../stories/paper.toml").to_owned(), format!("[[scene]]\n{part}[[scene]]\n{part}")];
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
        let simulated =
            ["simulate --t-end 4 -o a.csv", "simulate --scene scene.toml --with rapier -o b.csv"].map(|line| {
                assert_eq!(process::run(&words(line), folder.path()), Ok(End::Status(0)), "{line}");
                read_table(&folder.path().join(line.rsplit(' ').next().unwrap())).unwrap()
            });
        let line = "render scene.toml --with exact --renderer cpu -o film";
        assert_eq!(process::run(&words(line), folder.path()), Ok(End::Status(0)), "{line}");
        let mut film = Vec::new();
        for part in ["film", "film/frames"] {
            for path in fs::read_dir(folder.path().join(part)).unwrap().map(|entry| entry.unwrap().path()) {
                if path.is_file() {
                    let name = path.strip_prefix(folder.path()).unwrap().to_str().unwrap().to_owned();
                    film.push((name, fs::read(&path).unwrap()));
                }
            }
        }
        Self { film, scenes, stories, tables: simulated.into(), setups: setups().unwrap(), grammars: Grammar::all() }
    }
}

/// The folder in which a run finds all that its arguments can name, and leaves what it makes.
fn playground(corpus: &Corpus) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    put("scene.toml", SCENE.as_bytes());
    put("disk.toml", DISK.as_bytes());
    put("mistuned.toml", MISTUNED.as_bytes());
    put("broken.toml", b"title = \"x\"\n[rig\n");
    put("binary.toml", &[0, 159, 146, 150, 255, 0, 1]);
    put("story.toml", corpus.stories[1].as_bytes());
    put("empty.csv", b"");
    let cycle = corpus.setups.iter().find(|setup| setup.name == "limit_cycle").unwrap();
    put("limit_cycle.csv", cycle.csv().as_bytes());
    put("limit_cycle.json", serde_json::to_string(cycle).unwrap().as_bytes());
    put("report.json", b"{\"rows\": {}}");
    for name in ["t.csv", "t.parquet"] {
        stickslip::store::write_table(&folder.path().join(name), &corpus.tables[0]).unwrap();
    }
    fs::create_dir(folder.path().join("folder")).unwrap();
    // Links: what is written in their place replaces the link alone.
    #[cfg(unix)]
    for name in ["endless.toml", "endless.csv"] {
        std::os::unix::fs::symlink("/dev/zero", folder.path().join(name)).unwrap();
    }
    folder
}

fn told(panic: &(dyn Any + Send)) -> String {
    panic
        .downcast_ref::<String>()
        .cloned()
        .or(panic.downcast_ref::<&str>().map(|s| (*s).to_owned()))
        .unwrap_or_default()
}

/// In this process; a panic is a fault, and so is a refusal that is too long or names nothing.
fn quietly(words: &[&str], read: impl FnOnce() -> Result<(), String>) -> Result<&'static str, String> {
    match catch_unwind(AssertUnwindSafe(read)) {
        Err(panic) => Err(format!("panic: {}", told(panic.as_ref()))),
        Ok(Ok(())) => Ok("accepted"),
        Ok(Err(message)) if words.iter().any(|word| message.contains(word)) => Ok("refused"),
        Ok(Err(message)) => Err(format!("names neither field nor file: {message}")),
    }
}

/// A directory in which a film is finished, one of its files changed.
fn changed_film(corpus: &Corpus, dice: &mut Dice) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    fs::create_dir_all(folder.path().join("film/frames")).unwrap();
    let texts = ["film/frames.json", "film/manifest.json", "film/outputs.jsonl"];
    let changed = *dice.pick(&texts);
    for (name, bytes) in &corpus.film {
        let bytes = match String::from_utf8(bytes.clone()) {
            Ok(text) if name == changed => texts::changed(dice, &text, std::slice::from_ref(&text)).into_bytes(),
            _ => bytes.clone(),
        };
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

const ON_A_FILM: [&str; 4] = [
    "animate film -o a.gif",
    "contact-sheet film --count 2 -o sheet.png",
    "render scene.toml --with exact --renderer cpu -o film",
    "render scene.toml --with exact --renderer cpu -o film --force",
];

/// A command that a scene can be given to, shortened.
const ON_A_SCENE: [&str; 8] = [
    "modes scene.toml",
    "disk waves scene.toml",
    "simulate --scene scene.toml --t-end 2",
    "disk simulate scene.toml --t-end 2",
    "orbit --scene scene.toml",
    "render scene.toml --with exact --renderer cpu --t-end 2 --at 1 --size 64x64 -o out.png",
    "run scene.toml --renderer cpu --t-end 1 --size 64x64 --frames 0:1 -o out",
    "disk cycle scene.toml --settle 50",
];

/// One input, and what became of it.
fn input(corpus: &Corpus, seed: u64, number: u64) -> Result<String, String> {
    let mut dice = Dice::of(seed, number);
    let dice = &mut dice;
    let ended = |end: End| format!("{end:?}");
    match number % 10 {
        0..=2 => {
            let base = dice.pick(&corpus.scenes);
            let text = texts::changed(dice, base, &corpus.scenes);
            let found = quietly(&["line ", "field "], || {
                Scene::parse(&text, "scene.toml").map(|_| ()).map_err(|e| e.to_string())
            })
            .map_err(|fault| format!("{fault}\n{}", shown(&text)))?;
            if found == "accepted" && dice.once_in(4) || dice.once_in(20) {
                let folder = tempfile::tempdir().unwrap();
                fs::write(folder.path().join("scene.toml"), &text).unwrap();
                let line = dice.pick(&ON_A_SCENE);
                let end = process::run(&words(line), folder.path());
                return end
                    .map(|end| format!("scene, {}", ended(end)))
                    .map_err(|fault| format!("{fault}\n{}", shown(&text)));
            }
            Ok(format!("scene, {found}"))
        }
        3 => {
            let base = dice.pick(&corpus.stories);
            let text = texts::changed(dice, base, &corpus.scenes);
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("story.toml");
            fs::write(&path, &text).unwrap();
            let read = || {
                let story = Story::load(&path).map_err(|error| error.to_string())?;
                story.cases(&path.display().to_string()).map(|_| ()).map_err(|error| error.to_string())
            };
            let found =
                quietly(&["line ", "field ", "scene "], read).map_err(|fault| format!("{fault}\n{}", shown(&text)))?;
            if dice.once_in(20) {
                let line = words("run --story story.toml --renderer cpu --size 64x64 --frames 0:1 --t-end 1 -o out");
                let end = process::run(&line, folder.path());
                return end
                    .map(|end| format!("story, {}", ended(end)))
                    .map_err(|fault| format!("{fault}\n{}", shown(&text)));
            }
            Ok(format!("story, {found}"))
        }
        4 | 5 => {
            let folder = tempfile::tempdir().unwrap();
            let name = if dice.once_in(2) { "t.csv" } else { "t.parquet" };
            let path = folder.path().join(name);
            let table = dice.pick(&corpus.tables);
            tables::write_changed(dice, table, &path);
            let found = quietly(&[name], || tables::read(&path))?;
            if found == "accepted" && dice.once_in(2) || dice.once_in(20) {
                let line = format!("render --trajectory {name} --renderer cpu --at 1 --size 64x64 -o out.png");
                return process::run(&words(&line), folder.path()).map(|end| format!("table, {}", ended(end)));
            }
            Ok(format!("table, {found}"))
        }
        6 if dice.once_in(6) => {
            let folder = changed_film(corpus, dice);
            let line = dice.pick(&ON_A_FILM);
            process::run(&words(line), folder.path()).map(|end| format!("film, {}", ended(end)))
        }
        6 if dice.once_in(5) => {
            let text = texts::changed(dice, BASELINE, &[BASELINE.to_owned()]);
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("old.json");
            fs::write(&path, &text).unwrap();
            let read = || Baseline::read(&path).map(|_| ()).map_err(|error| error.to_string());
            quietly(&["old.json"], read).map(|found| format!("baseline, {found}"))
        }
        6 => {
            let setup = dice.pick(&corpus.setups);
            let folder = tempfile::tempdir().unwrap();
            let (json, csv) = (serde_json::to_string_pretty(setup).unwrap(), setup.csv());
            let others = [json.clone(), csv.clone()];
            let at = |name: &str| folder.path().join(name);
            fs::create_dir(at("mine")).unwrap();
            let (json, reference, mine) = match dice.below(3) {
                0 => (texts::changed(dice, &json, &others), csv.clone(), csv),
                1 => (json, texts::changed(dice, &csv, &others), csv),
                _ => (json, csv.clone(), texts::changed(dice, &csv, &others)),
            };
            fs::write(at("a.json"), json).unwrap();
            fs::write(at("a.csv"), reference).unwrap();
            fs::write(at("mine/a.csv"), mine).unwrap();
            let read = || {
                let setup = Setup::read(folder.path(), "a").map_err(|error| error.to_string())?;
                setup.judge(&at("mine/a.csv")).map(|_| ()).map_err(|error| error.to_string())
            };
            let found = quietly(&["a.csv", "a.json"], read)?;
            if dice.once_in(10) {
                let end = process::run(&words("conformance judge --setups . mine/a.csv"), folder.path());
                return end.map(|end| format!("set-up, {}", ended(end)));
            }
            Ok(format!("set-up, {found}"))
        }
        _ => {
            let line = dice.pick(&corpus.grammars).line(dice);
            let folder = playground(corpus);
            process::run(&line, folder.path()).map(|end| format!("command line, {}", ended(end)))
        }
    }
}

fn shown(text: &str) -> String {
    text.chars().take(1500).collect()
}

/// Largest memory that this process has had, in kB.
fn peak() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?.trim().strip_suffix(" kB")?.trim().parse().ok()
}

#[test]
fn nearly_right_inputs_are_answered() {
    let count = variable("STICKSLIP_FUZZ").unwrap_or(SLICE);
    let seed = variable("STICKSLIP_FUZZ_SEED").unwrap_or(1);
    let only = variable("STICKSLIP_FUZZ_ONLY");
    let corpus = Corpus::new();
    let numbers: Vec<u64> = only.map_or_else(|| (0..count).collect(), |number| vec![number]);
    let before = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let slowest = AtomicU64::new(0);
    let results: Vec<(u64, Result<String, String>)> = numbers
        .par_iter()
        .with_max_len(1)
        .map(|&number| {
            let begun = Instant::now();
            let result = catch_unwind(AssertUnwindSafe(|| input(&corpus, seed, number)))
                .unwrap_or_else(|panic| Err(format!("panic outside the readers: {}", told(panic.as_ref()))));
            let seconds = begun.elapsed().as_secs();
            slowest.fetch_max(seconds, Ordering::Relaxed);
            let late = seconds > PATIENCE && !result.as_ref().is_ok_and(|end| end.contains("Announced"));
            (number, if late { Err(format!("took {seconds} s: {result:?}")) } else { result })
        })
        .collect();
    std::panic::set_hook(before);
    let mut tally: BTreeMap<&str, usize> = BTreeMap::new();
    let mut faults = Vec::new();
    for (number, result) in &results {
        match result {
            Ok(end) if end.contains("Announced") => println!("input {number} of seed {seed} goes on: {end}"),
            Ok(end) => *tally.entry(end).or_default() += 1,
            Err(fault) => faults.push(format!("input {number} of seed {seed}: {fault}")),
        }
    }
    println!(
        "{} inputs, slowest {} s, peak of the readers {:?} kB: {tally:#?}",
        results.len(),
        slowest.into_inner(),
        peak()
    );
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n\n"));
    if only.is_none() && count >= SLICE {
        // Something was accepted and something refused, by readers and by the program.
        for kind in [
            "scene, accepted",
            "scene, refused",
            "table, accepted",
            "table, refused",
            "command line, Status(0)",
            "command line, Status(2)",
        ] {
            assert!(tally.contains_key(kind), "no {kind} in {tally:#?}");
        }
    }
    // Run alone, this process has had nothing but the inputs in its memory.
    if variable("STICKSLIP_FUZZ").is_some() {
        assert!(peak().is_none_or(|peak| peak < 1_000_000), "{:?} kB", peak());
    }
}

#[test]
fn a_program_that_breaks_would_be_found() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(process::run(&words("--version"), folder.path()), Ok(End::Status(0)));
    let panics = || -> Result<(), String> { panic!("as it should not") };
    let before = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let found = quietly(&[], panics);
    std::panic::set_hook(before);
    assert!(found.is_err_and(|fault| fault.contains("as it should not")));
    assert!(quietly(&["line "], || Err("something is wrong".to_owned())).is_err());
}

#[test]
fn the_same_number_gives_the_same_input() {
    let text = |number| texts::changed(&mut Dice::of(1, number), SCENE, &[DISK.to_owned()]);
    assert_eq!(text(7), text(7));
    assert!((0..20).any(|number| text(number) != text(7)), "numbers make a difference");
}
