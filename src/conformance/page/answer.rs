//! What the report says in a few sentences, and what its words mean.

use crate::conformance::{Advice, Configuration, Fewest, Report, Row, Verdict};

/// The sentences at the top.
pub(super) fn answer(report: &Report) -> Vec<String> {
    let tally = &report.tally;
    let mut said = vec![use_this(report)];
    said.extend(defaults(report));
    let broken = if tally.failed == 0 {
        ""
    } else {
        "Those that do not are listed first: look at them before you believe the rest. "
    };
    said.push(format!(
        "{} numbers behave as the theory of their configuration predicts, {} do not, {} were not run. {broken}\
         Of the numbers that have a counterpart in the equations of motion, {} are right to 1 % and {} are wrong: a row can be exactly as \
         predicted and physically wrong.",
        tally.passed, tally.failed, tally.not_run, tally.right, tally.wrong
    ));
    said
}

fn use_this(report: &Report) -> String {
    let steps = |advice: &Advice| match (advice.all, advice.amplitude, advice.frequency) {
        (Fewest::Steps(steps), ..) => Some((steps, "amplitude, frequency and Hopf point")),
        (Fewest::NotRun, Fewest::Steps(a), Fewest::Steps(b)) => {
            Some((a.max(b), "amplitude and frequency (the Hopf point was not run)"))
        }
        _ => None,
    };
    let best = report.advice.iter().filter_map(|advice| Some((steps(advice)?, advice))).min_by_key(
        |((steps, what), advice)| {
            // Of equally coarse steps the one with fewer substeps, then the simplest words: no timing decides, so that the sentence repeats.
            (what.len(), *steps, advice.configuration.substeps, advice.configuration)
        },
    );
    match best {
        Some(((steps, what), advice)) => format!(
            "Use {} with at least {steps} steps per period: the coarsest step tried that has {what} of the limit cycle within 1 %, \
             together with all finer ones.",
            advice.configuration.label()
        ),
        None => "No configuration that was run has amplitude and frequency of the limit cycle within 1 %.".to_owned(),
    }
}

/// What the engine's own defaults do to a linear oscillator.
fn defaults(report: &Report) -> Option<String> {
    let wanted = |row: &&Row| {
        row.quantity == "numerical_damping"
            && row.configuration == Configuration::ENGINE_DEFAULTS
            && row.steps_per_period == Some(377)
    };
    let row = report.rows.iter().find(wanted)?;
    let (found, formula) = (row.found?, row.expected?);
    let as_predicted = if row.verdict == Verdict::Passed {
        "as its formula predicts"
    } else {
        "which is not what its formula predicts"
    };
    Some(format!(
        "Rapier's defaults (dt = 1/60, 4 substeps, force law evaluated once a step) give an undamped oscillator of frequency 1 the numerical \
         damping {found:.5} ({formula:.5} by formula), {as_predicted} and physically wrong: energy is pumped in, {:.0} % of the two-mass rig's \
         damping ξ₂ = 0.011.",
        100.0 * found.abs() / 0.011
    ))
}

/// What the two judgements mean.
pub(super) const HOW_TO_READ: [&str; 4] = [
    "As predicted: the number found in the engine is what the theory of this configuration predicts, within the stated tolerance: the difference \
     equation that Rapier's step is on paper (worked out by a second program that shares no code with the engine side), a closed formula, or, where \
     there is neither, the exact solution with the error bound of the scheme. Only this decides the exit status.",
    "Physics: the number is what the equations of motion say, to 1 % (the limit is in each row of report.json). Wrong physics that is \
     predicted is a property of the configuration; choose another one.",
    "Order: errors over a ladder of steps. The second-order recipe must show order 2 within 0.1 (0.2 where single events scatter) down to \
     the floor of rounding; other configurations the order of their difference equation over the same steps.",
    "Not run: nobody computed it in this run, too few errors lie above the floor to show an order, or the motion is chaotic and nothing predicts \
     the number. It counts neither as passed nor as failed.",
];

/// The words about multibody joints.
pub(super) const MULTIBODY: &str = "Multibody joints are second order too, if the right velocity is read. The velocity of a multibody body \
     (RigidBody::linvel) is the one before the last substep; a force law that reads it sees every velocity one substep late and becomes first order \
     (measured over ten periods at 4096 steps: 5.4e-3 instead of 5.5e-6). All rows here read Multibody::generalized_velocity, which is current.";

/// The words about the recipe.
pub(super) const RECIPE: &str = "The second-order recipe: one substep; forces evaluated at the positions x_n; velocities started half a step back, \
     v(-1/2) = v(0) - (h/2) a(0); and the velocity in damping laws predicted to the same instant, v(n) = v(n-1/2) + (h/2) a(n-1). It is what \
     “half-step start, predicted velocity” means below; “late velocity” leaves the prediction out, “face value” takes the engine's \
     velocity for the velocity, as a plain user does.";

/// Formulae of numerical damping and frequency shift.
pub(super) const FORMULA: &str = "A force evaluated once a step and held over n substeps gives an undamped oscillator of frequency ω the damping \
     ξ = -ω² h (1 - (n + 1)/(2 n)) (x'' + ξ x' + ω² x = 0): none for one substep, up to -ω² h/2 for many. Its frequency shifts by \
     ω (ωh)² (1/24 - c e/4 - 3e²/8) with c = (n + 1)/(2n), e = 1 - c. The velocity scheme has no influence on either without damping.";
