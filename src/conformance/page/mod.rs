//! The report for readers: the same tables and texts as Markdown and as a page with charts.

mod advice;
mod answer;
mod charts;
mod diagram;
mod html;
mod markdown;
mod slopes;
mod tables;

pub use html::html;
pub use markdown::markdown;
