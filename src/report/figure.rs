//! What a figure shows: panels with axes, and on them series, shaded regions and annotations, all in data coordinates.

use super::series::{Series, Tint};

/// One or several panels in a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Above all panels; none if empty.
    pub title: String,
    pub panels: Vec<Panel>,
    /// Panels beside each other.
    pub columns: usize,
    /// Width and height in CSS pixels; a PNG has twice as many.
    pub size: (u32, u32),
    /// One legend for all panels, beneath them, instead of one in each.
    pub shared_legend: bool,
}

impl Figure {
    /// One panel.
    #[must_use]
    pub fn single(panel: Panel) -> Self {
        Self { title: String::new(), panels: vec![panel], columns: 1, size: (900, 600), shared_legend: false }
    }

    /// Panels in rows of `columns`, with one legend beneath.
    #[must_use]
    pub fn grid(columns: usize, size: (u32, u32), panels: Vec<Panel>) -> Self {
        Self { title: String::new(), panels, columns: columns.max(1), size, shared_legend: true }
    }

    #[must_use]
    pub fn titled(self, title: &str) -> Self {
        Self { title: title.to_owned(), ..self }
    }

    #[must_use]
    pub fn sized(self, width: u32, height: u32) -> Self {
        Self { size: (width, height), ..self }
    }

    /// A legend in each panel.
    #[must_use]
    pub fn own_legends(self) -> Self {
        Self { shared_legend: false, ..self }
    }
}

/// One pair of axes and what is drawn on them.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    /// Both axes have the same scale: one range is widened.
    pub equal_aspect: bool,
    /// Without a frame and tick labels, for drawings.
    pub bare: bool,
    /// Drawn in this order.
    pub marks: Vec<Mark>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    pub label: String,
    pub scale: Scale,
    /// From the data with a margin if not chosen.
    pub range: Option<(f64, f64)>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    Linear,
    /// Points that are not positive are left out.
    Log,
}

/// Where a text lies, seen from its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    Above,
    Below,
    Left,
    Right,
    Centre,
}

/// Something on a panel.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
    Series(Series),
    /// Shaded between two values of x over the whole height; open ends are the panel's.
    BandX {
        label: String,
        from: Option<f64>,
        to: Option<f64>,
        tint: Tint,
    },
    /// Shaded between two values of y over the whole width.
    BandY {
        label: String,
        from: Option<f64>,
        to: Option<f64>,
        tint: Tint,
    },
    /// Shaded polygon.
    Region {
        label: String,
        outline: Vec<(f64, f64)>,
        tint: Tint,
    },
    Text {
        at: (f64, f64),
        text: String,
        side: Side,
        tint: Tint,
    },
    Arrow {
        from: (f64, f64),
        to: (f64, f64),
        tint: Tint,
    },
    /// Triangle that rises with the given order over `decades` of x, for two logarithmic axes.
    Slope {
        at: (f64, f64),
        order: f64,
        decades: f64,
    },
}

impl Mark {
    pub(super) fn label(&self) -> &str {
        match self {
            Self::Series(series) => &series.label,
            Self::BandX { label, .. } | Self::BandY { label, .. } | Self::Region { label, .. } => label,
            Self::Text { .. } | Self::Arrow { .. } | Self::Slope { .. } => "",
        }
    }
}

impl Axis {
    fn new(label: &str) -> Self {
        Self { label: label.to_owned(), scale: Scale::Linear, range: None }
    }
}

impl Panel {
    /// Linear axes with ranges from the data.
    #[must_use]
    pub fn new(x_label: &str, y_label: &str) -> Self {
        Self {
            title: String::new(),
            x: Axis::new(x_label),
            y: Axis::new(y_label),
            equal_aspect: false,
            bare: false,
            marks: Vec::new(),
        }
    }

    #[must_use]
    pub fn titled(self, title: &str) -> Self {
        Self { title: title.to_owned(), ..self }
    }

    #[must_use]
    pub fn log_x(mut self) -> Self {
        self.x.scale = Scale::Log;
        self
    }

    #[must_use]
    pub fn log_y(mut self) -> Self {
        self.y.scale = Scale::Log;
        self
    }

    #[must_use]
    pub fn x_range(mut self, low: f64, high: f64) -> Self {
        self.x.range = Some((low, high));
        self
    }

    #[must_use]
    pub fn y_range(mut self, low: f64, high: f64) -> Self {
        self.y.range = Some((low, high));
        self
    }

    #[must_use]
    pub fn equal_aspect(self) -> Self {
        Self { equal_aspect: true, ..self }
    }

    #[must_use]
    pub fn bare(self) -> Self {
        Self { bare: true, ..self }
    }

    #[must_use]
    pub fn with(mut self, mark: Mark) -> Self {
        self.marks.push(mark);
        self
    }

    #[must_use]
    pub fn series(self, series: Series) -> Self {
        self.with(Mark::Series(series))
    }

    #[must_use]
    pub fn text(self, at: (f64, f64), text: &str, side: Side) -> Self {
        self.with(Mark::Text { at, text: text.to_owned(), side, tint: Tint::Black })
    }

    #[must_use]
    pub fn arrow(self, from: (f64, f64), to: (f64, f64)) -> Self {
        self.with(Mark::Arrow { from, to, tint: Tint::Grey })
    }
}
