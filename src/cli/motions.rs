//! A case set in motion: by the engine and by the exact solution, from the same start and sampled at the same times.

use super::disk::filmed;
use super::sweep;
use crate::averaging::{EnergyDefinition, EnergyFrequency, Interpolation, RestoredSlowFlow};
use crate::compare::{self, Expectation};
use crate::dynamics::{Flow, Sampling, State, Trajectory};
use crate::engine::{self, EngineFlow, EngineInfo, EngineSettings, Recording};
use crate::exact;
use crate::model::{RigParameters, TwoMassRig};
use crate::orbit::{OrbitError, PeriodicOrbit, limit_cycle};
use crate::scene::{Case, DEFAULT_PERTURBATION, Initial, Joints, MotionKind, Precision, Scheme};
use anyhow::{Context, ensure};
use std::sync::Arc;

/// Longest time between two samples of a filmed motion: lines drawn through them look smooth.
const FINEST: f64 = 0.04;
/// Of the many blades of a disk fewer are kept; positions between them are off by 0.15^4/384, a millionth of the amplitude.
const FINEST_OF_DISKS: f64 = 0.15;
/// Steps a run may take: half an hour at 2 microseconds each.
const MAX_STEPS: f64 = 1e9;

/// The limit cycle of the two-mass rig from the exact flow.
pub fn exact_limit_cycle(parameters: RigParameters) -> Result<PeriodicOrbit, OrbitError> {
    limit_cycle(parameters, |p| Ok(exact::TwoMassFlow::new(&TwoMassRig::new(p)?)))
}

/// The state at time 0.
pub fn start(case: &Case) -> anyhow::Result<State> {
    if let Some(disk) = &case.disk {
        return filmed::initial(disk, case.amplitude_bound);
    }
    if let Some(motion) = case.prescribed {
        let slider_force = match case.initial {
            Initial::State { state } => state[4],
            Initial::LimitCycle { .. } => 0.0,
        };
        return Ok(State::two_mass([0.0, 0.0, motion.velocity(0.0), 0.0, slider_force]));
    }
    match case.initial {
        Initial::State { state } => Ok(State::two_mass(state)),
        Initial::LimitCycle { perturbation } => {
            let orbit = exact_limit_cycle(case.parameters)
                .context("the motion was to start on the limit cycle; give an initial state instead (--initial, or [initial] in the scene)")?;
            let mut state = orbit.reversal();
            state.positions[1] += perturbation.unwrap_or(DEFAULT_PERTURBATION);
            Ok(state)
        }
    }
}

/// Sampling of a filmed motion: a whole number of samples per frame, or per step of a sweep.
pub fn film_sampling(case: &Case) -> Sampling {
    let whole = case.ramp.map_or(case.frame_interval(), |ramp| ramp.hold);
    let finest = if case.disk.is_some() { FINEST_OF_DISKS } else { FINEST };
    Sampling { interval: whole / (whole / finest).ceil(), t_end: case.duration }
}

/// Which build of the engine a case asks for.
pub fn precision(case: &Case) -> engine::Precision {
    match case.engine.precision {
        Precision::F32 => engine::Precision::Single,
        Precision::F64 => engine::Precision::Double,
    }
}

/// Engine settings of a case. Where the scene leaves the step free it divides the sampling interval, so that no sample needs
/// interpolation.
pub fn engine_settings(case: &Case, sampling: Sampling) -> EngineSettings {
    let step = match case.engine.dt {
        Some(_) => case.longest_step,
        None => EngineSettings::dividing(sampling.interval, case.longest_step).step,
    };
    EngineSettings {
        step,
        substeps: case.engine.substeps,
        precision: precision(case),
        joints: match case.engine.joints {
            Joints::Impulse => engine::Joints::Impulse,
            Joints::Multibody => engine::Joints::Multibody,
        },
        scheme: match case.engine.scheme {
            Scheme::AveragedFriction => engine::Scheme::AveragedFriction,
            Scheme::SecondOrder => engine::Scheme::SecondOrder,
            Scheme::Plain => engine::Scheme::Plain,
        },
    }
}

/// Refuses steps of which the motion has none, too many, or that no engine could take.
fn check_step(case: &Case, step: f64) -> anyhow::Result<()> {
    let (duration, time) = (case.duration, case.scales.time);
    ensure!(
        step <= duration,
        "engine.dt = {:e} is longer than the motion, {:e}: the engine would take no step",
        step * time,
        duration * time
    );
    let steps = duration / step;
    ensure!(
        steps <= MAX_STEPS,
        "the engine would take {steps:e} steps, at most {MAX_STEPS:e} are allowed: shorten the motion or lengthen the step"
    );
    if case.disk.is_some() {
        // Has other frequencies and a limit of its own.
        return Ok(());
    }
    // The faster sticking mode; beyond 2/omega the leapfrog is unstable and what it shows is no motion of the rig.
    let limit = 2.0 / (1.0 + 2.0 * case.parameters.kappa).sqrt();
    ensure!(
        step < limit,
        "engine.dt = {:e} is not allowed: it must be below {:e}, where the engine's integrator becomes unstable",
        step * time,
        limit * time
    );
    Ok(())
}

/// The motion in Rapier.
pub fn in_engine(case: &Case, start: &State, sampling: Sampling) -> anyhow::Result<Recording> {
    if let Some(ramp) = case.ramp {
        return sweep::in_engine(case, ramp, start, sampling);
    }
    let settings = engine_settings(case, sampling);
    check_step(case, settings.step)?;
    if let Some(disk) = &case.disk {
        return filmed::in_engine(case, disk, settings, (start, sampling));
    }
    let rig = TwoMassRig::new(case.parameters)?;
    Ok(match case.prescribed {
        Some(motion) => engine::PrescribedFlow::new(rig.chain(), motion, settings)?.record(start, sampling)?,
        None => EngineFlow::new(rig.chain(), settings)?
            .with_amplitude_bound(case.amplitude_bound)?
            .record(start, sampling)?,
    })
}

/// The exact motion.
pub fn exactly(case: &Case, start: &State, sampling: Sampling) -> anyhow::Result<Trajectory> {
    if let Some(ramp) = case.ramp {
        return sweep::exactly(case, ramp, start, sampling);
    }
    if let Some(disk) = &case.disk {
        return filmed::exactly(case, disk, start, sampling);
    }
    let rig = TwoMassRig::new(case.parameters)?;
    Ok(match case.prescribed {
        Some(motion) => exact::PrescribedFlow::new(rig.chain(), motion)?.trajectory(start, sampling)?,
        None => {
            exact::TwoMassFlow::new(&rig).with_amplitude_bound(case.amplitude_bound)?.trajectory(start, sampling)?
        }
    })
}

/// The motion of the slow flow. The bound of the case is lowered to the amplitudes for which its frequency is known.
pub fn by_slow_flow(
    case: &Case,
    energy: EnergyDefinition,
    start: &State,
    sampling: Sampling,
) -> anyhow::Result<Trajectory> {
    ensure!(case.prescribed.is_none(), "the slow flow knows no prescribed motion: take --with exact or rapier");
    let frequency = Arc::new(EnergyFrequency::new(case.parameters, energy, Interpolation::Converged)?);
    let flow = RestoredSlowFlow::at(case.parameters, &frequency)?.with_amplitude_bound(case.amplitude_bound)?;
    Ok(flow.trajectory(start, sampling)?)
}

/// Name and version of the engine a case asks for.
pub fn engine_info(settings: &EngineSettings) -> EngineInfo {
    EngineInfo::of(settings.precision)
}

/// What the comparison must know about the motion and the engine.
///
/// Small differences grow at the rate of the limit cycle's largest multiplier, where there is a cycle and it is unstable; without one, at
/// the rate at which the linear rig or disk grows.
pub fn expectation(case: &Case, settings: &EngineSettings, recording: &Recording) -> anyhow::Result<Expectation> {
    let end = recording.trajectory.last().map_or(case.duration, |sample| sample.time);
    // Of a sweep the rate where it is strongest bounds the others.
    let parameters = RigParameters { xi1: case.excitation().strongest(), ..case.parameters };
    let growth_rate = match (&case.disk, case.prescribed) {
        (Some(disk), _) => filmed::growth_rate(disk)?,
        (None, Some(_)) => 0.0,
        (None, None) => match exact_limit_cycle(parameters) {
            Ok(orbit) => (orbit.section_multipliers()[0].norm().ln() * 2.0 / orbit.period).max(0.0),
            Err(_) => (-0.5 * parameters.xi1).max(0.0),
        },
    };
    Ok(Expectation {
        horizon: case.horizon.min(end),
        step: settings.step,
        growth_rate,
        unit_roundoff: match settings.precision {
            engine::Precision::Single => 0.5 * f64::from(f32::EPSILON),
            engine::Precision::Double => 0.5 * f64::EPSILON,
        },
        motion: match case.motion {
            MotionKind::Regular => compare::Motion::Regular,
            MotionKind::Chaotic => compare::Motion::Chaotic,
        },
        joint_drift: Some([recording.drift.lateral, recording.drift.rotation]),
    })
}
