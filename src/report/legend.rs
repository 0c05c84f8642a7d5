//! Where the legend goes: the emptiest corner of the panel, or beneath it if every corner holds data.

use super::canvas::{Canvas, Failure, Lettering, Pen, Point, text_width};
use super::figure::{Mark, Panel};
use super::frame::{Area, Frame};
use super::marks::{SHADE, draw_marker, pen_of};
use super::series::{Style, Tint};
use plotters::prelude::DrawingBackend;
use plotters::style::text_anchor::HPos;

pub(super) const LETTERS: f64 = 16.0;
const ROW: f64 = 24.0;
const SAMPLE: f64 = 30.0;
const GAP: f64 = 8.0;
const PADDING: f64 = 8.0;
/// Distance of the legend from the frame.
const INSET: f64 = 10.0;
/// Spacing at which lines are looked for under the legend.
const PROBE: f64 = 5.0;

/// A line of the legend.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    label: String,
    sample: Sample,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Sample {
    Series(Style, Tint),
    Shade(Tint),
}

/// The labelled marks, each label once.
pub(super) fn entries<'a>(panels: impl Iterator<Item = &'a Panel>) -> Vec<Entry> {
    let mut found: Vec<Entry> = Vec::new();
    for mark in panels.flat_map(|panel| &panel.marks) {
        let label = mark.label();
        if label.is_empty() || found.iter().any(|entry| entry.label == label) {
            continue;
        }
        let sample = match mark {
            Mark::Series(series) => Sample::Series(series.style, series.tint),
            Mark::BandX { tint, .. } | Mark::BandY { tint, .. } | Mark::Region { tint, .. } => Sample::Shade(*tint),
            Mark::Text { .. } | Mark::Arrow { .. } | Mark::Slope { .. } => continue,
        };
        found.push(Entry { label: label.to_owned(), sample });
    }
    found
}

fn entry_width(entry: &Entry) -> f64 {
    SAMPLE + GAP + text_width(&entry.label, LETTERS)
}

/// Corner of the frame in which the legend hides no data; `None` if there is none.
pub(super) fn free_corner(entries: &[Entry], panel: &Panel, frame: &Frame) -> Option<Area> {
    let width = entries.iter().map(entry_width).fold(0.0, f64::max) + 2.0 * PADDING;
    let height = ROW * entries.len() as f64 + 2.0 * PADDING;
    let area = frame.area;
    if width + 2.0 * INSET > area.width() || height + 2.0 * INSET > area.height() {
        return None;
    }
    let taken = taken(panel, frame);
    let (left, right) = (area.left + INSET, area.right - INSET - width);
    let (top, bottom) = (area.top + INSET, area.bottom - INSET - height);
    let corners = [(right, top), (left, top), (right, bottom), (left, bottom)];
    corners
        .map(|(x, y)| Area { left: x, top: y, right: x + width, bottom: y + height })
        .into_iter()
        .find(|corner| !taken.iter().any(|point| corner.contains(*point)))
}

/// Pixels that data or annotations lie on.
fn taken(panel: &Panel, frame: &Frame) -> Vec<Point> {
    let mut found = Vec::new();
    let mut along = |points: &[Point]| {
        for pair in points.windows(2) {
            let steps = ((pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1) / PROBE).ceil().max(1.0) as usize;
            let at = |n: usize| n as f64 / steps as f64;
            let between = |a: f64, b: f64, n| a + (b - a) * at(n);
            found.extend((0..=steps).map(|n| (between(pair[0].0, pair[1].0, n), between(pair[0].1, pair[1].1, n))));
        }
    };
    for mark in &panel.marks {
        match mark {
            Mark::Series(series) if series.style.joins() => frame.line(&series.points).iter().for_each(|p| along(p)),
            Mark::Series(series) => {
                let placed: Vec<Point> = series.points.iter().map(|p| frame.place(*p)).collect();
                placed.iter().for_each(|p| along(&[*p, *p]));
            }
            Mark::Text { at, text, .. } => {
                let ((x, y), width) = (frame.place(*at), text_width(text, LETTERS));
                along(&[(x - width, y), (x + width, y)]);
            }
            Mark::Arrow { from, to, .. } => along(&[frame.place(*from), frame.place(*to)]),
            Mark::Slope { at, order, decades } => {
                let (x, y) = *at;
                let end = (x * 10_f64.powf(*decades), y * 10_f64.powf(order * decades));
                along(&[frame.place(*at), frame.place((end.0, y)), frame.place(end)]);
            }
            Mark::BandX { .. } | Mark::BandY { .. } | Mark::Region { .. } => {}
        }
    }
    found
}

/// Rows of a legend of the given width, entries beside each other.
fn rows(entries: &[Entry], width: f64) -> Vec<Vec<&Entry>> {
    let mut rows: Vec<Vec<&Entry>> = Vec::new();
    let mut used = f64::INFINITY;
    for entry in entries {
        let needed = entry_width(entry) + 3.0 * GAP;
        if used + needed > width {
            rows.push(Vec::new());
            used = 0.0;
        }
        used += needed;
        if let Some(row) = rows.last_mut() {
            row.push(entry);
        }
    }
    rows
}

/// Height of a legend in a strip of the given width.
pub(super) fn strip_height(entries: &[Entry], width: f64) -> f64 {
    ROW * rows(entries, width).len() as f64 + if entries.is_empty() { 0.0 } else { PADDING }
}

/// Rows centred in the strip.
pub(super) fn draw_strip<B: DrawingBackend>(
    canvas: &mut Canvas<'_, B>,
    entries: &[Entry],
    strip: Area,
) -> Result<(), Failure> {
    for (n, row) in rows(entries, strip.width()).into_iter().enumerate() {
        let width: f64 = row.iter().map(|entry| entry_width(entry) + 3.0 * GAP).sum();
        let mut x = strip.left + 0.5 * (strip.width() - width) + 1.5 * GAP;
        for entry in row {
            draw_entry(canvas, entry, (x, strip.top + PADDING + ROW * (n as f64 + 0.5)))?;
            x += entry_width(entry) + 3.0 * GAP;
        }
    }
    Ok(())
}

/// A box with an entry per row.
pub(super) fn draw_box<B: DrawingBackend>(
    canvas: &mut Canvas<'_, B>,
    entries: &[Entry],
    area: Area,
) -> Result<(), Failure> {
    canvas.fill(&area.corners(), (0xff, 0xff, 0xff), 0.9)?;
    let mut border = area.corners().to_vec();
    border.push(border[0]);
    canvas.line(&border, Pen::solid((0xc8, 0xc8, 0xc8), 1.0))?;
    for (n, entry) in entries.iter().enumerate() {
        draw_entry(canvas, entry, (area.left + PADDING, area.top + PADDING + ROW * (n as f64 + 0.5)))?;
    }
    Ok(())
}

fn draw_entry<B: DrawingBackend>(canvas: &mut Canvas<'_, B>, entry: &Entry, (x, y): Point) -> Result<(), Failure> {
    match entry.sample {
        Sample::Shade(tint) => {
            let patch = Area { left: x, top: y - 7.0, right: x + SAMPLE, bottom: y + 7.0 };
            canvas.fill(&patch.corners(), tint.rgb(), SHADE)?;
        }
        Sample::Series(style, tint) if style.joins() => {
            canvas.line(&[(x, y), (x + SAMPLE, y)], pen_of(style, tint))?;
        }
        Sample::Series(style, tint) => {
            // One dot of a cloud would not be seen.
            let style = if style == Style::Cloud { Style::Dots } else { style };
            draw_marker(canvas, style, tint, (x + 0.5 * SAMPLE, y))?;
        }
    }
    let look = Lettering { across: HPos::Left, ..Lettering::centred(LETTERS) };
    canvas.text((x + SAMPLE + GAP, y), &entry.label, look)
}
