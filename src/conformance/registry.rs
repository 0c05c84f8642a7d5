//! All scenarios of the report, in its order. A new one is a file in `scenarios` and a line here.

use super::scenario::Scenario;
use super::scenarios;

/// All scenarios.
#[must_use]
pub fn registry() -> Vec<Box<dyn Scenario>> {
    vec![Box::new(scenarios::LinearOscillator), Box::new(scenarios::SecondaryHopf)]
}
