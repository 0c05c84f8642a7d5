//! What decides the content of an output directory, and how two of them differ.

use super::sha256_hex;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeSet;

/// Differences shown, and characters shown of a value: an error is read on a terminal.
const MOST_DIFFERENCES: usize = 4;
const MOST_CHARACTERS: usize = 60;

/// Everything that decides the content of an output directory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Origin {
    /// Version of this program: other versions may compute or draw otherwise.
    pub stickslip: String,
    pub command: String,
    pub parameters: Value,
}

impl Origin {
    /// This version of the program, running `command` with `parameters`.
    #[must_use]
    pub fn new(command: &str, parameters: Value) -> Self {
        Self { stickslip: env!("CARGO_PKG_VERSION").to_owned(), command: command.to_owned(), parameters }
    }

    /// SHA-256 of version, command and parameters as JSON with sorted keys and without spaces.
    #[must_use]
    pub fn sha256(&self) -> String {
        let whole = serde_json::json!([self.stickslip, self.command, self.parameters]);
        sha256_hex(sorted(&whole).to_string().as_bytes())
    }

    /// Which fields differ, for the reader of an error.
    pub(super) fn differences(&self, old: &Self) -> String {
        let (old, new) = (serde_json::to_value(old), serde_json::to_value(self));
        let mut found = Vec::new();
        collect_differences("", &old.unwrap_or_default(), &new.unwrap_or_default(), &mut found);
        let more = found.len().saturating_sub(MOST_DIFFERENCES);
        found.truncate(MOST_DIFFERENCES);
        let shown = found.join(", ");
        if more == 0 { shown } else { format!("{shown} and {more} more") }
    }
}

/// The same value with the keys of all objects in order, whatever order the JSON library keeps.
fn sorted(value: &Value) -> Value {
    match value {
        Value::Array(items) => items.iter().map(sorted).collect(),
        Value::Object(map) => {
            let mut entries: Vec<_> = map.iter().collect();
            entries.sort_by_key(|(key, _)| *key);
            entries.into_iter().map(|(key, value)| (key.clone(), sorted(value))).collect()
        }
        plain => plain.clone(),
    }
}

/// Lines such as `parameters.xi1: -0.02 there, -0.03 now`.
fn collect_differences(at: &str, old: &Value, new: &Value, found: &mut Vec<String>) {
    match (old, new) {
        (Value::Object(old), Value::Object(new)) => {
            let keys: BTreeSet<_> = old.keys().chain(new.keys()).collect();
            for key in keys {
                let at = if at.is_empty() { key.clone() } else { format!("{at}.{key}") };
                let of = |map: &serde_json::Map<String, Value>| map.get(key).cloned().unwrap_or_default();
                collect_differences(&at, &of(old), &of(new), found);
            }
        }
        // Where something was put in or left out, it is not known which belongs to which.
        (Value::Array(old), Value::Array(new)) if old.len() == new.len() => {
            for (number, (old, new)) in old.iter().zip(new).enumerate() {
                collect_differences(&format!("{at}[{number}]"), old, new, found);
            }
        }
        _ if sorted(old) != sorted(new) => found.push(format!("{at}: {} there, {} now", shown(old), shown(new))),
        _ => {}
    }
}

/// A value, its beginning where it is long.
fn shown(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(MOST_CHARACTERS) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text,
    }
}
