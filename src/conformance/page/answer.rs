//! What the report says in a few sentences, and what its words mean.

use crate::conformance::{Advice, Configuration, Fewest, Report, Row, Verdict};

/// The sentences at the top.
pub(super) fn answer(report: &Report) -> Vec<String> {
    let mut said = vec![use_this(report)];
    said.extend(defaults(report));
    said.push(counted(report));
    said
}

fn counted(report: &Report) -> String {
    let tally = &report.tally;
    let broken = if tally.failed == 0 {
        ""
    } else {
        "Those that do not are listed below the first table: look at them before you believe the rest. "
    };
    format!(
        "{} numbers behave as the theory of their configuration predicts, {} do not, {} were not run or are not resolved. {broken}\
         Of the numbers that have a counterpart in the equations of motion, {} are right to 1 % and {} are wrong: a row can be exactly as \
         predicted and physically wrong.",
        tally.passed, tally.failed, tally.not_run, tally.right, tally.wrong
    )
}

/// The configuration to use, and its steps per period: the one with all three right at the fewest, then with the motion right at the fewest.
fn best(report: &Report) -> Option<(&Advice, u32)> {
    let known = report.advice.iter().filter_map(|advice| Some((advice, advice.all.enough()?)));
    // No timing decides, so that the sentence repeats.
    known.min_by_key(|(advice, steps)| {
        let motion = advice.motion.enough().unwrap_or(u32::MAX);
        let default_first = advice.configuration != Configuration::AVERAGED_FRICTION;
        (*steps, motion, default_first, advice.configuration.substeps, advice.configuration)
    })
}

/// Steps per period at which the best configuration has everything right, the motion too.
pub(super) fn steps_for_all(report: &Report) -> Option<u32> {
    best(report).map(|(advice, steps)| steps.max(advice.motion.enough().unwrap_or(steps)))
}

fn use_this(report: &Report) -> String {
    let Some((advice, steps)) = best(report) else {
        return "In no configuration that was run are amplitude, frequency and Hopf point all known to be within 1 %."
            .to_owned();
    };
    let coarsest = match advice.all {
        Fewest::AtMost(_) => format!(" {steps} is the coarsest step at which all three were tried: fewer may do."),
        _ => String::new(),
    };
    let motion = match advice.motion.enough() {
        Some(motion) if motion <= steps => ", and so is the motion itself over ten periods".to_owned(),
        Some(motion) => format!("; the motion itself over ten periods takes {motion}"),
        None => "; the motion itself over ten periods was not right at any step run".to_owned(),
    };
    format!(
        "Trust Rapier with force laws of your own ({}) at {steps} or more steps per oscillation, dt ≤ 1/({steps} f) at f Hz: amplitude, frequency and Hopf point of the \
         limit cycle are then within 1 %{motion}.{coarsest}",
        advice.configuration.label()
    )
}

/// What the engine's own defaults do to a linear oscillator, and whether any step helps.
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
    let steps = report.advice.iter().find(|advice| advice.configuration == Configuration::ENGINE_DEFAULTS);
    let never = match steps.map(|advice| advice.amplitude) {
        Some(Fewest::Never) => {
            " At no step that was run is the amplitude of the limit cycle right with them.".to_owned()
        }
        Some(Fewest::Steps(n) | Fewest::AtMost(n)) => {
            format!(" The amplitude of the limit cycle is right with them from {n} steps per period on.")
        }
        _ => String::new(),
    };
    let hopf = report.rows.iter().find(|row| row.quantity == "secondary_hopf_xi1_at_default_step");
    let hopf = hopf.and_then(|row| Some((row.found?, row.exact?))).map_or(String::new(), |(found, exact)| {
        format!(" In f64 the limit cycle loses stability at ξ₁ = {found:.5} in place of {exact:.5} with them.")
    });
    Some(format!(
        "Do not trust its defaults (f32, 4 substeps, force law evaluated once a step): at dt = 1/60 they give an undamped oscillator of frequency 1 the numerical \
         damping {found:.5} ({formula:.5} by formula), {as_predicted} and physically wrong: energy is pumped in, {:.0} % of the two-mass rig's \
         damping ξ₂ = 0.011.{never}{hopf}",
        100.0 * found.abs() / 0.011
    ))
}

/// What a step is in time.
pub(super) const STEPS: &str = "Steps are counted per oscillation, because only their ratio matters. In the rig's unit of time its angular frequency is about 1 and a period about 2π: there \
     dt = 1/60 is 377 steps per period. In a game that runs at 60 steps a second an oscillation of f Hz gets 60/f steps: 64 of them only below 0.94 Hz, 256 below 0.23 Hz, and \
     at 5 Hz no more than 12. Oscillations of 5 Hz need dt = 1/320 s for 64 steps, 1/1280 s for 256.";

/// What the two judgements mean.
pub(super) const HOW_TO_READ: [&str; 5] = [
    "As predicted: the number found in the engine is what the theory of this configuration predicts, within the stated tolerance: the difference \
     equation that Rapier's step is on paper (a second program, which shares the model description and the orbit solver only with the engine side), a closed \
     formula, or, where there is neither, the exact solution with the error bound of the scheme. Only this decides the exit status.",
    "Tolerance: how far the number may be from the prediction. Where both do the same arithmetic it is a few floors of rounding, unit roundoff × size of the \
     motion × (√(t/h) + t); where the prediction is the exact solution it is the error bound of the scheme. The column “how judged” says which, row by row.",
    "Physics: the number is what the equations of motion say, to 1 % of the quantity, or of the size of the motion where the exact value is zero. Wrong physics that \
     is predicted is a property of the configuration; choose another one.",
    "Order: errors over a ladder of steps. The second-order scheme must show order 2 within 0.1 (0.2 where single events scatter) down to \
     the floor of rounding; other configurations the order of their difference equation over the same steps.",
    "Not run, or not resolved: nobody computed it in this run, nothing predicts the number, its prediction is looser than what counts as right, or too few errors lie \
     above the floor to show an order. It counts neither as passed nor as failed; the reason is in the row.",
];

/// Why the neighbours of the second-order scheme will not do.
pub(super) const WHY: [&str; 4] = [
    "One substep is what matters for amplitude, frequency and Hopf point. A force that is evaluated once a step stands still while the engine moves the bodies \
     substep by substep; that pumps energy in, in proportion to the step. With one substep nothing is pumped in, whatever is done about velocities, and every \
     configuration with one substep has these three right at the same steps.",
    "The half-step start and the predicted velocity are for the motion itself. Rapier's velocities belong to an instant half a step earlier than its positions. Read at face value, \
     or late in a damping law, they make the state and the times of stick and slip wrong in proportion to the step; with both corrections the error falls with its \
     square. On the rig's limit cycle the velocity errors nearly cancel over a period, because its damping is weak: this is why the three numbers above do not show them, and why \
     some may even come out closer to the truth without the corrections at one step. A stronger damper would show them.",
    "What is left of the error of the Hopf point with friction sampled at x_n is a scatter over where within a step the motion reverses: small deviations feel the spring of the friction \
     element for a whole number of steps, not for the time it sticks. It can hide the error of the velocities, or cancel it. Friction averaged over the step has no such scatter.",
    "The choice of joints makes no difference with force laws of one's own, and f32 none until its floor of rounding is reached.",
];

/// Error, where it comes from, and what to do.
pub(super) const FAULTS: [[&str; 4]; 5] = [
    [
        "energy pumped in with 2 or more substeps",
        "engine: user forces are held over all substeps of a step, and there is no call-back between them",
        "-ω² h (1 - (n + 1)/(2n))",
        "one substep, smaller steps",
    ],
    [
        "damping by joint motors, spring joints, multibody springs",
        "engine: they are integrated by backward Euler",
        "+ω² h/n",
        "force laws of one's own, or more substeps",
    ],
    [
        "state off by an amount in proportion to h, at face value",
        "neither: the velocity a semi-implicit step leaves is that of half a step earlier, and is easily misread",
        "h a/2 in every velocity",
        "half-step start; read v + (h/2) a",
    ],
    [
        "damping law sees velocities half a step late",
        "the force law, not the engine",
        "h a/2 in the damper's velocity",
        "predict the velocity",
    ],
    [
        "what remains in the second-order scheme",
        "the scheme: leapfrog, friction by increments",
        "of order h²",
        "smaller steps",
    ],
];

/// The words about multibody joints.
pub(super) const MULTIBODY: &str = "Multibody joints are second order too, if the right velocity is read. The velocity of a multibody body \
     (RigidBody::linvel) is the one before the last substep; a force law that reads it sees every velocity one substep late and becomes first order \
     (measured over ten periods at 4096 steps: 5.4e-3 instead of 5.5e-6). All rows here read Multibody::generalized_velocity, which is current.";

/// The words about the second-order scheme.
pub(super) const SCHEME: &str = "The second-order scheme: one substep (num_solver_iterations = 1); forces evaluated at the positions x_n; velocities started half a step back, \
     v(-1/2) = v(0) - (h/2) a(0); and the velocity in damping laws predicted to the same instant, v(n) = v(n-1/2) + (h/2) a(n-1). It is what \
     “half-step start, predicted velocity” means here; “friction averaged”, the default, takes the mean of the friction force from t_n - h/2 to t_n + h/2 along the elongation w s + a(n-1) s²/2, w the engine's velocity, from the slider force carried to t_n - h/2, \
     which is then carried on with a(n) in place of a(n-1); “friction sampled” takes its value at x_n (where nothing rubs both are the same, and rows say “friction sampled”); “late velocity” leaves the prediction out, “face value” takes the engine's \
     velocity for the velocity, as a plain user does.";

/// Formulae of numerical damping and frequency shift.
pub(super) const FORMULA: &str = "A force evaluated once a step and held over n substeps gives an undamped oscillator of frequency ω the damping \
     ξ = -ω² h (1 - (n + 1)/(2 n)) (x'' + ξ x' + ω² x = 0): none for one substep, up to -ω² h/2 for many. Its frequency shifts by \
     ω (ωh)² (1/24 - c e/4 - 3e²/8) with c = (n + 1)/(2n), e = 1 - c. The velocity scheme has no influence on either without damping.";

/// Where the formulae come from, in a line.
pub(super) const DERIVATION: &str = "Derivation: n substeps of h/n under the constant acceleration a move x by h v + c h² a, not by h v + h² a as in one step of the leapfrog. With a = -ω² x the map of \
     one step has the determinant 1 - (c - 1) ω²h², that is 1 + e ω²h², and ξ = -ln(determinant)/h.";
