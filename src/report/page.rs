//! Self-contained HTML pages: style, script and pictures are in the file, nothing is fetched.
//!
//! Colours follow the reader's light or dark setting, text is at least 15 px, and what is wide (tables, pictures on a phone) scrolls
//! within its own frame, never the page.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
/// Vector pictures of more bytes (clouds of thousands of dots) go into the page as PNG.
const LARGEST_VECTOR: usize = 150_000;

/// A page; its body is written with [`maud::html`].
#[derive(Debug, Clone)]
pub struct Page {
    pub title: String,
    /// Under the title.
    pub lead: String,
    pub body: Markup,
}

impl Page {
    /// The whole file.
    #[must_use]
    pub fn html(&self) -> String {
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    title { (self.title) }
                    // An icon of no content: without it browsers ask for one.
                    link rel="icon" href="data:,";
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    main {
                        h1 { (self.title) }
                        p.lead { (self.lead) }
                        (self.body)
                    }
                    script { (PreEscaped(SCRIPT)) }
                }
            }
        };
        page.into_string()
    }
}

/// A picture in the page itself, as SVG unless that is very large; `alt` says what it shows.
#[must_use]
pub fn image(svg: &str, png: &[u8], alt: &str, size: (u32, u32)) -> Markup {
    let (kind, data) = if svg.len() <= LARGEST_VECTOR { ("svg+xml", svg.as_bytes()) } else { ("png", png) };
    html! {
        div.picture {
            img src=(format!("data:image/{kind};base64,{}", STANDARD.encode(data))) alt=(alt) width=(size.0) height=(size.1);
        }
    }
}

/// A word with a sign and a colour: whether something passed, `None` where the question does not arise.
#[must_use]
pub fn verdict_mark(passed: Option<bool>) -> Markup {
    match passed {
        Some(true) => html! { span.pass { "✓ passed" } },
        Some(false) => html! { span.fail { "✗ failed" } },
        None => html! { span.none { "– not applicable" } },
    }
}

/// A cell of a table.
#[derive(Debug, Clone)]
pub struct Cell {
    pub content: Markup,
    /// By which its column is sorted; the text without.
    pub key: Option<f64>,
}

impl Cell {
    #[must_use]
    pub fn text(text: &str) -> Self {
        Self { content: html! { (text) }, key: None }
    }

    /// A number with the text that shows it.
    #[must_use]
    pub fn number(value: f64, text: &str) -> Self {
        Self { content: html! { (text) }, key: Some(value) }
    }

    #[must_use]
    pub fn markup(content: Markup) -> Self {
        Self { content, key: None }
    }
}

/// A table whose rows the reader can sort by any column.
#[derive(Debug, Clone, Default)]
pub struct SortableTable {
    pub headings: Vec<String>,
    pub rows: Vec<Vec<Cell>>,
}

impl SortableTable {
    #[must_use]
    pub fn markup(&self) -> Markup {
        html! {
            div.scroll {
                table.sortable {
                    thead { tr { @for heading in &self.headings { th { button type="button" { (heading) } } } } }
                    tbody {
                        @for row in &self.rows {
                            tr { @for cell in row { td data-key=[cell.key.map(|key| key.to_string())] { (cell.content) } } }
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_whole_in_itself_and_escapes_its_texts() {
        let body = image("<svg xmlns=\"http://www.w3.org/2000/svg\"/>", &[], "a < b", (10, 10));
        let text = Page { title: "a & b".into(), lead: String::new(), body }.html();
        assert!(text.starts_with("<!DOCTYPE html>") && text.contains("a &amp; b") && text.contains("a &lt; b"));
        assert!(text.contains("data:image/svg+xml;base64,"));
        // The name space of SVG is in the encoded picture: no address is left that a browser would follow.
        assert!(!text.contains("http:") && !text.contains("https:") && !text.contains("url("));
    }

    #[test]
    fn a_large_vector_picture_is_replaced_by_its_bitmap() {
        let text = image(&"x".repeat(LARGEST_VECTOR + 1), b"png", "", (1, 1)).into_string();
        assert!(text.contains("data:image/png;base64,cG5n") && text.len() < 200);
    }

    #[test]
    fn sortable_cells_carry_their_numbers() {
        let rows = vec![vec![Cell::text("a"), Cell::number(1e-3, "1.0·10⁻³")]];
        let text = SortableTable { headings: vec!["what".into(), "error".into()], rows }.markup().into_string();
        assert!(text.contains("data-key=\"0.001\"") && text.contains("1.0·10⁻³"));
    }
}
