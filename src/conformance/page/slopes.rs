//! Where slope triangles go: under a curve whose slope they have, where they touch no other.

use super::charts::Curve;
use crate::report::Mark;

/// Width of a triangle in decades of the step.
const WIDTH: f64 = 0.35;
/// Distance of its slope from the curve, and room for its letters, in parts of the picture's height and width.
const GAP: f64 = 0.04;
const LETTERS: f64 = 0.08;
/// A curve has the order of a triangle if its slope, over the width of the triangle, is that near.
const ALIKE: f64 = 0.15;
const ORDERS: [f64; 2] = [2.0, 1.0];

/// A triangle for each order that a curve shows, clear of curves and floors; none where there is no room.
pub(super) fn slopes(curves: &[Curve], floors: &[Vec<(f64, f64)>]) -> Vec<Mark> {
    let curves: Vec<Vec<(f64, f64)>> = curves.iter().map(|curve| logarithms(&curve.points)).collect();
    let all: Vec<Vec<(f64, f64)>> =
        curves.iter().cloned().chain(floors.iter().map(|floor| logarithms(floor))).collect();
    let mut placed: Vec<Place> = Vec::new();
    for order in ORDERS {
        let found = curves.iter().flat_map(|curve| places(curve, order, &all));
        if let Some(place) = found.into_iter().find(|place| placed.iter().all(|other| place.apart_from(other))) {
            placed.push(place);
        }
    }
    placed.iter().map(Place::mark).collect()
}

fn logarithms(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut found: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.log10(), y.log10())).collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

/// The box a triangle takes with its letters, and its lower left corner; all in decades.
struct Place {
    corner: (f64, f64),
    order: f64,
    x: (f64, f64),
    y: (f64, f64),
}

impl Place {
    fn mark(&self) -> Mark {
        let at = (10_f64.powf(self.corner.0), 10_f64.powf(self.corner.1));
        Mark::Slope { at, order: self.order, decades: WIDTH }
    }

    fn apart_from(&self, other: &Self) -> bool {
        self.x.1 < other.x.0 || other.x.1 < self.x.0 || self.y.1 < other.y.0 || other.y.1 < self.y.0
    }

    /// Whether a curve runs through the triangle or its letters, or nearer than `gap` above its slope.
    fn is_crossed_by(&self, curve: &[(f64, f64)], gap: f64) -> bool {
        (0..=20).any(|n| {
            let x = self.x.0 + (self.x.1 - self.x.0) * f64::from(n) / 20.0;
            let slope = self.corner.1 + self.order * (x - self.x.0).min(WIDTH);
            height(curve, x).is_some_and(|y| (self.y.0..=slope + gap).contains(&y))
        })
    }
}

/// Free places under a curve, from coarse to fine steps.
fn places(curve: &[(f64, f64)], order: f64, curves: &[Vec<(f64, f64)>]) -> Vec<Place> {
    let all = || curves.iter().flatten();
    let range = |pick: fn(&(f64, f64)) -> f64| {
        let values = || all().map(pick);
        (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max))
    };
    let (x, y) = (range(|p| p.0), range(|p| p.1));
    let (wide, tall) = (x.1 - x.0, y.1 - y.0);
    let starts =
        (0..20).map(|n| x.1 - WIDTH - LETTERS * wide - 0.05 * wide * f64::from(n)).take_while(|start| *start > x.0);
    starts
        .filter_map(|start| {
            let base = base(curve, start, order)?;
            let low = base - GAP * tall;
            let place = Place {
                corner: (start, low),
                order,
                x: (start, start + WIDTH + LETTERS * wide),
                y: (low - LETTERS * tall, low + order * WIDTH),
            };
            let free = place.y.0 >= y.0 - 0.02 * tall
                && !curves.iter().filter(|other| *other != curve).any(|other| place.is_crossed_by(other, GAP * tall));
            free.then_some(place)
        })
        .collect()
}

/// Height at `start` of the highest line of the triangle's slope that stays under the curve; none where the curve is not straight and of that
/// slope.
fn base(curve: &[(f64, f64)], start: f64, order: f64) -> Option<f64> {
    let above = |n: u32| {
        let x = WIDTH * f64::from(n) / 10.0;
        height(curve, start + x).map(|y| y - order * x)
    };
    let heights = (0..=10).map(above).collect::<Option<Vec<f64>>>()?;
    let (low, high) = (
        heights.iter().copied().fold(f64::INFINITY, f64::min),
        heights.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    );
    (high - low <= ALIKE * WIDTH).then_some(low)
}

/// The curve at x, between its points.
fn height(curve: &[(f64, f64)], x: f64) -> Option<f64> {
    let pair = curve.windows(2).find(|pair| pair[0].0 <= x && x <= pair[1].0)?;
    let share = (x - pair[0].0) / (pair[1].0 - pair[0].0);
    Some(pair[0].1 + share * (pair[1].1 - pair[0].1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(order: f64, factor: f64) -> Vec<(f64, f64)> {
        [-2.2, -1.9, -1.6, -1.3, -1.0].map(|x| (x, order * x + factor)).to_vec()
    }

    #[test]
    fn a_triangle_lies_under_the_curve_whose_order_it_has() {
        let curves = vec![line(1.0, 0.0), line(2.0, -1.0)];
        let first = &places(&curves[0], 1.0, &curves)[0];
        let top = height(&curves[0], first.corner.0).unwrap();
        assert!(first.corner.1 < top && first.corner.1 > height(&curves[1], first.corner.0).unwrap());
        assert!(places(&curves[1], 1.0, &curves).is_empty(), "its order is 2");
        let bent = vec![vec![(-2.0, -2.0), (-1.5, -1.0), (-1.0, -1.0)]];
        assert!(places(&bent[0], 1.0, &bent).is_empty(), "from end to end of order 1, and nowhere between");
    }

    #[test]
    fn there_is_no_triangle_where_another_curve_is_in_the_way() {
        let free = vec![line(1.0, 0.0), line(1.0, -3.0)];
        assert!(!places(&free[0], 1.0, &free).is_empty());
        let narrow = vec![line(1.0, 0.0), line(1.0, -0.3), line(1.0, -3.0)];
        assert!(places(&narrow[0], 1.0, &narrow).is_empty());
    }
}
