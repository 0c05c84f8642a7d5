//! From data to pixels: ranges, scales, clipping.

use super::canvas::Point;
use super::error::ReportError;
use super::figure::{Axis, Mark, Panel, Scale};

/// Share of the data's extent left free on either side.
const MARGIN: f64 = 0.04;

/// A rectangle in CSS pixels, y downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Area {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Area {
    pub fn width(self) -> f64 {
        self.right - self.left
    }

    pub fn height(self) -> f64 {
        self.bottom - self.top
    }

    pub fn contains(self, (x, y): Point) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }

    pub fn corners(self) -> [Point; 4] {
        [(self.left, self.top), (self.right, self.top), (self.right, self.bottom), (self.left, self.bottom)]
    }
}

/// The plotting area of a panel with its ranges, decimal logarithms on logarithmic axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    pub area: Area,
    pub x: (f64, f64),
    pub y: (f64, f64),
    scales: (Scale, Scale),
}

impl Frame {
    pub fn new(panel: &Panel, area: Area) -> Result<Self, ReportError> {
        let (mut x, mut y) = (range(&panel.x, panel, |p| p.0)?, range(&panel.y, panel, |p| p.1)?);
        if panel.equal_aspect {
            let unit = ((x.1 - x.0) / area.width()).max((y.1 - y.0) / area.height());
            x = widened(x, unit * area.width());
            y = widened(y, unit * area.height());
        }
        Ok(Self { area, x, y, scales: (panel.x.scale, panel.y.scale) })
    }

    /// Where a point lies; not finite if it has no place on a logarithmic axis.
    pub fn place(&self, (x, y): Point) -> Point {
        let share = |value: f64, (low, high): (f64, f64)| (value - low) / (high - low);
        (
            self.area.left + self.area.width() * share(scaled(self.scales.0, x), self.x),
            self.area.bottom - self.area.height() * share(scaled(self.scales.1, y), self.y),
        )
    }

    /// Pixel of a value already scaled, along each axis.
    pub fn across(&self, value: f64) -> f64 {
        self.area.left + self.area.width() * (value - self.x.0) / (self.x.1 - self.x.0)
    }

    pub fn up(&self, value: f64) -> f64 {
        self.area.bottom - self.area.height() * (value - self.y.0) / (self.y.1 - self.y.0)
    }

    /// The visible pieces of the line through points in data coordinates.
    pub fn line(&self, points: &[Point]) -> Vec<Vec<Point>> {
        let placed: Vec<Point> = points.iter().map(|p| self.place(*p)).collect();
        let mut pieces: Vec<Vec<Point>> = Vec::new();
        for pair in placed.windows(2) {
            let finite = pair.iter().all(|p| p.0.is_finite() && p.1.is_finite());
            let Some((from, to)) = finite.then(|| clipped(self.area, pair[0], pair[1])).flatten() else { continue };
            match pieces.last_mut() {
                Some(piece) if piece.last() == Some(&from) => piece.push(to),
                _ => pieces.push(vec![from, to]),
            }
        }
        pieces
    }

    /// A polygon in data coordinates, cut off at the frame.
    pub fn polygon(&self, outline: &[Point]) -> Vec<Point> {
        let mut points: Vec<Point> =
            outline.iter().map(|p| self.place(*p)).filter(|p| p.0.is_finite() && p.1.is_finite()).collect();
        let area = self.area;
        points = cut(&points, |p| p.0 - area.left);
        points = cut(&points, |p| area.right - p.0);
        points = cut(&points, |p| p.1 - area.top);
        cut(&points, |p| area.bottom - p.1)
    }
}

fn scaled(scale: Scale, value: f64) -> f64 {
    match scale {
        Scale::Linear => value,
        Scale::Log if value > 0.0 => value.log10(),
        Scale::Log => f64::NAN,
    }
}

fn widened((low, high): (f64, f64), extent: f64) -> (f64, f64) {
    let middle = 0.5 * (low + high);
    (middle - 0.5 * extent, middle + 0.5 * extent)
}

/// The chosen range, or that of the series with a margin.
fn range(axis: &Axis, panel: &Panel, coordinate: fn(&Point) -> f64) -> Result<(f64, f64), ReportError> {
    if let Some((low, high)) = axis.range {
        let (from, to) = (scaled(axis.scale, low), scaled(axis.scale, high));
        if from.is_finite() && to.is_finite() && from < to {
            return Ok((from, to));
        }
        let hint = if axis.scale == Scale::Log { "; both positive on a logarithmic axis" } else { "" };
        return Err(ReportError::BadRange { label: axis.label.clone(), low, high, hint });
    }
    let points = panel.marks.iter().flat_map(|mark| match mark {
        Mark::Series(series) => series.points.as_slice(),
        Mark::Region { outline, .. } => outline.as_slice(),
        _ => &[],
    });
    let values = points.map(|p| scaled(axis.scale, coordinate(p))).filter(|value| value.is_finite());
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if low > high {
        return Err(ReportError::Empty { title: panel.title.clone() });
    }
    let margin = (MARGIN * (high - low)).max(1e-9 * high.abs().max(1e-3));
    Ok((low - margin, high + margin))
}

/// The part of a segment inside the area (Liang and Barsky).
fn clipped(area: Area, from: Point, to: Point) -> Option<(Point, Point)> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    let sides =
        [(-dx, from.0 - area.left), (dx, area.right - from.0), (-dy, from.1 - area.top), (dy, area.bottom - from.1)];
    for (rate, room) in sides {
        if rate == 0.0 && room < 0.0 {
            return None;
        }
        if rate < 0.0 {
            enter = enter.max(room / rate);
        } else if rate > 0.0 {
            leave = leave.min(room / rate);
        }
    }
    let at = |t: f64| if t == 1.0 { to } else { (from.0 + t * dx, from.1 + t * dy) };
    (enter < leave || (enter == leave && (dx, dy) == (0.0, 0.0))).then(|| (at(enter), at(leave)))
}

/// The part of a polygon where `inside` is not negative (Sutherland and Hodgman); `inside` is linear.
fn cut(points: &[Point], inside: impl Fn(Point) -> f64) -> Vec<Point> {
    let mut kept = Vec::new();
    for (index, &to) in points.iter().enumerate() {
        let from = points[(index + points.len() - 1) % points.len()];
        let (a, b) = (inside(from), inside(to));
        if (a < 0.0) != (b < 0.0) {
            let t = a / (a - b);
            kept.push((from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1)));
        }
        if b >= 0.0 {
            kept.push(to);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Series, Style, Tint};

    const AREA: Area = Area { left: 0.0, top: 0.0, right: 100.0, bottom: 50.0 };

    fn panel(points: Vec<Point>) -> Panel {
        Panel::new("x", "y").series(Series::new("", points, Style::Line, Tint::Blue))
    }

    #[test]
    fn lines_end_at_the_frame_and_break_where_there_is_no_value() {
        let frame = Frame::new(&panel(vec![]).x_range(0.0, 1.0).y_range(0.0, 1.0), AREA).unwrap();
        assert_eq!(frame.line(&[(-1.0, 0.5), (2.0, 0.5)]), [[(0.0, 25.0), (100.0, 25.0)]]);
        assert!(frame.line(&[(-1.0, 2.0), (2.0, 2.0)]).is_empty());
        assert_eq!(frame.line(&[(0.1, 0.1), (0.2, 0.2), (0.3, f64::NAN), (0.4, 0.4), (0.5, 0.5)]).len(), 2);
        let square = [(-1.0, -1.0), (2.0, -1.0), (2.0, 0.5), (-1.0, 0.5)];
        let (low, high) =
            frame.polygon(&square).iter().fold((f64::MAX, f64::MIN), |(l, h), p| (l.min(p.1), h.max(p.1)));
        assert_eq!((low, high), (25.0, 50.0));
    }

    #[test]
    fn equal_aspect_widens_one_range() {
        let square = panel(vec![(0.0, 0.0), (1.0, 1.0)]).equal_aspect();
        let frame = Frame::new(&square, AREA).unwrap();
        assert!((frame.x.1 - frame.x.0 - 2.0 * (frame.y.1 - frame.y.0)).abs() < 1e-12);
    }

    #[test]
    fn a_logarithmic_axis_has_no_place_for_zero_and_refuses_it_as_an_end() {
        let points = vec![(0.0, 1.0), (1.0, 1.0), (100.0, 2.0)];
        let frame = Frame::new(&panel(points).log_x(), AREA).unwrap();
        assert!((frame.place((10.0, 1.5)).0 - 50.0).abs() < 1e-9 && !frame.place((0.0, 1.0)).0.is_finite());
        let refused = Frame::new(&panel(vec![]).log_x().x_range(0.0, 1.0).y_range(0.0, 1.0), AREA);
        assert!(matches!(refused, Err(ReportError::BadRange { .. })));
        assert!(matches!(Frame::new(&panel(vec![]), AREA), Err(ReportError::Empty { .. })));
    }
}
