//! Limit cycles of the exact flow, for the files that follow them.

use stickslip::exact::TwoMassFlow;
use stickslip::model::{RigParameter, RigParameters, TwoMassRig};
use stickslip::orbit::{Heading, OrbitError, PseudoArclength, limit_cycle};

pub type MapAt = fn(RigParameters) -> Result<TwoMassFlow, OrbitError>;

pub fn exact_at(p: RigParameters) -> Result<TwoMassFlow, OrbitError> {
    Ok(TwoMassFlow::new(&TwoMassRig::new(p)?))
}

pub fn nominal() -> RigParameters {
    RigParameters { xi1: -0.06, xi2: 0.011, kappa: 0.1, gamma: 0.5 }
}

/// The branch over xi1 from an amplitude barely above the sticking limit.
pub fn from_the_sticking_limit(p: RigParameters) -> PseudoArclength<MapAt> {
    let start = RigParameters { xi1: -1e-3, ..p };
    let orbit = limit_cycle(start, exact_at).unwrap();
    PseudoArclength::new(exact_at as MapAt, start, &orbit, RigParameter::Xi1, Heading::Decreasing).unwrap()
}
