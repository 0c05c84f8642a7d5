//! Simple drawings of the rig and the Jenkins element (Fig. 2 a, b).

use crate::report::{Mark, Panel, Series, Side, Style, Tint};

type Points = Vec<(f64, f64)>;

fn stroke(panel: Panel, points: Points) -> Panel {
    panel.series(Series::new("", points, Style::Line, Tint::Black))
}

/// A zigzag between two points on a horizontal line.
fn spring(panel: Panel, from: f64, to: f64, y: f64) -> Panel {
    let (lead, teeth) = (0.2 * (to - from), 6);
    let mut points = vec![(from, y), (from + lead, y)];
    let width = (to - from - 2.0 * lead) / f64::from(teeth);
    points.extend((0..teeth).map(|n| {
        let up = if n % 2 == 0 { 0.16 } else { -0.16 };
        (from + lead + (f64::from(n) + 0.5) * width, y + up)
    }));
    points.extend([(to - lead, y), (to, y)]);
    stroke(panel, points)
}

/// Pot and piston.
fn damper(panel: Panel, from: f64, to: f64, y: f64) -> Panel {
    let (a, b) = (from + 0.4 * (to - from), from + 0.6 * (to - from));
    let panel = stroke(panel, vec![(from, y), (a, y), (a, y + 0.17), (b, y + 0.17)]);
    let panel = stroke(panel, vec![(a, y), (a, y - 0.17), (b, y - 0.17)]);
    let middle = 0.5 * (a + b);
    stroke(stroke(panel, vec![(middle, y + 0.11), (middle, y - 0.11)]), vec![(middle, y), (to, y)])
}

fn wall(panel: Panel, x: f64, [low, high]: [f64; 2], outwards: f64) -> Panel {
    let mut panel = stroke(panel, vec![(x, low), (x, high)]);
    let mut y = low;
    while y < high {
        panel = stroke(panel, vec![(x, y + 0.15), (x + 0.15 * outwards, y)]);
        y += 0.25;
    }
    panel
}

fn mass(panel: Panel, x: f64, label: &str) -> Panel {
    let outline = vec![(x, -1.0), (x + 1.0, -1.0), (x + 1.0, 1.0), (x, 1.0)];
    let mut edge = outline.clone();
    edge.push(outline[0]);
    let shade = Mark::Region { label: String::new(), outline, tint: Tint::Sky };
    stroke(panel.with(shade), edge).text((x + 0.5, 0.0), label, Side::Centre)
}

/// Spring and slider in series.
fn jenkins(panel: Panel, from: f64, to: f64, y: f64) -> Panel {
    let contact = from + 0.32 * (to - from);
    let panel = stroke(panel, vec![(from, y), (contact, y)]);
    // Two surfaces pressed onto each other.
    let panel = stroke(panel, vec![(contact - 0.25, y - 0.04), (contact + 0.25, y - 0.04)]);
    let panel = stroke(panel, vec![(contact - 0.25, y + 0.06), (contact + 0.25, y + 0.06), (contact + 0.25, y)]);
    spring(panel, contact + 0.25, to, y)
}

/// Fig. 2 a.
pub(super) fn rig() -> Panel {
    let panel = Panel::new("", "").titled("(a) rig").bare().equal_aspect().x_range(-3.2, 6.2).y_range(-2.2, 2.0);
    let panel = wall(wall(panel, -2.9, [-1.1, 1.1], -1.0), 5.9, [-1.1, 1.1], 1.0);
    let panel = mass(mass(panel, -0.5, "1"), 2.5, "1");
    let panel = spring(jenkins(panel, -2.9, -0.5, 0.7), -2.9, -0.5, 0.0);
    let panel = damper(panel, -2.9, -0.5, -0.7);
    let panel = damper(spring(panel, 0.5, 2.5, 0.4), 0.5, 2.5, -0.5);
    let panel = damper(spring(panel, 3.5, 5.9, 0.4), 3.5, 5.9, -0.5);
    let panel = panel
        .text((-1.4, 1.05), "γ", Side::Centre)
        .text((-1.7, 0.3), "1 − γ", Side::Centre)
        .text((1.5, 0.78), "κ", Side::Centre)
        .text((4.7, 0.78), "1", Side::Centre)
        .text((-1.7, -1.15), "ξ₁", Side::Centre)
        .text((1.5, -0.95), "(ξ₂ − ξ₁)/2", Side::Centre)
        .text((4.7, -0.95), "ξ₁", Side::Centre);
    let coordinate = |panel: Panel, x: f64, name: &str| {
        stroke(panel, vec![(x, -1.35), (x, -1.75)]).arrow((x, -1.55), (x + 0.8, -1.55)).text(
            (x + 0.4, -1.62),
            name,
            Side::Below,
        )
    };
    coordinate(coordinate(panel, 0.0, "x₁"), 3.0, "x₂")
}

/// Fig. 2 b.
pub(super) fn jenkins_element() -> Panel {
    let panel =
        Panel::new("", "").titled("(b) Jenkins element").bare().equal_aspect().x_range(-3.4, 0.9).y_range(-1.4, 1.2);
    let panel = wall(panel, -3.0, [-0.7, 0.7], -1.0);
    jenkins(panel, -3.0, 0.0, 0.0)
        .text((-2.05, -0.28), "holds |γ f| ≤ γ", Side::Centre)
        .text((-0.85, 0.36), "γ", Side::Centre)
        .arrow((0.05, 0.0), (0.6, 0.0))
        .text((0.3, 0.28), "x₁, γ f", Side::Centre)
}
