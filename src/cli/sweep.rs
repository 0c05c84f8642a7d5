//! A motion whose self-excitation is swept: pieces of constant xi1, each beginning in the state in which the one before ended, joined into one
//! motion. Times are those of the samples of the whole, `n * interval`; works add up.

use super::motions;
use crate::dynamics::{Outcome, Sampling, State, Trajectory};
use crate::engine::Recording;
use crate::model::{EnergyLedger, RigParameters, Works};
use crate::scene::{Case, Ramp};
use anyhow::Context;

/// The pieces: number of the first sample, samples in the piece, and its case.
fn pieces(case: &Case, ramp: Ramp, sampling: Sampling) -> Vec<(u64, u64, Case)> {
    let all = (sampling.t_end / sampling.interval - 1e-6).ceil().max(1.0) as u64;
    let each = (ramp.hold / sampling.interval).round().max(1.0) as u64;
    (0..all.div_ceil(each))
        .map(|number| {
            let first = number * each;
            // In the middle of a step, where rounding of its ends does not matter.
            let xi1 = case.excitation().at((first as f64 + 0.5 * each as f64) * sampling.interval);
            let parameters = RigParameters { xi1, ..case.parameters };
            (first, each.min(all - first), Case { parameters, ramp: None, ..case.clone() })
        })
        .collect()
}

/// Joins what `run` makes of the pieces.
fn joined(
    case: &Case,
    ramp: Ramp,
    (start, sampling): (&State, Sampling),
    run: impl Fn(&Case, &State, Sampling) -> anyhow::Result<Recording>,
) -> anyhow::Result<Recording> {
    let mut whole: Option<Recording> = None;
    let mut state = start.clone();
    for (first, count, piece) in pieces(case, ramp, sampling) {
        let time = first as f64 * sampling.interval;
        let t_end = (sampling.t_end - time).min(count as f64 * sampling.interval);
        let next = run(&piece, &state, Sampling { interval: sampling.interval, t_end })?;
        state = next.trajectory.last().context("a piece of the sweep is empty")?.state.clone();
        let diverged = next.trajectory.diverged();
        whole = Some(match whole {
            None => next,
            Some(whole) => append(whole, next, (first, time), sampling),
        });
        if diverged {
            break;
        }
    }
    whole.context("the sweep has no pieces")
}

fn append(mut whole: Recording, next: Recording, (first, start): (u64, f64), sampling: Sampling) -> Recording {
    let base = whole.trajectory.last().map_or(EnergyLedger::default(), |sample| sample.ledger);
    // The first sample is the last one of the piece before; only its contact may be another.
    for (number, mut sample) in next.trajectory.samples.into_iter().enumerate().skip(1) {
        let interval = sampling.interval;
        let is_near = |a: f64, b: f64| (a - b).abs() < 1e-6 * interval;
        sample.time = match (first + number as u64) as f64 * interval {
            end if is_near(end, sampling.t_end) => sampling.t_end,
            on_grid if is_near(sample.time, number as f64 * interval) => on_grid,
            _ => start + sample.time,
        };
        sample.ledger = EnergyLedger {
            stored: sample.ledger.stored,
            stored_at_start: base.stored_at_start,
            works: sum(base.works, sample.ledger.works),
        };
        whole.trajectory.samples.push(sample);
    }
    whole.poses.extend(next.poses.into_iter().skip(1));
    whole.trajectory.events.extend(next.trajectory.events.into_iter().map(|mut event| {
        event.time += start;
        event
    }));
    whole.trajectory.outcome = match next.trajectory.outcome {
        Outcome::Diverged { time, bound } => Outcome::Diverged { time: start + time, bound },
        Outcome::Completed => Outcome::Completed,
    };
    whole.drift.lateral = whole.drift.lateral.max(next.drift.lateral);
    whole.drift.rotation = whole.drift.rotation.max(next.drift.rotation);
    whole.steps += next.steps;
    whole
}

fn sum(mut a: Works, b: Works) -> Works {
    a += b;
    a
}

/// The swept motion in Rapier: a new world for each piece.
pub fn in_engine(case: &Case, ramp: Ramp, start: &State, sampling: Sampling) -> anyhow::Result<Recording> {
    joined(case, ramp, (start, sampling), motions::in_engine)
}

/// The exact swept motion.
pub fn exactly(case: &Case, ramp: Ramp, start: &State, sampling: Sampling) -> anyhow::Result<Trajectory> {
    let run = |case: &Case, start: &State, sampling| {
        let trajectory = motions::exactly(case, start, sampling)?;
        Ok(Recording { trajectory, poses: Vec::new(), drift: Default::default(), steps: 0 })
    };
    Ok(joined(case, ramp, (start, sampling), run)?.trajectory)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn case(ramp: &str) -> Case {
        let text = format!(
            "title = \"x\"\n[rig]\nxi1 = -0.05\n[initial]\nstart = \"state\"\nstate = [1.2, 0.9, 0.0, -0.5, 1.0]\n\
             [simulation]\nduration = 40.0\n{ramp}"
        );
        Scene::parse(&text, "test").unwrap().1
    }

    /// A ramp to the value it starts from is no ramp: joined pieces are the motion in one piece.
    #[test]
    fn pieces_of_one_value_are_the_motion_in_one_piece() {
        let (plain, flat) = (case(""), case("[ramp]\nxi1_end = -0.05\nhold = 1.7\n"));
        let (start, sampling) = (motions::start(&plain).unwrap(), motions::film_sampling(&flat));
        let whole = motions::in_engine(&plain, &start, sampling).unwrap();
        let pieces = motions::in_engine(&flat, &start, sampling).unwrap();
        let exact = motions::exactly(&plain, &start, sampling).unwrap();
        let exact_pieces = motions::exactly(&flat, &start, sampling).unwrap();
        assert_eq!(exact_pieces.samples.len(), exact.samples.len());
        assert_eq!(pieces.poses.len(), whole.poses.len());
        for (a, b) in exact_pieces.samples.iter().zip(&exact.samples) {
            assert_eq!(a.time, b.time);
            // The closed form restarted 24 times; its error is 1e-13 a restart, and the motion hardly spreads in 40 time units.
            assert!(a.state.max_difference(&b.state) < 1e-10);
            assert!(a.ledger.residual().abs() < 1e-10);
        }
        for (a, b) in pieces.trajectory.samples.iter().zip(&whole.trajectory.samples) {
            // Each start of the engine costs about h^3, h = 1.5e-3, and there are 24.
            assert!(a.state.max_difference(&b.state) < 1e-6, "{}", a.state.max_difference(&b.state));
        }
    }

    #[test]
    fn engine_and_exact_solution_agree_on_a_sweep_and_not_on_none() {
        let (plain, sweep) = (case(""), case("[ramp]\nxi1_end = -0.15\n"));
        let (start, sampling) = (motions::start(&plain).unwrap(), motions::film_sampling(&sweep));
        let engine = motions::in_engine(&sweep, &start, sampling).unwrap().trajectory;
        let exact = motions::exactly(&sweep, &start, sampling).unwrap();
        let distance = |a: &Trajectory, b: &Trajectory| {
            a.samples.iter().zip(&b.samples).map(|(a, b)| a.state.max_difference(&b.state)).fold(0.0, f64::max)
        };
        // Second order with steps of 1.5e-3: measured 3e-5 on the torus over 160 time units.
        assert!(distance(&engine, &exact) < 1e-4, "{}", distance(&engine, &exact));
        // Negative control: the motion without sweep is another.
        assert!(distance(&motions::exactly(&plain, &start, sampling).unwrap(), &exact) > 0.1);
        assert!(exact.samples.iter().all(|sample| sample.ledger.residual().abs() < 1e-10));
    }
}
