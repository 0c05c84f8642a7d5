//! Lays out the panels of a figure and draws their axes.

use super::canvas::{Canvas, Failure, Lettering, Pen, text_width};
use super::error::ReportError;
use super::figure::{Figure, Panel};
use super::frame::{Area, Frame};
use super::legend::{self, Entry};
use super::marks;
use super::ticks::{Ticks, superscript, ticks};
use plotters::prelude::DrawingBackend;
use plotters::style::text_anchor::HPos;

const TITLE: f64 = 21.0;
const PANEL_TITLE: f64 = 18.0;
const AXIS: f64 = 18.0;
const NUMBERS: f64 = 15.0;
const MARGIN: f64 = 12.0;
/// Room for one line of an axis label or title.
const LINE: f64 = 28.0;
/// Pixels per labelled tick.
const SPACING: (f64, f64) = (95.0, 60.0);
const INK: (u8, u8, u8) = (0x30, 0x30, 0x30);
const GRID: (u8, u8, u8) = (0xe6, 0xe6, 0xe6);

/// A panel with its place.
struct Placed<'a> {
    panel: &'a Panel,
    frame: Frame,
    /// Top of the panel with its title.
    top: f64,
    ticks: [Ticks; 2],
    legend: Place,
    entries: Vec<Entry>,
}

enum Place {
    Nowhere,
    Inside(Area),
    Beneath(Area),
}

/// Draws everything.
///
/// # Errors
/// [`ReportError::Empty`] and [`ReportError::BadRange`] for axes without a range, [`ReportError::Drawing`] if the back end fails.
pub(super) fn draw<B: DrawingBackend>(figure: &Figure, canvas: &mut Canvas<'_, B>) -> Result<(), ReportError> {
    let (width, height) = (f64::from(figure.size.0), f64::from(figure.size.1));
    let whole = Area { left: 0.0, top: 0.0, right: width, bottom: height };
    let shared = if figure.shared_legend { legend::entries(figure.panels.iter()) } else { Vec::new() };
    let strip = legend::strip_height(&shared, width - 2.0 * MARGIN);
    let top = if figure.title.is_empty() { MARGIN } else { MARGIN + LINE + 6.0 };
    let bottom = height - MARGIN - strip;
    let columns = figure.columns.max(1);
    let rows = figure.panels.len().div_ceil(columns).max(1);
    let (cell_width, cell_height) = ((width - 2.0 * MARGIN) / columns as f64, (bottom - top) / rows as f64);
    let mut placed = Vec::new();
    for (n, panel) in figure.panels.iter().enumerate() {
        let (row, column) = ((n / columns) as f64, (n % columns) as f64);
        let left = MARGIN + column * cell_width;
        let cell_top = top + row * cell_height;
        let cell = Area { left, top: cell_top, right: left + cell_width, bottom: cell_top + cell_height };
        let own = if figure.shared_legend { Vec::new() } else { legend::entries(std::iter::once(panel)) };
        placed.push(place(panel, cell, own).map_err(|error| named(error, figure))?);
    }
    let mut all = || {
        canvas.fill(&whole.corners(), (0xff, 0xff, 0xff), 1.0)?;
        if !figure.title.is_empty() {
            canvas.text((0.5 * width, MARGIN + 0.5 * LINE), &figure.title, Lettering::centred(TITLE))?;
        }
        placed.iter().try_for_each(|placed| draw_panel(canvas, placed))?;
        let strip = Area { left: MARGIN, top: bottom, right: width - MARGIN, bottom: height };
        legend::draw_strip(canvas, &shared, strip)?;
        Ok(canvas.backend.present()?)
    };
    all().map_err(|error: Failure| ReportError::Drawing { title: figure.name(), reason: error.0 })
}

/// An empty panel without a title is known by the figure's.
fn named(error: ReportError, figure: &Figure) -> ReportError {
    match error {
        ReportError::Empty { title } if title.is_empty() => ReportError::Empty { title: figure.name() },
        other => other,
    }
}

fn place(panel: &Panel, cell: Area, entries: Vec<Entry>) -> Result<Placed<'_>, ReportError> {
    let title = if panel.title.is_empty() { 4.0 } else { LINE };
    let (beside, beneath) = if panel.bare { (6.0, 6.0) } else { (LINE + 12.0, 2.0 * LINE) };
    let mut area = Area {
        left: cell.left + beside,
        top: cell.top + title,
        right: cell.right - 14.0,
        bottom: cell.bottom - beneath,
    };
    let labels = |area: Area| {
        let frame = Frame::new(panel, area)?;
        Ok::<_, ReportError>([
            ticks(panel.x.scale, frame.x.0, frame.x.1, area.width() / SPACING.0),
            ticks(panel.y.scale, frame.y.0, frame.y.1, area.height() / SPACING.1),
        ])
    };
    if !panel.bare {
        let [_, up] = labels(area)?;
        area.left += up.ticks.iter().map(|tick| text_width(&tick.label, NUMBERS)).fold(0.0, f64::max);
    }
    let mut legend = Place::Nowhere;
    if !entries.is_empty() {
        let strip = legend::strip_height(&entries, area.width());
        legend = match legend::free_corner(&entries, panel, &Frame::new(panel, area)?) {
            Some(corner) => Place::Inside(corner),
            None => {
                area.bottom -= strip;
                Place::Beneath(Area { top: area.bottom + beneath, bottom: cell.bottom, ..area })
            }
        };
    }
    let frame = Frame::new(panel, area)?;
    Ok(Placed { panel, frame, top: cell.top, ticks: labels(area)?, legend, entries })
}

fn draw_panel<B: DrawingBackend>(canvas: &mut Canvas<'_, B>, placed: &Placed<'_>) -> Result<(), Failure> {
    let Placed { panel, frame, top, .. } = placed;
    let middle = 0.5 * (frame.area.left + frame.area.right);
    if !panel.title.is_empty() {
        let look = Lettering { bold: true, ..Lettering::centred(PANEL_TITLE) };
        canvas.text((middle, top + 0.5 * LINE), &panel.title, look)?;
    }
    if !panel.bare {
        draw_grid(canvas, placed)?;
    }
    panel.marks.iter().try_for_each(|mark| marks::draw(canvas, frame, mark))?;
    if !panel.bare {
        draw_axes(canvas, placed)?;
    }
    match &placed.legend {
        Place::Nowhere => Ok(()),
        Place::Inside(area) => legend::draw_box(canvas, &placed.entries, *area),
        Place::Beneath(strip) => legend::draw_strip(canvas, &placed.entries, *strip),
    }
}

fn draw_grid<B: DrawingBackend>(canvas: &mut Canvas<'_, B>, placed: &Placed<'_>) -> Result<(), Failure> {
    let area = placed.frame.area;
    let pen = Pen::solid(GRID, 1.0);
    let [across, up] = &placed.ticks;
    for tick in across.ticks.iter().filter(|tick| !tick.label.is_empty()) {
        let x = placed.frame.across(tick.at);
        canvas.line(&[(x, area.top), (x, area.bottom)], pen)?;
    }
    for tick in up.ticks.iter().filter(|tick| !tick.label.is_empty()) {
        let y = placed.frame.up(tick.at);
        canvas.line(&[(area.left, y), (area.right, y)], pen)?;
    }
    Ok(())
}

fn draw_axes<B: DrawingBackend>(canvas: &mut Canvas<'_, B>, placed: &Placed<'_>) -> Result<(), Failure> {
    let area = placed.frame.area;
    let pen = Pen::solid(INK, 1.2);
    let mut border = area.corners().to_vec();
    border.push(border[0]);
    canvas.line(&border, pen)?;
    let [across, up] = &placed.ticks;
    let numbers = Lettering { rgb: INK, ..Lettering::centred(NUMBERS) };
    let length = |label: &str| if label.is_empty() { 3.0 } else { 6.0 };
    for tick in &across.ticks {
        let x = placed.frame.across(tick.at);
        canvas.line(&[(x, area.bottom), (x, area.bottom - length(&tick.label))], pen)?;
        canvas.text((x, area.bottom + 15.0), &tick.label, numbers)?;
    }
    let mut widest: f64 = 0.0;
    for tick in &up.ticks {
        let y = placed.frame.up(tick.at);
        canvas.line(&[(area.left, y), (area.left + length(&tick.label), y)], pen)?;
        canvas.text((area.left - 7.0, y), &tick.label, Lettering { across: HPos::Right, ..numbers })?;
        widest = widest.max(text_width(&tick.label, NUMBERS));
    }
    let axis = Lettering::centred(AXIS);
    let label = |name: &str, ticks: &Ticks| match ticks.exponent {
        0 => name.to_owned(),
        exponent => format!("{name}  [10{}]", superscript(exponent)),
    };
    let x = 0.5 * (area.left + area.right);
    canvas.text((x, area.bottom + 42.0), &label(&placed.panel.x.label, across), axis)?;
    let y = 0.5 * (area.top + area.bottom);
    let beside = area.left - widest - 24.0;
    canvas.text((beside, y), &label(&placed.panel.y.label, up), Lettering { upwards: true, ..axis })
}
