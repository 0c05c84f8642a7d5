//! Carpet: deflection of every blade over the last stretch of time, as colour. A forward wave is a stripe that rises to the right.

use super::Frame;
use crate::render::{Anchor, OverlayItem, Rectangle};
use crate::stage::disk::colours::DeflectionColours;
use crate::stage::disk::motion::{DiskInstant, DiskMotion};
use crate::stage::plot::{Axis, Plot};
use glam::Vec2;

/// Length of the stretch, non-dimensional time units: some seven periods.
const WINDOW: f64 = 44.0;
/// Columns of a full stretch: about a pixel each.
const COLUMNS: f64 = 220.0;
/// Border for the scale of colours, its left end and width, pixels of a 720 lines high picture.
const SCALE_ROOM: f32 = 72.0;
const SCALE_PLACE: [f32; 2] = [12.0, 10.0];
/// Cells of the scale of colours.
const SCALE_CELLS: usize = 33;

#[derive(Debug, Clone)]
pub(super) struct Carpet {
    plot: Plot,
    colours: DeflectionColours,
    blades: usize,
    /// Time of one column.
    column: f64,
}

impl Carpet {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let blades = frame.motion.blades();
        let rows = Axis::exactly(-0.5, blades as f64 - 0.5);
        let plot = frame.plot_until_now(place, "Deflection of every blade", "blade", WINDOW, rows);
        let column = -plot.x.min / COLUMNS;
        Self {
            plot: Plot { right: SCALE_ROOM, y: whole_ticks(plot.y), ..plot },
            colours: frame.colours,
            blades,
            column,
        }
    }

    /// Columns end now, so that the motion runs through without a jolt.
    pub fn draw(&self, motion: &DiskMotion, now: &DiskInstant, out: &mut Vec<OverlayItem>) {
        let plot = &self.plot;
        plot.draw_frame(out);
        // Rounding may take a whole column for a little less.
        let count = (now.time / self.column + 1e-9).floor().min(COLUMNS) as usize;
        if count > 0 {
            let middle = |n: usize| now.time - ((count - n) as f64 - 0.5) * self.column;
            let columns: Vec<DiskInstant> = (0..count).map(|n| motion.at(middle(n))).collect();
            let rows = (0..self.blades).rev();
            let cells = rows.flat_map(|blade| columns.iter().map(move |column| column.positions[blade]));
            let left = -(count as f64) * self.column;
            out.push(OverlayItem::Raster {
                area: Rectangle { min: plot.pixel(left, plot.y.max), max: plot.pixel(0.0, plot.y.min) },
                columns: count,
                cells: cells.map(|x| self.colours.of(x)).collect(),
            });
        }
        self.draw_scale(out);
    }

    fn draw_scale(&self, out: &mut Vec<OverlayItem>) {
        let (plot, s) = (&self.plot, self.plot.scale);
        let (area, limit) = (plot.area(), self.colours.limit());
        let [left, width] = SCALE_PLACE.map(|x| x * s);
        let bar = Rectangle {
            min: Vec2::new(area.max.x + left, area.min.y),
            max: Vec2::new(area.max.x + left + width, area.max.y),
        };
        let value = |cell: usize| limit * (1.0 - 2.0 * cell as f64 / (SCALE_CELLS - 1) as f64);
        let cells = (0..SCALE_CELLS).map(|cell| self.colours.of(value(cell))).collect();
        out.push(OverlayItem::Raster { area: bar, columns: 1, cells });
        let middle = 0.5 * (bar.min.y + bar.max.y);
        for (y, value) in [(bar.min.y + 5.0 * s, limit), (middle, 0.0), (bar.max.y - 5.0 * s, -limit)] {
            out.push(OverlayItem::Text {
                position: Vec2::new(bar.max.x + 4.0 * s, y + 3.5 * s),
                anchor: Anchor::Left,
                size: 10.0 * s,
                colour: plot.palette.faint_text,
                bold: false,
                text: written(value),
            });
        }
    }
}

/// Three significant digits with a sign.
pub fn written(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = (2.0 - value.abs().log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:+.digits$}").replace('-', "−")
}

/// Ticks at whole numbers of blades.
fn whole_ticks(axis: Axis) -> Axis {
    Axis { tick: axis.tick.max(1.0).round(), ..axis }
}
