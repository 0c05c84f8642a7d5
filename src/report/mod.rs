//! Figures as SVG or PNG, and self-contained HTML pages.
//!
//! A [`Figure`] is data: panels with series, shaded regions and annotations. Both formats are drawn from it by the same code and in one
//! style, with colours that colour-blind readers can tell apart. [`Chart`] is the plainest figure.

mod canvas;
mod chart;
mod draw;
mod error;
mod figure;
mod frame;
mod legend;
mod marks;
mod packed;
mod page;
mod picture;
mod series;
mod slim;
mod ticks;

pub use chart::Chart;
pub use error::ReportError;
pub use figure::{Axis, Figure, Mark, Panel, Scale, Side};
pub use packed::TablePack;
pub use page::{Cell, Page, SortableTable, image, verdict_mark};
pub use series::{Series, Style, Tint};
