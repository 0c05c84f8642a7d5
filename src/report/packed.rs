//! Long tables as compact data in the page, built by its script when the reader opens them. Markup of a row takes six times the room.

use maud::{Markup, PreEscaped, html};
use std::collections::HashMap;

/// The words of all packed tables of a page, each once.
#[derive(Debug, Clone, Default)]
pub struct TablePack {
    words: Vec<String>,
    index: HashMap<String, usize>,
}

impl TablePack {
    /// A table, closed until the reader asks for it. Cells that are numbers stand as they are, words are looked up.
    pub fn table(&mut self, summary: &str, headings: &[&str], rows: &[Vec<String>]) -> Markup {
        let text = |text: &str| serde_json::Value::from(text).to_string();
        let mut packed = Vec::new();
        for row in rows {
            let cells: Vec<String> = row
                .iter()
                .map(|cell| if cell.parse::<f64>().is_ok() { text(cell) } else { self.word(cell).to_string() })
                .collect();
            packed.push(format!("[{}]", cells.join(",")));
        }
        let headings: Vec<String> = headings.iter().map(|heading| text(heading)).collect();
        let data = format!("{{\"h\":[{}],\"r\":[{}]}}", headings.join(","), packed.join(","));
        html! {
            details.packed {
                summary { (summary) }
                script type="application/json" { (PreEscaped(in_script(&data))) }
                noscript { p { "A script of this page shows these rows; without it, they are in the JSON file beside this page." } }
            }
        }
    }

    /// The words, once, after all tables.
    #[must_use]
    pub fn words(&self) -> Markup {
        let words: Vec<String> =
            self.words.iter().map(|word| serde_json::Value::from(word.as_str()).to_string()).collect();
        html! { script #words type="application/json" { (PreEscaped(in_script(&format!("[{}]", words.join(","))))) } }
    }

    fn word(&mut self, word: &str) -> usize {
        if let Some(&known) = self.index.get(word) {
            return known;
        }
        self.words.push(word.to_owned());
        self.index.insert(word.to_owned(), self.words.len() - 1);
        self.words.len() - 1
    }
}

/// JSON that cannot end the element it stands in.
fn in_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_written_once_and_cannot_end_the_script() {
        let mut pack = TablePack::default();
        let row = |n: &str| vec!["a </script> b".to_owned(), n.to_owned(), "–".to_owned()];
        let table = pack.table("two rows", &["what", "n", "none"], &[row("1.0"), row("2e-3")]).into_string();
        assert!(table.contains(r#"{"h":["what","n","none"],"r":[[0,"1.0",1],[0,"2e-3",1]]}"#), "{table}");
        let words = pack.words().into_string();
        assert!(words.contains(r#"["a \u003c/script> b","–"]"#), "{words}");
    }
}
