//! The picture of an amplitude diagram.

use crate::chaos::{DiagramRow, MotionClass};
use crate::report::{Chart, Series, Style, Tint};

/// Largest and smallest amplitude over xi1, coloured by the kind of motion (Fig. 5).
pub fn chart(rows: &[DiagramRow]) -> Chart {
    let classes = [
        ("equilibrium", MotionClass::Equilibrium, Tint::Grey),
        ("limit cycle", MotionClass::LimitCycle, Tint::Green),
        ("torus", MotionClass::Torus, Tint::Blue),
        ("chaos", MotionClass::Chaos, Tint::Vermillion),
        ("neutral", MotionClass::Neutral, Tint::Purple),
        ("not settled", MotionClass::NotSettled, Tint::Orange),
    ];
    let series = classes.into_iter().filter_map(|(label, class, tint)| {
        let of_class = rows.iter().filter(|row| row.outcome == class);
        let points: Vec<_> =
            of_class.flat_map(|row| [row.a1_max, row.a1_min].into_iter().flatten().map(|a1| (row.value, a1))).collect();
        (!points.is_empty()).then(|| Series { label: label.to_owned(), points, style: Style::Dots, tint })
    });
    Chart {
        title: "Largest and smallest amplitude of mass 1".to_owned(),
        x_label: "ξ₁".to_owned(),
        y_label: "a₁, max and min".to_owned(),
        series: series.collect(),
    }
}
