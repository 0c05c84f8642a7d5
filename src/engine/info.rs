use super::settings::Precision;
use serde::Serialize;
use std::fmt;

/// The engine a number comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct EngineInfo {
    /// Name of the crate.
    pub name: &'static str,
    pub version: &'static str,
}

impl EngineInfo {
    /// As the crates say of themselves.
    #[must_use]
    pub fn of(precision: Precision) -> Self {
        match precision {
            Precision::Double => Self { name: "rapier3d-f64", version: rapier3d_f64::VERSION },
            Precision::Single => Self { name: "rapier3d", version: rapier3d::VERSION },
        }
    }
}

impl fmt::Display for EngineInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.name, self.version)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers depend on the patch release: whoever changes it must run the conformance report again.
    #[test]
    fn the_engine_is_the_release_that_was_measured() {
        assert_eq!(EngineInfo::of(Precision::Double).to_string(), "rapier3d-f64 0.36.1");
        assert_eq!(EngineInfo::of(Precision::Single).to_string(), "rapier3d 0.36.1");
    }
}
