//! Command lines made of the options that `--help` tells of, so that no new one is forgotten.

use super::dice::Dice;
use std::process::Command;

/// A command with its subcommands, options and positional arguments, as `--help` shows them.
#[derive(Debug, Clone)]
pub struct Grammar {
    words: Vec<String>,
    options: Vec<Argument>,
    positional: Vec<String>,
}

#[derive(Debug, Clone)]
struct Argument {
    name: String,
    /// None for a flag.
    value: Option<String>,
    words: Vec<String>,
}

/// Values for every kind of argument.
const WORDS: [&str; 26] = [
    "scene.toml",
    "disk.toml",
    "mistuned.toml",
    "broken.toml",
    "nowhere.toml",
    "endless.toml",
    "folder",
    "story.toml",
    "t.csv",
    "t.parquet",
    "limit_cycle.csv",
    "limit_cycle.json",
    "endless.csv",
    "out.png",
    "out.svg",
    "out.csv",
    "out.parquet",
    "out.gif",
    "out",
    "film",
    "report.json",
    "",
    "é",
    "-",
    "binary.toml",
    "empty.csv",
];
const SHAPES: [&str; 14] = [
    "0:5",
    "3:1",
    "1/4",
    "0/0",
    "5/4",
    "64x64",
    "0x0",
    "65536x65536",
    "kappa=0.1:0.2:2",
    "xi1=0:0:1",
    "gamma=1:0:100000000",
    "0,0,0,0,0.5",
    "nan,0,0,0,0",
    "1e308,1e308,0,0,0",
];

/// What keeps a command short where it says nothing else about it.
const SHORT: [(&str, &[&str]); 12] = [
    ("run", &["--size=64x64", "--t-end=2", "--renderer=cpu", "--output=out"]),
    ("render", &["--size=64x64", "--t-end=2", "--renderer=cpu", "--output=out"]),
    ("gallery", &["--only=nothing", "--output=out"]),
    ("simulate", &["--t-end=5"]),
    ("diagram", &["--count=2", "--t-end=40", "--transient=10"]),
    ("lyapunov", &["--t-end=40", "--transient=10"]),
    ("poincare", &["--t-end=40", "--transient=10"]),
    ("paper", &["--quick", "--only=fig1", "--output=out"]),
    ("branch", &["--from=-0.001", "--to=-0.004"]),
    ("disk flutter", &["--samples=1", "--periods=20"]),
    ("disk cycle", &["--settle=100"]),
    ("conformance", &["--compare=nowhere.json"]),
];

impl Grammar {
    /// All commands that can be run, from the help of the program.
    pub fn all() -> Vec<Self> {
        let mut found = Vec::new();
        let mut open = vec![Vec::<String>::new()];
        while let Some(words) = open.pop() {
            let output = Command::new(env!("CARGO_BIN_EXE_stickslip")).args(&words).arg("--help").output().unwrap();
            let help = String::from_utf8(output.stdout).unwrap();
            for name in section(&help, "Commands:").into_iter().filter_map(|line| word_at(&line, 2)) {
                if name != "help" {
                    open.push(words.iter().cloned().chain([name]).collect());
                }
            }
            let positional = section(&help, "Arguments:").into_iter().filter_map(|line| word_at(&line, 2)).collect();
            found.push(Self { options: options(&help), positional, words });
        }
        found
    }

    /// Arguments of a run.
    pub fn line(&self, dice: &mut Dice) -> Vec<String> {
        let mut line = self.words.clone();
        for _ in &self.positional {
            if !dice.once_in(8) {
                line.push(value(dice, "FILE", &[]));
            }
        }
        let mut given = Vec::new();
        for _ in 0..dice.below(5) {
            if self.options.is_empty() {
                break;
            }
            let option = dice.pick(&self.options).clone();
            if option.name == "--help" && !dice.once_in(10) {
                continue;
            }
            given.push(option.name.clone());
            let Some(kind) = option.value else {
                line.push(option.name);
                continue;
            };
            let value = value(dice, &kind, &option.words);
            if dice.once_in(2) {
                line.push(format!("{}={value}", option.name));
            } else {
                line.extend([option.name, value]);
            }
        }
        let command = self.words.join(" ");
        let short = SHORT.iter().find(|(name, _)| *name == command).map_or(&[][..], |(_, short)| short);
        let name = |argument: &str| argument.split('=').next().unwrap_or_default().to_owned();
        line.extend(short.iter().filter(|argument| !given.contains(&name(argument))).map(|s| (*s).to_owned()));
        line
    }
}

/// Mostly of the kind that the placeholder asks for.
fn value(dice: &mut Dice, kind: &str, words: &[String]) -> String {
    if !words.is_empty() && !dice.once_in(6) {
        return dice.pick(words).clone();
    }
    let is_file = ["FILE", "PATH", "DIR", "json"].iter().any(|word| kind.contains(word));
    let is_shape = kind.contains([':', '/', ',', '=']) || kind.contains("WIDTH");
    match dice.below(12) {
        0 => dice.number(),
        1 => (*dice.pick(&SHAPES)).to_owned(),
        2 if dice.once_in(6) => "y".repeat(5_000),
        2 => (*dice.pick(&WORDS)).to_owned(),
        // The first ones are those that most commands can use.
        3..=8 if is_file => WORDS[dice.below(3)].to_owned(),
        _ if is_file => (*dice.pick(&WORDS)).to_owned(),
        _ if is_shape => (*dice.pick(&SHAPES)).to_owned(),
        _ => dice.number(),
    }
}

/// Lines below a heading, up to the next line that is not indented.
fn section(help: &str, heading: &str) -> Vec<String> {
    let lines = help.lines().skip_while(|line| *line != heading).skip(1);
    lines.take_while(|line| line.is_empty() || line.starts_with(' ')).map(str::to_owned).collect()
}

/// The first word, if the line is indented by just so much.
fn word_at(line: &str, indent: usize) -> Option<String> {
    let rest = line.strip_prefix(&" ".repeat(indent)).filter(|rest| !rest.starts_with(' '))?;
    rest.split_whitespace().next().map(str::to_owned)
}

fn options(help: &str) -> Vec<Argument> {
    let mut options: Vec<Argument> = Vec::new();
    for line in help.lines().map(str::trim_start) {
        if line.starts_with('-') && !line.starts_with("- ") {
            let mut words = line.split_whitespace().filter(|word| *word != "-").map(|word| word.trim_end_matches(','));
            let name = words.clone().find(|word| word.starts_with("--"));
            let Some(name) = name else { continue };
            let value = words.find(|word| word.starts_with('<')).map(str::to_owned);
            options.push(Argument { name: name.to_owned(), value, words: Vec::new() });
        }
        let Some(last) = options.last_mut() else { continue };
        if let Some(list) = line.split("[possible values: ").nth(1) {
            last.words.extend(list.trim_end_matches(']').split(", ").map(str::to_owned));
        } else if let Some(word) = line.strip_prefix("- ").filter(|_| last.value.is_some()) {
            last.words.push(word.split(':').next().unwrap_or_default().to_owned());
        }
    }
    options
}

#[test]
fn the_grammar_knows_every_command() {
    let all = Grammar::all();
    let find = |words: &str| all.iter().find(|grammar| grammar.words.join(" ") == words);
    for words in ["run", "disk flutter", "slow-flow doublings", "conformance judge", "orbit", "man"] {
        assert!(find(words).is_some(), "{words} is not among {} commands", all.len());
    }
    let simulate = find("simulate").unwrap();
    let with = simulate.options.iter().find(|option| option.name == "--with").unwrap();
    assert!(with.words.contains(&"rapier".to_owned()), "{with:?}");
    assert!(simulate.options.iter().any(|option| option.name == "--json" && option.value.is_none()));
}
