//! Who may import whom: the table of the architecture, read off the `use` lines.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Module and the modules of this crate it may import.
const ALLOWED: [(&str, &[&str]); 18] = [
    ("render", &[]),
    ("store", &[]),
    ("model", &[]),
    ("dynamics", &["model"]),
    ("exact", &["model", "dynamics"]),
    ("averaging", &["model", "dynamics"]),
    ("engine", &["model", "dynamics"]),
    ("orbit", &["model", "dynamics"]),
    ("chaos", &["model", "dynamics"]),
    ("scene", &["model"]),
    ("disk", &["dynamics", "exact", "model", "orbit", "store"]),
    ("compare", &["model", "dynamics"]),
    ("stage", &["scene", "model", "dynamics", "render"]),
    ("film", &["render", "store"]),
    ("report", &["store"]),
    ("conformance", &["chaos", "compare", "dynamics", "engine", "exact", "model", "orbit", "report", "scene", "store"]),
    (
        "paper",
        &["averaging", "chaos", "compare", "dynamics", "engine", "exact", "model", "orbit", "report", "scene", "store"],
    ),
    (
        "cli",
        &[
            "averaging",
            "chaos",
            "compare",
            "conformance",
            "disk",
            "dynamics",
            "engine",
            "exact",
            "film",
            "model",
            "orbit",
            "paper",
            "render",
            "report",
            "scene",
            "stage",
            "store",
        ],
    ),
];

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if entry.is_dir() {
            files.extend(rust_files(&entry));
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            files.push(entry);
        }
    }
    files
}

/// Top-level modules named as `crate::NAME` outside unit tests and doc comments.
fn imports(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    code.lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .flat_map(|line| line.split("crate::").skip(1))
        .map(|rest| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>())
        .collect()
}

/// Every import that the table does not allow, as `file imports module`.
fn offences(module: &str, file: &str, text: &str) -> Vec<String> {
    let table: BTreeMap<_, _> = ALLOWED.into_iter().collect();
    let allowed = table
        .get(module)
        .unwrap_or_else(|| panic!("module {module} is not in the table: add it with what it may import"));
    imports(text)
        .into_iter()
        .filter(|name| name != module && table.contains_key(name.as_str()) && !allowed.contains(&name.as_str()))
        .map(|name| format!("{file} imports {name}"))
        .collect()
}

#[test]
fn modules_import_only_what_the_architecture_allows() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    let mut modules = 0;
    for folder in fs::read_dir(&source).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir()) {
        let module = folder.file_name().unwrap().to_str().unwrap().to_owned();
        modules += 1;
        for file in rust_files(&folder) {
            found.extend(offences(&module, &file.display().to_string(), &fs::read_to_string(&file).unwrap()));
        }
    }
    assert_eq!(modules, ALLOWED.len(), "the table lists every module");
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn an_engine_that_knew_the_exact_solution_would_be_found() {
    let text = "use crate::exact::TwoMassFlow;\n";
    assert_eq!(offences("engine", "flow.rs", text), ["flow.rs imports exact"]);
    assert!(offences("engine", "flow.rs", "use crate::model::Works;\n").is_empty());
}
