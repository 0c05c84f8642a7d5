//! All scenarios of the report, in its order. A new one is a file in `scenarios` and a line here.

use super::scenario::Scenario;
use super::scenarios::{
    AmplitudeDiagram, Chaos, CoupledOscillators, EnergyLedger, FreeFlight, FrictionDecay, Hysteresis, JointDrift,
    LimitCycle, LinearOscillator, MechanismFriction, MechanismLinear, NegativeDamping, SecondaryHopf, Torus,
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
        Box::new(Torus),
        Box::new(SecondaryHopf),
        Box::new(AmplitudeDiagram),
        Box::new(Chaos),
        Box::new(EnergyLedger),
        Box::new(JointDrift),
        Box::new(MechanismLinear),
        Box::new(MechanismFriction),
    ]
}
