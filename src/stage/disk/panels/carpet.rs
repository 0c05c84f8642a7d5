//! Carpet: deflection of every blade over the last stretch of time, as colour. A forward wave is a stripe that rises to the right.

use super::Frame;
use crate::render::{Anchor, Colour, OverlayItem, Rectangle};
use crate::stage::disk::colours::DeflectionColours;
use crate::stage::disk::motion::DiskInstant;
use crate::stage::plot::{Axis, Plot};
use glam::Vec2;

/// Length of the stretch, non-dimensional time units: some seven periods.
const WINDOW: f64 = 44.0;
/// Time of one column.
const COLUMN: f64 = 0.2;
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
    /// Colours of all columns of the motion, blade 0 first; column k stands for the time (k + 1/2) [`COLUMN`].
    columns: Vec<Colour>,
}

impl Carpet {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let (motion, blades) = (frame.motion, frame.motion.blades());
        let axes = [Axis::exactly(0.0, WINDOW.min(motion.end())), Axis::exactly(-0.5, blades as f64 - 0.5)];
        let plot = frame.plot(place, "Deflection of every blade", ["t", "blade"], axes);
        let count = (motion.end() / COLUMN + 1e-9).floor() as usize;
        let column = |k: usize| {
            let now = motion.at((k as f64 + 0.5) * COLUMN);
            now.positions.into_iter().take(blades)
        };
        let columns = (0..count).flat_map(column).map(|x| frame.colours.of(x)).collect();
        Self {
            plot: Plot { right: SCALE_ROOM, y: whole_ticks(plot.y), ..plot },
            colours: frame.colours,
            blades,
            columns,
        }
    }

    /// The axis moves with time once it is full.
    pub fn draw(&self, now: &DiskInstant, out: &mut Vec<OverlayItem>) {
        let window = self.plot.x.max;
        let end = now.time.max(window);
        let plot = Plot { x: self.plot.x.slid_to(end - window, end), ..self.plot.clone() };
        plot.draw_frame(out);
        let first = ((end - window) / COLUMN).ceil() as usize;
        // Whole columns alone: rounding may put the end of one just after now.
        let known = ((now.time / COLUMN + 1e-9).floor() as usize).min(self.columns.len() / self.blades);
        if known > first {
            let count = known - first;
            let cell = |n: usize| self.columns[(first + n % count) * self.blades + self.blades - 1 - n / count];
            let [left, right] = [first, known].map(|k| k as f64 * COLUMN);
            out.push(OverlayItem::Raster {
                area: Rectangle { min: plot.pixel(left, plot.y.max), max: plot.pixel(right, plot.y.min) },
                columns: count,
                cells: (0..count * self.blades).map(cell).collect(),
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
