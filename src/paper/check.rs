//! A stated expectation and whether it was met.

use serde::{Deserialize, Serialize};

/// A number, or words where a number says nothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    Number(f64),
    Words(String),
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<&str> for Value {
    fn from(words: &str) -> Self {
        Self::Words(words.to_owned())
    }
}

impl From<String> for Value {
    fn from(words: String) -> Self {
        Self::Words(words)
    }
}

/// One expectation. Where it comes from and why the tolerance is what it is, is in `reason`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Check {
    pub name: String,
    pub expected: Value,
    pub found: Value,
    /// Largest difference from `expected`; for bounds and words 0.
    pub tolerance: f64,
    pub reason: String,
    /// `None` where the expectation is one of the nominal parameters and others were given.
    pub passed: Option<bool>,
}

impl Check {
    /// `found` within `tolerance` of `expected`. A number that is not finite fails.
    #[must_use]
    pub fn near(name: &str, expected: f64, found: f64, tolerance: f64, reason: &str) -> Self {
        let passed = (found - expected).abs() <= tolerance;
        Self::of(name, expected.into(), found.into(), tolerance, reason, passed)
    }

    /// `found` not above `bound`.
    #[must_use]
    pub fn at_most(name: &str, bound: f64, found: f64, reason: &str) -> Self {
        Self::of(name, format!("at most {bound}").into(), found.into(), 0.0, reason, found <= bound)
    }

    /// `found` not below `bound`.
    #[must_use]
    pub fn at_least(name: &str, bound: f64, found: f64, reason: &str) -> Self {
        Self::of(name, format!("at least {bound}").into(), found.into(), 0.0, reason, found >= bound)
    }

    /// Something that holds or not; `found` says what was seen.
    #[must_use]
    pub fn holds(name: &str, expected: &str, found: impl Into<Value>, passed: bool, reason: &str) -> Self {
        Self::of(name, expected.into(), found.into(), 0.0, reason, passed)
    }

    fn of(name: &str, expected: Value, found: Value, tolerance: f64, reason: &str, passed: bool) -> Self {
        // JSON has no numbers that are not finite; such a value is named, and its check has failed already.
        let found = match found {
            Value::Number(number) if !number.is_finite() => Value::Words(number.to_string()),
            other => other,
        };
        Self { name: name.to_owned(), expected, found, tolerance, reason: reason.to_owned(), passed: Some(passed) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checks_can_fail() {
        assert_eq!(Check::near("a", 1.0, 1.1, 0.2, "").passed, Some(true));
        assert_eq!(Check::near("a", 1.0, 1.3, 0.2, "").passed, Some(false));
        assert_eq!(Check::near("a", 1.0, f64::NAN, 0.2, "").passed, Some(false));
        assert_eq!(Check::at_most("a", 1.0, f64::NAN, "").passed, Some(false));
        assert_eq!(Check::at_least("a", 1.0, 0.9, "").passed, Some(false));
    }

    #[test]
    fn checks_survive_json_whatever_was_found() {
        let checks = [Check::near("a", 1.0, f64::INFINITY, 0.2, "why"), Check::holds("b", "x", "y", true, "")];
        for check in checks {
            let text = serde_json::to_string(&check).unwrap();
            assert_eq!(serde_json::from_str::<Check>(&text).unwrap(), check);
        }
    }
}
