//! The energy ledger over ten periods beside the limit cycle: `E(t) - E(0) - work of all elements`, which is zero for an exact solution.

use super::near_motion::{Quantities, rows};
use super::rig_motion::beside_the_cycle;
use crate::conformance::experiment::friction_cases;
use crate::conformance::scenario::{Bench, Case, Depth, Scenario, subject};
use crate::conformance::{ConformanceError, Row};

/// Residual of the energy ledger.
#[derive(Debug, Clone, Copy)]
pub struct EnergyLedger;

const ID: &str = "energy_ledger";

impl Scenario for EnergyLedger {
    fn id(&self) -> &'static str {
        ID
    }

    fn title(&self) -> &'static str {
        "Energy ledger"
    }

    fn description(&self) -> &'static str {
        "The two-mass rig at ξ₁ = -0.06 beside its limit cycle, ten periods. Measured: the largest of |E(t) - E(0) - W(t)|, with the works of \
         damping, self-excitation and friction by the trapezoidal rule."
    }

    fn reference(&self) -> &'static str {
        "conservation of energy: zero"
    }

    fn cases(&self, depth: Depth) -> Vec<Case> {
        friction_cases(ID, "", depth)
    }

    fn run(&self, case: &Case, bench: &dyn Bench) -> Result<Vec<Row>, ConformanceError> {
        let (experiment, flow) = beside_the_cycle(ID)?;
        let motion = flow.solve(&experiment.start, experiment.duration())?;
        rows(&subject(self, case), case, bench, &experiment, &motion, Quantities::Energy)
    }
}
