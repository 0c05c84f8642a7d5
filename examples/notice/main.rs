//! Writes NOTICE: the licences of all packages in the program, made from Cargo.lock and the sources that cargo keeps.
//!
//! `cargo run --example notice`
//!
//! Where a package may be used under the Apache License 2.0, it is: one text serves them all. Of the others every text
//! is given, each once, with the packages it belongs to. Texts of what packages bring along (C sources, fonts) are
//! given in any case.

mod lock;

use anyhow::{Context, bail, ensure};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const APACHE: &str = "Apache-2.0";

const HEAD: &str = "Notices of the software in stickslip

stickslip itself is licensed under MIT OR Apache-2.0, see LICENSE-MIT and LICENSE-APACHE. This file is made from
Cargo.lock by `cargo run --example notice`, and printed by `stickslip --licences`. It names every package that the
program is made of or made with on some platform, with the licence it is used under, and then gives the texts of the
licences.
";

/// Texts of licences whose packages bring none: the holders stand in the place of `{}`.
const TEMPLATES: [(&str, &str); 2] =
    [("MIT", include_str!("mit.txt")), ("BSD-2-Clause", include_str!("bsd_2_clause.txt"))];

/// Texts and whom they belong to.
#[derive(Default)]
struct Texts(BTreeMap<String, BTreeSet<String>>);

impl Texts {
    /// Line ends, outer spaces and spaces at the ends of lines do not make a text another one.
    fn add(&mut self, text: &str, owner: &str) {
        let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
        self.0.entry(lines.join("\n").trim_matches('\n').to_owned()).or_default().insert(owner.to_owned());
    }
}

fn main() -> anyhow::Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let table = |name: &str| -> anyhow::Result<toml::Table> { Ok(fs::read_to_string(root.join(name))?.parse()?) };
    let packages = lock::packages(&table("Cargo.toml")?, &table("Cargo.lock")?).map_err(anyhow::Error::msg)?;
    let folders = folders(root)?;
    let (mut list, mut texts) = (String::new(), Texts::default());
    for (name, version) in &packages {
        let folder = folders.get(&(name.clone(), version.clone()));
        let folder = folder.with_context(|| format!("cargo metadata has no sources of {name} {version}"))?;
        let licence = take(folder, name, version, &mut texts).with_context(|| format!("{name} {version}"))?;
        writeln!(list, "  {name} {version}: {licence}")?;
    }
    let mut notice = format!("{HEAD}\n{list}");
    let mut section = |title: &str, text: &str| write!(notice, "\n{}\n{title}\n\n{text}\n", "=".repeat(78));
    for (text, owners) in &texts.0 {
        section(&owners.iter().map(String::as_str).collect::<Vec<_>>().join("\n"), text)?;
    }
    let apache = fs::read_to_string(root.join("LICENSE-APACHE"))?;
    section("All packages above with Apache-2.0", apache.trim_matches('\n'))?;
    fs::write(root.join("NOTICE"), notice)?;
    Ok(())
}

/// Where cargo keeps the sources of every package; it fetches those that are missing.
fn folders(root: &Path) -> anyhow::Result<BTreeMap<lock::Package, PathBuf>> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output =
        Command::new(cargo).args(["metadata", "--locked", "--format-version", "1"]).current_dir(root).output()?;
    ensure!(output.status.success(), "cargo metadata: {}", String::from_utf8_lossy(&output.stderr));
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout)?;
    let packages = metadata["packages"].as_array().context("cargo metadata lists no packages")?;
    let text = |package: &serde_json::Value, field: &str| package[field].as_str().unwrap_or_default().to_owned();
    let folder =
        |package| PathBuf::from(text(package, "manifest_path")).parent().map(Path::to_owned).unwrap_or_default();
    Ok(packages.iter().map(|package| ((text(package, "name"), text(package, "version")), folder(package))).collect())
}

/// Adds the texts of a package and returns the licence it is used under.
fn take(folder: &Path, name: &str, version: &str, texts: &mut Texts) -> anyhow::Result<String> {
    let manifest: toml::Table = fs::read_to_string(folder.join("Cargo.toml"))?.parse()?;
    let field = |field: &str| manifest["package"].get(field).and_then(toml::Value::as_str).map(str::to_owned);
    let (own, inner) = files(folder)?;
    for path in inner.iter().chain(own.iter().filter(|path| named(path, "NOTICE"))) {
        let place = path.strip_prefix(folder)?.display();
        texts.add(&fs::read_to_string(path)?, &format!("{name} {version}, {place}"));
    }
    let expression = field("license").context("no licence in Cargo.toml")?.replace('/', " OR ");
    let mut used = Vec::new();
    for part in expression.split(" AND ") {
        let choices: Vec<&str> = part.trim_matches(['(', ')', ' ']).split(" OR ").map(str::trim).collect();
        let licence = [APACHE, "MIT"].into_iter().find(|licence| choices.contains(licence)).unwrap_or(choices[0]);
        used.push(licence.to_owned());
        if licence == APACHE {
            continue;
        }
        let word = licence.split('-').next().unwrap_or_default().to_uppercase();
        let mut of_it: Vec<_> = own.iter().filter(|path| named(path, &word)).collect();
        if of_it.is_empty() {
            of_it = own.iter().filter(|path| !named(path, "APACHE") && !named(path, "UNLICENSE")).collect();
        }
        let owner = format!("{name} {version} ({licence})");
        if of_it.is_empty() {
            let authors = manifest["package"].get("authors").and_then(toml::Value::as_array);
            let authors: Vec<&str> = authors.into_iter().flatten().filter_map(toml::Value::as_str).collect();
            let template = TEMPLATES.iter().find(|(of, _)| *of == licence).map(|(_, text)| text);
            let Some(template) = template else { bail!("no text of {licence}") };
            let nobody = || format!("the authors of {name}, {}", field("repository").unwrap_or_default());
            let holders = if authors.is_empty() { nobody() } else { authors.join(", ") };
            texts.add(&template.replace("{}", &holders), &owner);
        }
        for path in of_it {
            texts.add(&fs::read_to_string(path)?, &owner);
        }
    }
    Ok(used.join(" AND "))
}

fn named(path: &Path, word: &str) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().to_uppercase().contains(word))
}

/// Files about licences: of the package itself, and of what it brings along.
fn files(folder: &Path) -> anyhow::Result<(Vec<PathBuf>, Vec<PathBuf>)> {
    /// Folders that do not get into the program.
    const ASIDE: [&str; 5] = ["tests", "test", "examples", "benches", "LICENSES"];
    const WORDS: [&str; 4] = ["LICEN", "COPYING", "NOTICE", "UNLICENSE"];
    let (mut own, mut inner, mut open) = (Vec::new(), Vec::new(), vec![folder.to_owned()]);
    while let Some(place) = open.pop() {
        for entry in fs::read_dir(&place)? {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_dir() && !ASIDE.contains(&name.as_str()) {
                open.push(path);
            } else if path.is_file()
                && WORDS.iter().any(|word| name.to_uppercase().starts_with(word))
                && !is_code(&path)
            {
                if place == folder { &mut own } else { &mut inner }.push(path);
            }
        }
    }
    own.sort();
    inner.sort();
    Ok((own, inner))
}

fn is_code(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| ["rs", "html", "json", "toml", "hbs"].iter().any(|code| extension == *code))
}
