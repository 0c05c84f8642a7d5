//! Two planes with a fading trail: hysteresis of the Jenkins element, and phase plane of mass 1 with the points of a Poincare section.

use super::{FADES, Frame, MOST_POINTS, Quantity, TRAIL};
use crate::model::Scales;
use crate::render::{Anchor, Colour, OverlayItem, Rectangle};
use crate::stage::motion::{Instant, Motion};
use crate::stage::plot::{Axis, Plot};
use glam::Vec2;

/// Radius of a point of the section, pixels of a 720 lines high picture.
const POINT: f32 = 2.6;
/// Time after which a point of the section has faded, non-dimensional.
const SECTION: f64 = 250.0;

/// Slider force over the displacement of mass 1.
#[derive(Debug, Clone)]
pub(super) struct Hysteresis {
    plot: Plot,
    scales: Scales,
}

/// Of mass 1, with a margin; at least the slip limit.
fn position_axis(frame: &Frame<'_>) -> Axis {
    Axis::symmetric(frame.motion.largest(|i| i.positions[0]).max(1.0) * frame.scales.length)
}

impl Hysteresis {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let axes = [position_axis(frame), Axis::symmetric(frame.scales.slip_force)];
        let labels = [Quantity("x₁", "m"), Quantity("f", "N")];
        Self { plot: frame.plot(place, "Hysteresis of the Jenkins element", labels, axes), scales: frame.scales }
    }

    pub fn draw(&self, motion: &Motion, now: &Instant, out: &mut Vec<OverlayItem>) {
        let s = self.scales;
        let scaled = |(x, f): (f64, f64)| (x * s.length, f * s.slip_force);
        self.plot.draw_frame(out);
        self.draw_limits(out);
        draw_trail(&self.plot, motion, now, |instants| with_corners(instants).into_iter().map(scaled).collect(), out);
        let (x, y) = scaled((now.positions[0], now.slider_force));
        self.plot.draw_marker(x, y, self.plot.palette.contact(now.contact), out);
    }

    /// The forces at which the slider gives way.
    fn draw_limits(&self, out: &mut Vec<OverlayItem>) {
        let (plot, limit) = (&self.plot, self.scales.slip_force);
        let colour = plot.palette.slip;
        for force in [-limit, limit] {
            plot.draw_line([(plot.x.min, force), (plot.x.max, force)].into_iter(), 1.2, colour.with_alpha(0.45), out);
        }
        plot.draw_word([plot.x.min, limit], Vec2::new(5.0, 12.0), Anchor::Left, "slip limit", colour, out);
    }
}

/// Displacement and slider force of mass 1, with the corners of the loop that fall between two instants: while the slider sticks the force
/// changes by as much as the displacement, so that from a sticking instant the slip limit is reached at
///
/// ```text
/// x = x_stick + (f_slip - f_stick)
/// ```
fn with_corners(instants: &mut dyn Iterator<Item = Instant>) -> Vec<(f64, f64)> {
    let mut points = Vec::new();
    let mut last: Option<Instant> = None;
    for now in instants {
        if let Some(last) = last
            && last.contact.is_stick() != now.contact.is_stick()
        {
            let (stick, slip) = if now.contact.is_stick() { (now, last) } else { (last, now) };
            points.push((stick.positions[0] + slip.slider_force - stick.slider_force, slip.slider_force));
        }
        points.push((now.positions[0], now.slider_force));
        last = Some(now);
    }
    points
}

/// Velocity over displacement of mass 1, and its points where mass 2 passes a maximum.
#[derive(Debug, Clone)]
pub(super) struct PhasePlane {
    plot: Plot,
    scales: Scales,
    /// Time and place of the section's points, in order of time.
    section: Vec<(f64, [f64; 2])>,
}

/// Where v2 falls through zero: by straight lines between samples in time, by the motion's own interpolation in place.
fn section(motion: &Motion) -> Vec<(f64, [f64; 2])> {
    let crossing = |pair: &[Instant]| {
        let (a, b) = (pair[0].velocities[1], pair[1].velocities[1]);
        (a > 0.0 && b <= 0.0).then(|| {
            let time = pair[0].time + (pair[1].time - pair[0].time) * a / (a - b);
            let at = motion.at(time);
            (time, [at.positions[0], at.velocities[0]])
        })
    };
    motion.instants().windows(2).filter_map(crossing).collect()
}

impl PhasePlane {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let s = frame.scales;
        let speed = frame.motion.largest(|i| i.velocities[0]).max(1.0);
        let axes = [position_axis(frame), Axis::symmetric(speed * s.velocity)];
        let labels = [Quantity("x₁", "m"), Quantity("v₁", "m/s")];
        let section = section(frame.motion);
        let title =
            if section.is_empty() { "Phase plane of mass 1" } else { "Phase plane of mass 1, points at v₂ = 0" };
        Self { plot: frame.plot(place, title, labels, axes), scales: s, section }
    }

    pub fn draw(&self, motion: &Motion, now: &Instant, out: &mut Vec<OverlayItem>) {
        let s = self.scales;
        let data = |i: &Instant| (i.positions[0] * s.length, i.velocities[0] * s.velocity);
        self.plot.draw_frame(out);
        draw_trail(&self.plot, motion, now, |instants| instants.map(|i| data(&i)).collect(), out);
        for (time, [x, v]) in self.section.iter().take_while(|(time, _)| *time <= now.time) {
            // What is long past is kept, faintly: with a swept parameter it belongs to another motion.
            let recent = 1.0 - ((now.time - time) / SECTION).min(1.0) as f32;
            let colour = self.plot.palette.masses[1].with_alpha(0.25 + 0.75 * recent);
            let (x, y) = (x * s.length, v * s.velocity);
            out.push(OverlayItem::Disc {
                centre: self.plot.pixel(x, y),
                radius: POINT * self.plot.scale,
                fill: colour,
                stroke: None,
            });
        }
        let (x, y) = data(now);
        self.plot.draw_marker(x, y, self.plot.palette.masses[0], out);
    }
}

/// The past, faintly, and the last stretch fading into it: lines over each other, each beginning later, so that no ends overlap. With
/// opacities `1/n` the `n`-th last line lets the opacity rise evenly to 1.
fn draw_trail(
    plot: &Plot,
    motion: &Motion,
    now: &Instant,
    data: impl Fn(&mut dyn Iterator<Item = Instant>) -> Vec<(f64, f64)>,
    out: &mut Vec<OverlayItem>,
) {
    let colour: Colour = plot.palette.masses[0];
    let past = data(&mut motion.between((now.time - 8.0 * TRAIL).max(0.0), now.time, 3 * MOST_POINTS));
    plot.draw_line(past.into_iter(), 1.0, colour.with_alpha(0.22), out);
    for lines_left in (1..=FADES).rev() {
        let from = now.time - TRAIL * f64::from(lines_left) / f64::from(FADES);
        let recent = data(&mut motion.between(from.max(0.0), now.time, MOST_POINTS));
        plot.draw_line(recent.into_iter(), 1.8, colour.with_alpha(1.0 / lines_left as f32), out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{Outcome, Sample, State, Trajectory};
    use crate::model::{ContactState, Direction, EnergyLedger};

    /// Loading from rest to x = 1.4 and back to 1.1: the slip limit is reached at x = 1 and left at 1.4.
    #[test]
    fn the_corners_of_the_loop_are_where_the_slider_gives_way_and_catches() {
        let slip = ContactState::Slip(Direction::Positive);
        let sample = |(time, x, v, f, contact)| Sample {
            time,
            state: State::two_mass([x, 0.0, v, 0.0, f]),
            contacts: vec![contact],
            ledger: EnergyLedger::default(),
        };
        let stick = ContactState::Stick;
        let samples =
            [(0.0, 0.8, 1.0, 0.8, stick), (1.0, 1.3, 1.0, 1.0, slip), (2.0, 1.1, -1.0, 0.7, stick)].map(sample);
        let motion =
            Motion::new(&Trajectory { samples: samples.to_vec(), events: vec![], outcome: Outcome::Completed })
                .unwrap();
        let found = with_corners(&mut motion.instants().iter().copied());
        let expected = [(0.8, 0.8), (1.0, 1.0), (1.3, 1.0), (1.4, 1.0), (1.1, 0.7)];
        assert_eq!(found.len(), expected.len());
        // Sums of numbers of size 1.
        assert!(found.iter().zip(expected).all(|(a, b)| (a.0 - b.0).abs() < 1e-15 && a.1 == b.1), "{found:?}");
    }
}
