//! Drawing what lies on a panel.

use super::canvas::{Canvas, Failure, Lettering, Pen, Point};
use super::figure::{Mark, Side};
use super::frame::{Area, Frame};
use super::legend::LETTERS;
use super::series::{Series, Style, Tint};
use plotters::prelude::DrawingBackend;
use plotters::style::text_anchor::HPos;

/// Opacity of shaded regions.
pub(super) const SHADE: f64 = 0.22;
/// Distance of a text from its point.
const APART: f64 = 9.0;
const ARROW_HEAD: f64 = 11.0;

pub(super) fn pen_of(style: Style, tint: Tint) -> Pen {
    let (width, dash) = match style {
        Style::Thin => (0.7, None),
        Style::Dashed => (2.2, Some((9.0, 5.0))),
        Style::Dotted => (2.4, Some((2.4, 4.0))),
        _ => (2.2, None),
    };
    Pen { rgb: tint.rgb(), width, dash }
}

pub(super) fn draw<B: DrawingBackend>(canvas: &mut Canvas<'_, B>, frame: &Frame, mark: &Mark) -> Result<(), Failure> {
    match mark {
        Mark::Series(series) => draw_series(canvas, frame, series),
        Mark::BandX { from, to, tint, .. } => {
            let at = |x: Option<f64>, open: f64| x.map_or(open, |x| frame.place((x, 1.0)).0);
            let (left, right) = (at(*from, frame.area.left), at(*to, frame.area.right));
            band(canvas, frame.area, Area { left: left.min(right), right: left.max(right), ..frame.area }, *tint)
        }
        Mark::BandY { from, to, tint, .. } => {
            let at = |y: Option<f64>, open: f64| y.map_or(open, |y| frame.place((1.0, y)).1);
            let (a, b) = (at(*from, frame.area.bottom), at(*to, frame.area.top));
            band(canvas, frame.area, Area { top: a.min(b), bottom: a.max(b), ..frame.area }, *tint)
        }
        Mark::Region { outline, tint, .. } => {
            let visible = frame.polygon(outline);
            if visible.len() < 3 { Ok(()) } else { canvas.fill(&visible, tint.rgb(), SHADE) }
        }
        Mark::Text { at, text, side, tint } => draw_text(canvas, frame.place(*at), text, *side, *tint),
        Mark::Arrow { from, to, tint } => draw_arrow(canvas, frame.place(*from), frame.place(*to), *tint),
        Mark::Slope { at, order, decades } => draw_slope(canvas, frame, *at, *order, *decades),
    }
}

fn band<B: DrawingBackend>(canvas: &mut Canvas<'_, B>, limits: Area, band: Area, tint: Tint) -> Result<(), Failure> {
    let visible = Area {
        left: band.left.max(limits.left),
        top: band.top.max(limits.top),
        right: band.right.min(limits.right),
        bottom: band.bottom.min(limits.bottom),
    };
    // Also false where an end has no place on the axis.
    if visible.width() > 0.0 && visible.height() > 0.0 {
        return canvas.fill(&visible.corners(), tint.rgb(), SHADE);
    }
    Ok(())
}

fn draw_series<B: DrawingBackend>(canvas: &mut Canvas<'_, B>, frame: &Frame, series: &Series) -> Result<(), Failure> {
    if series.style.joins() {
        let pen = pen_of(series.style, series.tint);
        return frame.line(&series.points).iter().try_for_each(|piece| canvas.line(piece, pen));
    }
    let places = series.points.iter().map(|p| frame.place(*p)).filter(|p| frame.area.contains(*p));
    places.into_iter().try_for_each(|place| draw_marker(canvas, series.style, series.tint, place))
}

pub(super) fn draw_marker<B: DrawingBackend>(
    canvas: &mut Canvas<'_, B>,
    style: Style,
    tint: Tint,
    (x, y): Point,
) -> Result<(), Failure> {
    let rgb = tint.rgb();
    match style {
        Style::Cloud => canvas.dot((x, y), 0.8, rgb),
        Style::Dots => canvas.dot((x, y), 1.9, rgb),
        Style::Rings => {
            // Circles of one pixel are all that both back ends can draw, so a ring is a polygon.
            let around: Vec<Point> = (0..=24)
                .map(|n| (f64::from(n) / 24.0 * std::f64::consts::TAU).sin_cos())
                .map(|(s, c)| (x + 5.0 * c, y + 5.0 * s))
                .collect();
            canvas.line(&around, Pen::solid(rgb, 1.8))
        }
        Style::Crosses => {
            let arm = 4.5;
            canvas.line(&[(x - arm, y - arm), (x + arm, y + arm)], Pen::solid(rgb, 1.8))?;
            canvas.line(&[(x - arm, y + arm), (x + arm, y - arm)], Pen::solid(rgb, 1.8))
        }
        Style::Markers | Style::Line | Style::Thin | Style::Dashed | Style::Dotted => canvas.dot((x, y), 5.0, rgb),
    }
}

fn draw_text<B: DrawingBackend>(
    canvas: &mut Canvas<'_, B>,
    (x, y): Point,
    text: &str,
    side: Side,
    tint: Tint,
) -> Result<(), Failure> {
    if !(x.is_finite() && y.is_finite()) {
        return Ok(());
    }
    let (dx, dy, across) = match side {
        Side::Above => (0.0, -APART - 5.0, HPos::Center),
        Side::Below => (0.0, APART + 5.0, HPos::Center),
        Side::Left => (-APART, 0.0, HPos::Right),
        Side::Right => (APART, 0.0, HPos::Left),
        Side::Centre => (0.0, 0.0, HPos::Center),
    };
    canvas.text((x + dx, y + dy), text, Lettering { across, rgb: tint.rgb(), ..Lettering::centred(LETTERS) })
}

fn draw_arrow<B: DrawingBackend>(
    canvas: &mut Canvas<'_, B>,
    from: Point,
    to: Point,
    tint: Tint,
) -> Result<(), Failure> {
    let length = (to.0 - from.0).hypot(to.1 - from.1);
    // Also for ends without a place.
    if length.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) || !length.is_finite() {
        return Ok(());
    }
    let (ux, uy) = ((to.0 - from.0) / length, (to.1 - from.1) / length);
    let head = ARROW_HEAD.min(length);
    let base = (to.0 - head * ux, to.1 - head * uy);
    let wing = |side: f64| (base.0 - side * 0.4 * head * uy, base.1 + side * 0.4 * head * ux);
    canvas.line(&[from, base], Pen::solid(tint.rgb(), 1.8))?;
    canvas.fill(&[to, wing(1.0), wing(-1.0)], tint.rgb(), 1.0)
}

fn draw_slope<B: DrawingBackend>(
    canvas: &mut Canvas<'_, B>,
    frame: &Frame,
    at: Point,
    order: f64,
    decades: f64,
) -> Result<(), Failure> {
    let end = (at.0 * 10_f64.powf(decades), at.1 * 10_f64.powf(order * decades));
    let corners = [at, (end.0, at.1), end].map(|p| frame.place(p));
    if corners.iter().any(|p| !(p.0.is_finite() && p.1.is_finite())) {
        return Ok(());
    }
    let grey = Tint::Grey.rgb();
    canvas.line(&[corners[0], corners[1], corners[2], corners[0]], Pen::solid(grey, 1.4))?;
    let label = if (order - order.round()).abs() < 1e-9 { format!("{order:.0}") } else { format!("{order:.2}") };
    let look = Lettering { rgb: grey, ..Lettering::centred(LETTERS) };
    let across = Lettering { across: HPos::Left, ..look };
    canvas.text((corners[1].0 + 6.0, 0.5 * (corners[1].1 + corners[2].1)), &label, across)?;
    let below = if order >= 0.0 { 12.0 } else { -12.0 };
    let middle = 0.5 * (corners[0].0 + corners[1].0);
    canvas.text((middle, corners[0].1 + below), "1", look)
}
