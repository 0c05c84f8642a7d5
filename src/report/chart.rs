//! The plainest figure: series on two linear axes whose ranges follow from the data.

use super::error::ReportError;
use super::figure::{Figure, Panel};
use super::series::Series;
use std::path::Path;

/// Picture size in CSS pixels.
const SIZE: (u32, u32) = (1000, 660);

/// What a picture shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    pub title: String,
    pub x_label: String,
    pub y_label: String,
    pub series: Vec<Series>,
}

impl Chart {
    /// Writes the picture atomically, as SVG or PNG by the extension of `path`.
    ///
    /// # Errors
    /// As [`Figure::write`].
    pub fn write(&self, path: &Path) -> Result<(), ReportError> {
        self.figure().write(path)
    }

    /// The picture as SVG text.
    ///
    /// # Errors
    /// As [`Figure::svg`].
    pub fn svg(&self) -> Result<String, ReportError> {
        self.figure().svg()
    }

    fn figure(&self) -> Figure {
        let panel = self.series.iter().cloned().fold(Panel::new(&self.x_label, &self.y_label), Panel::series);
        Figure { size: SIZE, ..Figure::single(panel) }.titled(&self.title)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Style, Tint};

    fn chart(points: Vec<(f64, f64)>) -> Chart {
        let series = Series::new("stable", points, Style::Line, Tint::Blue);
        Chart { title: "Branch".into(), x_label: "ξ₁".into(), y_label: "a₁".into(), series: vec![series] }
    }

    #[test]
    fn a_chart_names_its_title_axes_and_series() {
        let svg = chart(vec![(0.0, 1.0), (1.0, 2.0)]).svg().unwrap();
        for word in ["Branch", "ξ₁", "a₁", "stable"] {
            assert!(svg.contains(word), "{word}");
        }
        assert_eq!(svg, chart(vec![(0.0, 1.0), (1.0, 2.0)]).svg().unwrap(), "same data, same bytes");
    }

    #[test]
    fn a_line_breaks_where_there_is_no_value() {
        // Each piece of a path begins with M and a number.
        let starts = |svg: &str| svg.split('M').filter(|rest| rest.starts_with(|c: char| c.is_ascii_digit())).count();
        let lines = |points| starts(&chart(points).svg().unwrap());
        let whole = lines(vec![(0.0, 1.0), (1.0, 2.0), (2.0, 1.0), (3.0, 2.0)]);
        assert_eq!(lines(vec![(0.0, 1.0), (1.0, 2.0), (1.5, f64::NAN), (2.0, 1.0), (3.0, 2.0)]), whole + 1);
    }

    #[test]
    fn a_png_has_the_colour_of_its_line_and_an_empty_chart_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("c.png");
        chart(vec![(0.0, 0.0), (1.0, 1.0)]).write(&path).unwrap();
        let picture = image::open(&path).unwrap().into_rgb8();
        assert_eq!(picture.dimensions(), (2 * SIZE.0, 2 * SIZE.1));
        // A line across most of the picture, two CSS pixels wide: at least as many pixels as it is wide.
        assert!(picture.pixels().filter(|p| p.0 == [0x00, 0x72, 0xb2]).count() > 1000);
        assert!(matches!(chart(vec![]).write(&path), Err(ReportError::Empty { .. })));
        assert!(matches!(chart(vec![(0.0, 0.0)]).write(Path::new("x.gif")), Err(ReportError::UnknownFormat { .. })));
    }
}
