//! Hysteresis of the contact that slips most: slider force over elongation, with a fading trail.

use super::{Frame, MOST_POINTS};
use crate::model::{Attachment, JenkinsElement};
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
        Self { plot: frame.plot(place, &title, ["elongation u", "f/f slip"], axes), element }
    }

    pub fn draw(&self, motion: &DiskMotion, now: &DiskInstant, out: &mut Vec<OverlayItem>) {
        let (plot, palette) = (&self.plot, &self.plot.palette);
        plot.draw_frame(out);
        let Some((number, element)) = self.element else { return };
        let data = |i: &DiskInstant| (element.attachment.elongation(&i.positions), i.slider_forces[number]);
        for (length, width, alpha) in [(TRAIL[0], 1.2, 0.35), (TRAIL[1], 2.0, 1.0)] {
            let past = motion.between((now.time - length).max(0.0), now.time, MOST_POINTS).map(data);
            plot.draw_line(past.chain([data(now)]), width, palette.masses[0].with_alpha(alpha), out);
        }
        let (x, y) = data(now);
        let contact = now.contacts[number];
        plot.draw_marker(x, y, palette.contact(contact), out);
        out.push(OverlayItem::Text {
            position: plot.area().max - Vec2::new(4.0, 6.0) * plot.scale,
            anchor: Anchor::Right,
            size: 12.0 * plot.scale,
            colour: palette.contact(contact),
            bold: true,
            text: if contact.is_stick() { "stick" } else { "slip" }.to_owned(),
        });
    }
}
