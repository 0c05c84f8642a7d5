//! Points that belong together, and how they are drawn.
//!
//! Colours are from the palette of M. Okabe and K. Ito (2008), which colour-blind readers can tell apart.

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    Line,
    /// A line for what is there many times, such as a phase portrait.
    Thin,
    Dashed,
    Dotted,
    /// Smallest dots: thousands of points on a section.
    Cloud,
    Dots,
    /// Few points that matter.
    Markers,
    /// Few points, open.
    Rings,
    /// Few points, to be told from markers.
    Crosses,
}

impl Style {
    /// Whether successive points are joined.
    pub(super) fn joins(self) -> bool {
        matches!(self, Self::Line | Self::Thin | Self::Dashed | Self::Dotted)
    }
}

/// Colour of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tint {
    Black,
    Blue,
    Sky,
    Orange,
    Green,
    Vermillion,
    /// The palette's reddish purple, a pink.
    Purple,
    Grey,
    LightGrey,
}

impl Tint {
    pub(super) fn rgb(self) -> (u8, u8, u8) {
        match self {
            Self::Black => (0x10, 0x10, 0x10),
            Self::Blue => (0x00, 0x72, 0xb2),
            Self::Sky => (0x56, 0xb4, 0xe9),
            Self::Orange => (0xe6, 0x9f, 0x00),
            Self::Green => (0x00, 0x9e, 0x73),
            Self::Vermillion => (0xd5, 0x5e, 0x00),
            Self::Purple => (0xcc, 0x79, 0xa7),
            Self::Grey => (0x70, 0x70, 0x70),
            Self::LightGrey => (0xb4, 0xb4, 0xb4),
        }
    }
}

/// Points that belong together. A line breaks at points that are not finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// In the legend; none if empty.
    pub label: String,
    pub points: Vec<(f64, f64)>,
    pub style: Style,
    pub tint: Tint,
}

impl Series {
    #[must_use]
    pub fn new(label: &str, points: Vec<(f64, f64)>, style: Style, tint: Tint) -> Self {
        Self { label: label.to_owned(), points, style, tint }
    }
}
