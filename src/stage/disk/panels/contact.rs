//! Hysteresis of the contact that slips most: slider force over elongation, with a fading trail in the colours of stick and slip.

use super::{Frame, MOST_POINTS};
use crate::model::{Attachment, ContactState, JenkinsElement};
use crate::render::{Anchor, OverlayItem, Rectangle};
use crate::stage::disk::motion::{DiskInstant, DiskMotion};
use crate::stage::plot::{Axis, Plot};
use glam::Vec2;

/// Length of the trail and of its bright part, non-dimensional time units: about two periods and half a one.
const TRAIL: [f64; 2] = [13.0, 3.0];

#[derive(Debug, Clone)]
pub(super) struct Contact {
    plot: Plot,
    /// Number of the contact and its element; none where the disk has no contact.
    element: Option<(usize, JenkinsElement)>,
}

/// Where a contact sits, in words.
fn place_of(element: &JenkinsElement, blades: usize) -> String {
    match element.attachment {
        Attachment::Between(i, j) if i < blades && j < blades => format!("between blades {i} and {j}"),
        Attachment::Ground(i) | Attachment::Between(i, _) => format!("at the foot of blade {i}"),
    }
}

impl Contact {
    pub fn new(frame: &Frame<'_>, place: Rectangle) -> Self {
        let motion = frame.motion;
        let slips = |number: usize| motion.instants().iter().filter(|i| !i.contacts[number].is_stick()).count();
        let count = motion.elements().len();
        let counts: Vec<usize> = (0..count).map(slips).collect();
        let most = (0..count).reduce(|best, number| if counts[number] > counts[best] { number } else { best });
        let element = most.map(|number| (number, motion.elements()[number]));
        let reach = element.map_or(1.0, |(_, element)| {
            let elongation = |i: &DiskInstant| element.attachment.elongation(&i.positions).abs();
            motion.instants().iter().map(elongation).fold(element.slip_force / element.stiffness, f64::max)
        });
        let title = element.map_or("No contacts".to_owned(), |(_, element)| {
            format!("Contact {}", place_of(&element, motion.blades()))
        });
        let axes = [Axis::symmetric(reach), Axis::symmetric(1.0)];
        Self { plot: frame.plot(place, &title, ["elongation u", "force / slip force"], axes), element }
    }

    pub fn draw(&self, motion: &DiskMotion, now: &DiskInstant, out: &mut Vec<OverlayItem>) {
        let (plot, palette) = (&self.plot, &self.plot.palette);
        plot.draw_frame(out);
        let Some((number, element)) = self.element else { return };
        self.draw_limits(out);
        for (length, width, alpha) in [(TRAIL[0], 1.2, 0.45), (TRAIL[1], 2.4, 1.0)] {
            let past = motion.between((now.time - length).max(0.0), now.time, MOST_POINTS).chain([now]);
            for (contact, points) in runs(past.map(|i| Point::of(i, number, &element)), &element) {
                plot.draw_line(points.into_iter(), width, palette.contact(contact).with_alpha(alpha), out);
            }
        }
        let Point { place: [x, y], contact } = Point::of(now, number, &element);
        plot.draw_marker(x, y, palette.contact(contact), out);
        out.push(OverlayItem::Text {
            // Above the lower slip limit.
            position: plot.area().max - Vec2::new(4.0, 13.0) * plot.scale,
            anchor: Anchor::Right,
            size: 12.0 * plot.scale,
            colour: palette.contact(contact),
            bold: true,
            text: if contact.is_stick() { "stick" } else { "slip" }.to_owned(),
        });
    }

    /// The forces at which the contact gives way.
    fn draw_limits(&self, out: &mut Vec<OverlayItem>) {
        let (plot, colour) = (&self.plot, self.plot.palette.slip);
        for force in [-1.0, 1.0] {
            plot.draw_line([(plot.x.min, force), (plot.x.max, force)].into_iter(), 1.0, colour.with_alpha(0.4), out);
        }
        plot.draw_word([plot.x.min, 1.0], Vec2::new(5.0, 12.0), Anchor::Left, "slip limit", colour, out);
    }
}

/// Elongation and force of a contact, and its state.
#[derive(Debug, Clone, Copy)]
struct Point {
    place: [f64; 2],
    contact: ContactState,
}

impl Point {
    fn of(instant: &DiskInstant, number: usize, element: &JenkinsElement) -> Self {
        let place = [element.attachment.elongation(&instant.positions), instant.slider_forces[number]];
        Self { place, contact: instant.contacts[number] }
    }
}

/// A trail in pieces of stick and of slip, with the corners that fall between two samples: the force F of a contact that sticks follows the
/// elongation u with its stiffness k, so that from a sticking sample it comes to that of the slipping one at
///
/// ```text
/// u = u_stick + (F_slip - F_stick)/k
/// ```
fn runs(points: impl Iterator<Item = Point>, element: &JenkinsElement) -> Vec<(ContactState, Vec<(f64, f64)>)> {
    let reach = element.slip_force / element.stiffness;
    let mut runs: Vec<(ContactState, Vec<(f64, f64)>)> = Vec::new();
    let mut last: Option<Point> = None;
    for point in points {
        let [x, y] = point.place;
        match (last, runs.last_mut()) {
            (Some(last), Some((contact, run))) if last.contact.is_stick() == point.contact.is_stick() => {
                *contact = point.contact;
                run.push((x, y));
            }
            (Some(last), Some((_, run))) => {
                let (stick, slip) = if point.contact.is_stick() { (point, last) } else { (last, point) };
                let corner = (stick.place[0] + (slip.place[1] - stick.place[1]) * reach, slip.place[1]);
                run.push(corner);
                runs.push((point.contact, vec![corner, (x, y)]));
            }
            _ => runs.push((point.contact, vec![(x, y)])),
        }
        last = Some(point);
    }
    runs
}
