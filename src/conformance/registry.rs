//! All scenarios of the report, in its order. A new one is a file in `scenarios` and a line here.

use super::scenario::Scenario;
use super::scenarios::{
    Chaos, CoupledOscillators, EnergyLedger, FreeFlight, FrictionDecay, Hysteresis, JointDrift, LimitCycle,
    LinearOscillator, NegativeDamping, SecondaryHopf, Torus,
};

/// All scenarios.
#[must_use]
pub fn registry() -> Vec<Box<dyn Scenario>> {
    vec![
        Box::new(FreeFlight),
        Box::new(LinearOscillator),
        Box::new(NegativeDamping),
        Box::new(CoupledOscillators),
        Box::new(Hysteresis),
        Box::new(FrictionDecay),
        Box::new(LimitCycle),
        Box::new(SecondaryHopf),
        Box::new(Torus),
        Box::new(SecondaryHopf),
        Box::new(Chaos),
        Box::new(EnergyLedger),
        Box::new(JointDrift),
    ]
}
