//! Motions of the two-mass rig that several scenarios watch.

use crate::conformance::ConformanceError;
use crate::conformance::experiment::{Experiment, SAMPLES_PER_PERIOD};
use crate::dynamics::State;
use crate::exact::TwoMassFlow;
use crate::model::{RigParameters, TwoMassRig};
use crate::orbit::{PeriodicOrbit, limit_cycle};

/// The nominal rig at a self-excitation.
pub(super) fn rig(xi1: f64) -> Result<TwoMassRig, ConformanceError> {
    Ok(TwoMassRig::new(RigParameters { xi1, ..RigParameters::default() })?)
}

/// The exact limit cycle.
pub(super) fn orbit(xi1: f64) -> Result<PeriodicOrbit, ConformanceError> {
    let parameters = RigParameters { xi1, ..RigParameters::default() };
    Ok(limit_cycle(parameters, |p| Ok(TwoMassFlow::new(&TwoMassRig::new(p)?)))?)
}

/// Ten periods beside the limit cycle at xi1 = -0.06, which is unstable: x2 moved by 0.001.
pub(super) fn beside_the_cycle(scenario: &'static str) -> Result<(Experiment, TwoMassFlow), ConformanceError> {
    let (rig, orbit) = (rig(-0.06)?, orbit(-0.06)?);
    let mut start: State = orbit.reversal();
    start.positions[1] += 0.001;
    let flow = TwoMassFlow::new(&rig);
    let chain = rig.chain().clone();
    Ok((Experiment { scenario, chain, start, period: orbit.period, periods: 10, samples: SAMPLES_PER_PERIOD }, flow))
}
