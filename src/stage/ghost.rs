//! The exact solution beside the engine's motion: outlines of the carriages where the exact solution has them, the difference magnified so
//! that it can be seen, and a label that says by how much.

use super::motion::{Instant, Motion};
use super::numbers::with_power;
use super::palette::Palette;
use super::rig::RigModel;
use crate::render::{Anchor, Camera, OverlayItem, Stroke};
use glam::{Vec2, Vec3};
use std::collections::BTreeSet;

/// The largest difference of the film is drawn this long at most, in drawing units.
const LONGEST: f64 = 0.3;
/// Shorter ones are not seen, longer ones are drawn in full; between them the outline fades: a hard limit would make it flicker wherever
/// the difference passes through zero.
const SHORTEST: f64 = 0.004;
const FULL: f64 = 0.03;
/// Opacity of the outline's faces and edges.
const FACE: f32 = 0.15;
const EDGE: f32 = 0.9;
/// Differences beyond this factor of magnification are rounding.
const LARGEST_FACTOR: f64 = 1e9;
/// Faces of a cuboid whose corners are numbered by the bits of their signs, counter-clockwise seen from outside.
const FACES: [[usize; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

/// A reference motion and how much its distance from the motion shown is magnified.
#[derive(Debug, Clone)]
pub struct Ghost {
    reference: Motion,
    factor: f64,
}

impl Ghost {
    /// `None` where the two motions do not differ by more than rounding. `magnification` is that of displacements, drawing units per
    /// unit.
    #[must_use]
    pub fn new(motion: &Motion, reference: Motion, magnification: f32) -> Option<Self> {
        let end = reference.end();
        let largest = motion.largest(|at| if at.time > end { 0.0 } else { distance(at, &reference.at(at.time)) });
        let wanted = LONGEST / (largest * f64::from(magnification));
        // 1, 2 or 5 times a power of ten, and never a reduction.
        let decade = 10f64.powf(wanted.log10().floor());
        let factor = [5.0, 2.0, 1.0].map(|digit| digit * decade).into_iter().find(|factor| *factor <= wanted);
        let factor = factor.unwrap_or(decade).max(1.0);
        (largest > 0.0 && factor <= LARGEST_FACTOR).then_some(Self { reference, factor })
    }

    /// Outlines and label at one instant, if there is something to see; the label stands at `place`.
    pub fn draw(
        &self,
        rig: &RigModel,
        camera: &Camera,
        size: [u32; 2],
        now: &Instant,
        (palette, place, scale): (&Palette, Vec2, f32),
        out: &mut Vec<OverlayItem>,
    ) {
        if now.time > self.reference.end() {
            return;
        }
        let exact = self.reference.at(now.time);
        let mut is_seen = false;
        for i in 0..2 {
            let difference = self.factor * (exact.positions[i] - now.positions[i]);
            let shown = shown(difference.abs() * f64::from(rig.magnification()));
            if shown > 0.0 {
                let corners = rig.outline(i, now.positions[i] + difference);
                draw_cuboid(corners, camera, size, (palette, scale, shown), out);
                is_seen = true;
            }
        }
        let text = if is_seen {
            let factor =
                if self.factor > 1.0 { format!(", difference × {}", thousands(self.factor)) } else { String::new() };
            format!("outline: exact solution{factor}; now {} apart", with_power(distance(now, &exact)))
        } else {
            let bound = SHORTEST / (self.factor * f64::from(rig.magnification()));
            format!("exact solution: difference below {}", with_power(rounded_up(bound)))
        };
        out.push(OverlayItem::Text {
            position: place,
            anchor: Anchor::Left,
            size: 13.0 * scale,
            colour: palette.faint_text,
            bold: false,
            text,
        });
    }
}

fn distance(a: &Instant, b: &Instant) -> f64 {
    (0..2).map(|i| (a.positions[i] - b.positions[i]).abs()).fold(0.0, f64::max)
}

/// How far an outline as long a way off as this is faded in, 0 to 1: smoothly from [`SHORTEST`] to [`FULL`].
fn shown(length: f64) -> f32 {
    let part = ((length - SHORTEST) / (FULL - SHORTEST)).clamp(0.0, 1.0);
    (part * part * (3.0 - 2.0 * part)) as f32
}

/// The next larger number of two digits: what lies below a bound lies below this as well.
fn rounded_up(bound: f64) -> f64 {
    let step = 10f64.powf(bound.log10().floor() - 1.0);
    (bound / step).ceil() * step
}

/// Digits in groups of three.
fn thousands(value: f64) -> String {
    let digits = format!("{value:.0}");
    let first = digits.len() % 3;
    let mut text = digits[..first].to_owned();
    for group in digits.as_bytes()[first..].chunks(3) {
        if !text.is_empty() {
            text.push('\u{202f}');
        }
        text.extend(group.iter().map(|&byte| char::from(byte)));
    }
    text
}

/// The sides towards the camera: the others are behind the body.
fn draw_cuboid(
    corners: [Vec3; 8],
    camera: &Camera,
    size: [u32; 2],
    (palette, scale, shown): (&Palette, f32, f32),
    out: &mut Vec<OverlayItem>,
) {
    let Some(places) = corners.iter().map(|&corner| camera.project(corner, size)).collect::<Option<Vec<Vec2>>>() else {
        return;
    };
    let mut edges = BTreeSet::new();
    for face in FACES {
        let points = face.map(|corner| places[corner]);
        // Rows of a picture run downwards, which turns the sense round.
        if (points[1] - points[0]).perp_dot(points[2] - points[1]) >= 0.0 {
            continue;
        }
        out.push(OverlayItem::Polygon {
            points: points.to_vec(),
            fill: palette.ghost.with_alpha(FACE * shown),
            clip: None,
        });
        edges.extend((0..4).map(|i| (face[i].min(face[(i + 1) % 4]), face[i].max(face[(i + 1) % 4]))));
    }
    for (from, to) in edges {
        let stroke = Stroke { width: 2.0 * scale, colour: palette.ghost.with_alpha(EDGE * shown) };
        out.push(OverlayItem::Line { points: vec![places[from], places[to]], stroke, clip: None });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{Outcome, Sample, State, Trajectory};
    use crate::model::{ContactState, EnergyLedger};

    /// x1 = sin t + offset, x2 = 0.
    fn motion(offset: f64) -> Motion {
        let sample = |n: u32| {
            let time = 0.05 * f64::from(n);
            Sample {
                time,
                state: State::two_mass([time.sin() + offset, 0.0, time.cos(), 0.0, 0.0]),
                contacts: vec![ContactState::Stick],
                ledger: EnergyLedger::default(),
            }
        };
        let samples = (0..200).map(sample).collect();
        Motion::new(&Trajectory { samples, events: vec![], outcome: Outcome::Completed }).unwrap()
    }

    #[test]
    fn a_difference_is_magnified_by_the_round_factor_that_still_fits() {
        let factor = |offset| Ghost::new(&motion(0.0), motion(offset), 0.3).map(|ghost| ghost.factor);
        // 0.3 / (offset * 0.3), rounded down to 1, 2 or 5 times a power of ten.
        assert_eq!(factor(1.9e-5), Some(5e4));
        assert_eq!(factor(0.9e-5), Some(1e5));
        assert_eq!(factor(0.4e-5), Some(2e5));
        assert_eq!(factor(5.0), Some(1.0));
        assert_eq!(factor(0.0), None);
        assert_eq!(factor(1e-15), None, "rounding is no difference");
    }

    #[test]
    fn an_outline_fades_in_without_a_step() {
        assert_eq!([0.0, SHORTEST, FULL, 1.0].map(shown), [0.0, 0.0, 1.0, 1.0]);
        let lengths = (0..=400).map(|n| 1e-4 * f64::from(n));
        let values: Vec<f32> = lengths.map(shown).collect();
        // A smooth step is steepest in its middle, 3/2 over its width of 0.026: 0.0058 from one of these lengths to the next.
        assert!(values.windows(2).all(|pair| pair[1] >= pair[0] && pair[1] - pair[0] < 0.006));
    }

    #[test]
    fn a_bound_is_never_rounded_below_itself() {
        assert_eq!(with_power(rounded_up(1.31e-6)), "1.4·10⁻⁶");
        assert_eq!(with_power(rounded_up(9.92e-6)), "1.0·10⁻⁵");
        assert_eq!(with_power(rounded_up(0.25)), "2.5·10⁻¹");
    }

    #[test]
    fn factors_are_written_in_groups_of_three() {
        assert_eq!(thousands(1000.0), "1\u{202f}000");
        assert_eq!(thousands(100.0), "100");
        assert_eq!(thousands(10_000.0), "10\u{202f}000");
    }
}
