//! What Cargo.lock says is in the program.

use std::collections::{BTreeMap, BTreeSet};

/// Name and version.
pub type Package = (String, String);

/// Every package that Cargo.lock reaches from the dependencies of the program, on any platform. Those that only build
/// it (Cargo.lock does not tell them apart) are among them; those that only test it are not.
///
/// # Errors
/// What is missing in the files.
pub fn packages(manifest: &toml::Table, lock: &toml::Table) -> Result<BTreeSet<Package>, String> {
    let mut known: BTreeMap<&str, Vec<&toml::Value>> = BTreeMap::new();
    for package in list(lock, "package") {
        known.entry(text(package, "name")?).or_default().push(package);
    }
    let find = |wanted: &str| {
        let mut words = wanted.split(' ');
        let (name, version) = (words.next().unwrap_or_default(), words.next());
        let mut all = known.get(name).into_iter().flatten();
        let found = all.find(|package| version.is_none_or(|version| text(package, "version") == Ok(version)));
        found.copied().ok_or_else(|| format!("Cargo.lock has no package {wanted:?}"))
    };
    let own = text(&manifest["package"], "name")?;
    let direct = direct(manifest);
    let named = |wanted: &&str| direct.contains(wanted.split(' ').next().unwrap_or_default());
    let mut open: Vec<&str> = dependencies(find(own)?).filter(named).collect();
    let mut reached = BTreeSet::new();
    while let Some(wanted) = open.pop() {
        let package = find(wanted)?;
        if reached.insert((text(package, "name")?.to_owned(), text(package, "version")?.to_owned())) {
            open.extend(dependencies(package));
        }
    }
    Ok(reached)
}

/// Names in the tables of dependencies, those of single platforms included.
fn direct(manifest: &toml::Table) -> BTreeSet<&str> {
    let platforms = manifest.get("target").and_then(toml::Value::as_table).into_iter().flat_map(toml::Table::values);
    let everywhere = manifest.get("dependencies");
    let tables = everywhere.into_iter().chain(platforms.filter_map(|platform| platform.get("dependencies")));
    tables.filter_map(toml::Value::as_table).flat_map(|table| table.keys().map(String::as_str)).collect()
}

fn dependencies(package: &toml::Value) -> impl Iterator<Item = &str> {
    let list = package.get("dependencies").and_then(toml::Value::as_array);
    list.into_iter().flatten().filter_map(toml::Value::as_str)
}

fn list<'a>(table: &'a toml::Table, name: &str) -> impl Iterator<Item = &'a toml::Value> {
    table.get(name).and_then(toml::Value::as_array).into_iter().flatten()
}

fn text<'a>(package: &'a toml::Value, field: &str) -> Result<&'a str, String> {
    package.get(field).and_then(toml::Value::as_str).ok_or_else(|| format!("a package has no {field}"))
}
