//! Charts of results, as SVG or PNG.

mod chart;

pub use chart::{Chart, ReportError, Series, Style, Tint};
