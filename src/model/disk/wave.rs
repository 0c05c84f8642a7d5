//! Nodal diameters and interblade phase angles of a ring of N blades.

use crate::model::ParameterError;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Which way a wave runs round the ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TravelDirection {
    /// To higher blade numbers.
    Forward,
    Backward,
    /// Nodal diameters 0 and N/2.
    Standing,
}

/// A wave number of a ring: signed, `-N/2 < n <= N/2`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
pub struct NodalDiameter {
    signed: i64,
    sectors: usize,
}

impl NodalDiameter {
    /// The wave number `n` modulo the number of `sectors`.
    ///
    /// # Panics
    /// Never for `sectors >= 1`; a ring without sectors is refused by [`super::BladedDisk`].
    #[must_use]
    pub fn new(n: i64, sectors: usize) -> Self {
        let count = sectors.max(1) as i64;
        let n = n.rem_euclid(count);
        Self { signed: if 2 * n > count { n - count } else { n }, sectors: sectors.max(1) }
    }

    /// The wave number `n` itself, where the ring has it: `-N/2 < n <= N/2`.
    ///
    /// # Errors
    /// [`ParameterError::NoSuchWave`] naming `field`.
    pub fn checked(field: &str, n: i64, sectors: usize) -> Result<Self, ParameterError> {
        let wave = Self::new(n, sectors);
        let count = wave.sectors as i64;
        if wave.signed == n {
            return Ok(wave);
        }
        let (least, most) = (-(count - 1) / 2, count / 2);
        Err(ParameterError::NoSuchWave { field: field.to_owned(), found: n, least, most })
    }

    /// All of a ring, in the order 0, 1, -1, 2, -2, ...
    pub fn all(sectors: usize) -> impl Iterator<Item = Self> {
        let half = (sectors / 2) as i64;
        (0..=half)
            .flat_map(|n| [n, -n])
            .filter(move |n| *n >= 0 || -2 * n != sectors as i64)
            .enumerate()
            .filter(|(i, _)| *i != 1)
            .map(move |(_, n)| Self::new(n, sectors))
    }

    /// The signed wave number.
    #[must_use]
    pub fn signed(self) -> i64 {
        self.signed
    }

    /// The place of this wave in lists by wave number 0, 1, ..., N - 1: n or N + n.
    #[must_use]
    pub fn index(self) -> usize {
        self.signed.rem_euclid(self.sectors as i64) as usize
    }

    #[must_use]
    pub fn sectors(self) -> usize {
        self.sectors
    }

    #[must_use]
    pub fn direction(self) -> TravelDirection {
        match self.signed {
            0 => TravelDirection::Standing,
            n if 2 * n == self.sectors as i64 => TravelDirection::Standing,
            n if n > 0 => TravelDirection::Forward,
            _ => TravelDirection::Backward,
        }
    }

    /// Interblade phase angle sigma, rad, in (-pi, pi]: blade j+1 lags blade j by it.
    #[must_use]
    pub fn phase_angle(self) -> f64 {
        TAU * self.signed as f64 / self.sectors as f64
    }

    /// `k sigma` reduced exactly before it is an angle, rad.
    #[must_use]
    pub fn multiple(self, k: i64) -> f64 {
        Self::new((self.signed * k).rem_euclid(self.sectors as i64), self.sectors).phase_angle()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_has_as_many_waves_as_blades_each_once() {
        for sectors in 1..=9 {
            let mut indices: Vec<usize> = NodalDiameter::all(sectors).map(NodalDiameter::index).collect();
            indices.sort_unstable();
            assert_eq!(indices, (0..sectors).collect::<Vec<_>>());
        }
        let signed = |n| NodalDiameter::all(n).map(NodalDiameter::signed).collect::<Vec<_>>();
        assert_eq!(signed(4), [0, 1, -1, 2]);
        assert_eq!(signed(5), [0, 1, -1, 2, -2]);
    }

    #[test]
    fn directions_follow_the_sign_and_standing_waves_have_none() {
        let direction = |n, sectors| NodalDiameter::new(n, sectors).direction();
        assert_eq!(direction(1, 12), TravelDirection::Forward);
        assert_eq!(direction(11, 12), TravelDirection::Backward);
        assert_eq!(direction(6, 12), TravelDirection::Standing);
        assert_eq!(direction(6, 13), TravelDirection::Forward);
        assert_eq!(direction(0, 12), TravelDirection::Standing);
    }
}
