//! The tables that answer: which steps are enough, what they cost, and how neighbouring configurations do at the same step.

use super::tables::{Entry, Grid, number, physics, rough, text, verdict};
use crate::conformance::experiment::is_notable;
use crate::conformance::{Advice, Configuration, Fewest, HOPF_QUANTITY, HOPF_WORST, Physics, Report, Row};

fn fewest(fewest: Fewest) -> Entry {
    match fewest {
        Fewest::Steps(steps) => Entry { text: steps.to_string(), key: Some(f64::from(steps)) },
        Fewest::AtMost(steps) => Entry { text: format!("≤ {steps}"), key: Some(f64::from(steps)) },
        Fewest::Never => Entry { text: "none of those run".to_owned(), key: Some(1e8) },
        Fewest::NotRun => Entry { text: "not run".to_owned(), key: Some(1e9) },
    }
}

/// Fewest steps per period for 1 %, and what an oscillation then costs.
pub(super) fn fewest_steps(report: &Report) -> Grid {
    let row = |advice: &Advice| {
        let Advice { configuration, amplitude, frequency, hopf, all, motion } = *advice;
        let per_step = report.cost(configuration);
        let per_oscillation = all.enough().zip(per_step).map(|(steps, cost)| f64::from(steps) * cost);
        vec![
            text(configuration.label()),
            fewest(amplitude),
            fewest(frequency),
            fewest(hopf),
            fewest(all),
            fewest(motion),
            rough(per_step),
            rough(per_oscillation),
        ]
    };
    Grid {
        headings: vec![
            "configuration",
            "amplitude",
            "frequency",
            "Hopf point",
            "all three",
            "motion over ten periods",
            "µs/step",
            "µs/oscillation",
        ],
        rows: report.advice.iter().map(row).collect(),
    }
}

/// Under the table.
pub(super) const FEWEST_CAPTION: &str = "Steps per period from which on every step that was run is within 1 %. “≤” marks the coarsest step that was tried: fewer may do. \
     Amplitude: mean maximum of the settled limit cycle, and no torus in its place. Hopf point: at the worst phase of the steps. \
     Motion: the state itself, ten periods beside the cycle. µs/oscillation is µs/step times the steps for all three, and “–” unless all three are known. \
     One thread, two bodies on two joints.";

/// Columns of the comparison: heading, scenario, start of the variant, quantity.
const COMPARED: [(&str, &str, &str, &str); 6] = [
    ("motion over ten periods", "limit_cycle", "ten periods", "state_error"),
    ("times of stick and slip", "limit_cycle", "ten periods", "switching_time"),
    ("damping, ratio 0.1", "linear_oscillator", "damping ratio 0.1", "damping"),
    ("amplitude", "limit_cycle", "settled", "amplitude"),
    ("torus in place of the cycle", "limit_cycle", "settled", "spread_of_maxima"),
    ("Hopf point, worst phase", "secondary_hopf", "", HOPF_WORST),
];

/// Errors of the configurations that tell most at one and the same step.
pub(super) fn comparison(report: &Report, steps: u32) -> Grid {
    let row = |configuration: Configuration| {
        let cell = |(_, scenario, variant, quantity): &(&str, &str, &str, &str)| {
            // Averaging changes nothing where nothing rubs, and is not run there.
            let stand_in = *scenario == "linear_oscillator" && configuration == Configuration::AVERAGED_FRICTION;
            let tried = if stand_in { Configuration::SAMPLED_FRICTION } else { configuration };
            let found = report.rows.iter().find(|row| {
                row.configuration == tried
                    && row.scenario == *scenario
                    && row.variant.starts_with(variant)
                    && row.quantity == *quantity
                    && row.steps_per_period == Some(steps)
            });
            error_in_percent(found)
        };
        std::iter::once(text(configuration.short_name())).chain(COMPARED.iter().map(cell)).collect()
    };
    let configurations = report.advice.iter().map(|advice| advice.configuration).filter(|c| is_notable(*c));
    Grid {
        headings: std::iter::once("configuration").chain(COMPARED.iter().map(|column| column.0)).collect(),
        rows: configurations.map(row).collect(),
    }
}

/// Deviation in hundredths of what counts as the whole: the limit of each row is 1 % of it.
fn error_in_percent(row: Option<&Row>) -> Entry {
    let error = row.and_then(|row| Some((row.deviation? / row.limit.filter(|limit| *limit > 0.0)?, row.physics)));
    let Some((percent, judged)) = error else { return number(None) };
    let entry = rough(Some(percent));
    let wrong = if judged == Physics::Wrong { " (wrong)" } else { "" };
    Entry { text: format!("{} %{wrong}", entry.text), key: entry.key }
}

/// The engine's secondary Hopf point, its worst phase first.
pub(super) fn hopf(report: &Report) -> Grid {
    let worst: Vec<&Row> =
        report.rows.iter().filter(|row| row.quantity == HOPF_WORST && is_notable(row.configuration)).collect();
    let row = |row: &&Row| {
        let beside = |quantity: &str| {
            let same = |other: &&Row| {
                other.quantity == quantity
                    && other.configuration == row.configuration
                    && other.variant == row.variant
                    && other.steps_per_period == row.steps_per_period
            };
            report.rows.iter().find(same)
        };
        let mean = beside(HOPF_QUANTITY);
        let steps = row.steps_per_period.map(f64::from);
        let scaled = row.found.zip(steps).map(|(error, n)| error * n * n);
        vec![
            text(row.configuration.label()),
            Entry { text: steps.map_or("–".to_owned(), |n| format!("{n:.0}")), key: steps },
            rough(row.found),
            text(row.variant.clone()),
            number(mean.and_then(|row| row.found)),
            rough(beside("secondary_hopf_spread").and_then(|row| row.found)),
            rough(scaled),
            verdict(row.verdict),
            physics(row.physics),
        ]
    };
    Grid {
        headings: vec![
            "configuration",
            "steps/period",
            "error of the worst phase",
            "over",
            "mean ξ₁",
            "spread over the phases",
            "worst error × n²",
            "as predicted",
            "physics",
        ],
        rows: worst.iter().map(row).collect(),
    }
}
