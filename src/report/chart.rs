//! A chart with lines and dots on two axes, drawn with plotters and readable without the manual: title, axes with names, a legend.
//!
//! Colours are from the Okabe-Ito palette, which colour-blind readers can tell apart. Ranges follow from the data.

use crate::store::{StoreError, write_atomically};
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Picture size in pixels.
const SIZE: (u32, u32) = (1200, 800);
const FONT: &str = "sans-serif";

#[derive(Debug, Error)]
pub enum ReportError {
    #[error("{path} is not a picture this program can write: name a file ending in .svg or .png")]
    UnknownFormat { path: PathBuf },
    #[error("the chart {title:?} has no finite points to draw")]
    Empty { title: String },
    #[error("the chart {title:?} could not be drawn: {reason}")]
    Drawing { title: String, reason: String },
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    Line,
    Dots,
    /// Few points that matter.
    Markers,
}

/// Colour of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tint {
    Blue,
    Orange,
    Green,
    Vermillion,
    Purple,
    Grey,
}

impl Tint {
    fn colour(self) -> RGBColor {
        match self {
            Self::Blue => RGBColor(0x00, 0x72, 0xb2),
            Self::Orange => RGBColor(0xe6, 0x9f, 0x00),
            Self::Green => RGBColor(0x00, 0x9e, 0x73),
            Self::Vermillion => RGBColor(0xd5, 0x5e, 0x00),
            Self::Purple => RGBColor(0xcc, 0x79, 0xa7),
            Self::Grey => RGBColor(0x70, 0x70, 0x70),
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
    /// [`ReportError::UnknownFormat`], [`ReportError::Empty`], [`ReportError::Drawing`], and [`ReportError::Store`] if the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), ReportError> {
        let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        let bytes = match extension.as_deref() {
            Some("svg") => self.svg()?.into_bytes(),
            Some("png") => self.png()?,
            _ => return Err(ReportError::UnknownFormat { path: path.to_owned() }),
        };
        Ok(write_atomically(path, |writer| writer.write_all(&bytes))?)
    }

    /// The picture as SVG text.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub fn svg(&self) -> Result<String, ReportError> {
        let mut text = String::new();
        self.draw(&SVGBackend::with_string(&mut text, SIZE).into_drawing_area())?;
        Ok(text)
    }

    fn png(&self) -> Result<Vec<u8>, ReportError> {
        let mut pixels = vec![0; (SIZE.0 * SIZE.1 * 3) as usize];
        self.draw(&BitMapBackend::with_buffer(&mut pixels, SIZE).into_drawing_area())?;
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, SIZE.0, SIZE.1);
        encoder.set_color(png::ColorType::Rgb);
        encoder
            .write_header()
            .and_then(|mut writer| writer.write_image_data(&pixels))
            .map_err(|error| self.failed(error))?;
        Ok(file)
    }

    fn failed(&self, reason: impl std::fmt::Display) -> ReportError {
        ReportError::Drawing { title: self.title.clone(), reason: reason.to_string() }
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, plotters::coord::Shift>) -> Result<(), ReportError> {
        for (style, file) in [(FontStyle::Normal, dejavu::sans::regular()), (FontStyle::Bold, dejavu::sans::bold())] {
            register_font(FONT, style, file).map_err(|_| self.failed("the built-in font is damaged"))?;
        }
        let (x, y) = (self.range(|p| p.0)?, self.range(|p| p.1)?);
        self.draw_on(area, x, y).map_err(|error| self.failed(error))
    }

    fn draw_on<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, plotters::coord::Shift>,
        x: std::ops::Range<f64>,
        y: std::ops::Range<f64>,
    ) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
        area.fill(&WHITE)?;
        let mut context = ChartBuilder::on(area)
            .caption(&self.title, (FONT, 26))
            .margin(20)
            .x_label_area_size(56)
            .y_label_area_size(84)
            .build_cartesian_2d(x, y)?;
        context
            .configure_mesh()
            .x_desc(&self.x_label)
            .y_desc(&self.y_label)
            .axis_desc_style((FONT, 20))
            .label_style((FONT, 16))
            .light_line_style(WHITE)
            .draw()?;
        for series in &self.series {
            let colour = series.tint.colour();
            let finite = |p: &&(f64, f64)| p.0.is_finite() && p.1.is_finite();
            let dots = |radius: i32| {
                series.points.iter().filter(finite).map(move |p| Circle::new(*p, radius, colour.filled()))
            };
            match series.style {
                Style::Dots => {
                    context.draw_series(dots(2))?;
                }
                Style::Markers => {
                    context.draw_series(dots(6))?;
                }
                Style::Line => {
                    for piece in series.points.split(|p| !(p.0.is_finite() && p.1.is_finite())) {
                        context.draw_series(LineSeries::new(piece.iter().copied(), colour.stroke_width(2)))?;
                    }
                }
            }
            let style = series.style;
            if !series.label.is_empty() {
                // An empty series carries the legend entry whatever the style.
                context.draw_series(std::iter::empty::<Circle<(f64, f64), i32>>())?.label(&series.label).legend(
                    move |(x, y)| {
                        let thick = if style == Style::Line { 1 } else { 5 };
                        let ends = if style == Style::Line { (x, x + 18) } else { (x + 4, x + 14) };
                        Rectangle::new([(ends.0, y - thick), (ends.1, y + thick)], colour.filled())
                    },
                );
            }
        }
        context
            .configure_series_labels()
            .background_style(WHITE.mix(0.85))
            .border_style(RGBColor(0xb0, 0xb0, 0xb0))
            .label_font((FONT, 17))
            .position(SeriesLabelPosition::UpperRight)
            .draw()?;
        area.present()
    }

    /// Range of one coordinate over all series with a margin.
    fn range(&self, coordinate: fn(&(f64, f64)) -> f64) -> Result<std::ops::Range<f64>, ReportError> {
        let values = self.series.iter().flat_map(|series| &series.points).map(coordinate).filter(|v| v.is_finite());
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if low > high {
            return Err(ReportError::Empty { title: self.title.clone() });
        }
        let margin = (0.04 * (high - low)).max(1e-9 * high.abs().max(1e-3));
        Ok(low - margin..high + margin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(points: Vec<(f64, f64)>) -> Chart {
        let series = Series { label: "stable".to_owned(), points, style: Style::Line, tint: Tint::Blue };
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
        let lines = |points| chart(points).svg().unwrap().matches("<polyline").count();
        let whole = lines(vec![(0.0, 1.0), (1.0, 2.0), (2.0, 1.0), (3.0, 2.0)]);
        assert_eq!(lines(vec![(0.0, 1.0), (1.0, 2.0), (1.5, f64::NAN), (2.0, 1.0), (3.0, 2.0)]), whole + 1);
    }

    #[test]
    fn a_png_has_the_colour_of_its_line_and_an_empty_chart_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("c.png");
        chart(vec![(0.0, 0.0), (1.0, 1.0)]).write(&path).unwrap();
        let picture = image::open(&path).unwrap().into_rgb8();
        assert_eq!(picture.dimensions(), SIZE);
        // A line across the picture, two pixels wide: at least as many pixels as it is wide.
        assert!(picture.pixels().filter(|p| p.0 == [0x00, 0x72, 0xb2]).count() > 1000);
        assert!(matches!(chart(vec![]).write(&path), Err(ReportError::Empty { .. })));
        assert!(matches!(chart(vec![(0.0, 0.0)]).write(Path::new("x.gif")), Err(ReportError::UnknownFormat { .. })));
    }
}
