//! Where a wave may have limit cycles: the describing function, searched over the amplitude of the contact.
//!
//! A contact whose elongation swings with amplitude a carries, in the first harmonic, `N(tau) = (2 tau - sin 2 tau)/(2 pi e) + i sin^2(tau)/(pi e)` of the
//! elongation, with `a = 2 e/(1 - cos tau)`: tau falls from pi at the slip limit to 0 at infinite amplitude, and N is smooth in it. With the contact in
//! its place a sector has the eigenvalues of
//!
//! ```text
//! det(s^2 M + s D(sigma) + K(sigma) + R N(tau) conj(c) c^T) = 0
//! ```
//!
//! and a limit cycle is where one of them crosses the imaginary axis at w = Im s > 0. All eigenvalues, that is every mode of the sector, are followed
//! over tau from the slip limit to [`LARGEST_AMPLITUDE`] in equal steps, whether they are damped at rest or not. A change of sign of Re s is a root;
//! where Re s has an extreme towards zero between nodes, the extreme is sought, so that pairs of roots between two nodes are found.
//!
//! What can be missed: cycles that the describing function does not have; extremes narrower than a step; cycles beyond the largest amplitude (told by
//! [`Searched::beyond`] where the sign of Re s at infinity shows one); cycles that are no waves.

use super::error::DiskError;
use super::odd_series::C;
use super::sector::Sector;
use crate::model::NodalDiameter;
use std::f64::consts::PI;

/// Largest amplitude looked at, in units of the slip elongation.
pub const LARGEST_AMPLITUDE: f64 = 1000.0;
/// Steps of tau.
const STEPS: usize = 512;
/// Real parts below this part of the largest eigenvalue have no sign.
const ZERO: f64 = 1e-12;
/// Halvings of a step in which eigenvalues cannot be told apart.
const MOST_HALVINGS: usize = 8;
/// Steps of bisection, to rounding, and of the search for an extreme.
const BISECTIONS: usize = 60;
const GOLDEN_STEPS: usize = 48;

/// Where the describing function has a limit cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    pub wave: NodalDiameter,
    /// Number of the mode of the sector, as [`crate::model::TunedMode::family`].
    pub family: usize,
    /// Amplitude of the elongation of a contact.
    pub elongation: f64,
    pub angular_frequency: f64,
}

/// What was looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Searched {
    /// Smallest and largest amplitude of the elongation.
    pub elongations: [f64; 2],
    /// Number of amplitudes in between at which all eigenvalues were computed.
    pub amplitudes: usize,
    /// Largest ratio of two neighbouring amplitudes.
    pub largest_ratio: f64,
    /// Eigenvalues followed.
    pub eigenvalues: usize,
    /// Whether some root lies beyond the largest amplitude.
    pub beyond: bool,
}

/// The eigenvalues at one tau, by branch.
#[derive(Debug, Clone)]
struct Node {
    tau: f64,
    roots: Vec<C>,
}

/// All candidates of a wave by family and amplitude, and what was searched.
pub(super) fn search(sector: &Sector<'_>) -> Result<(Vec<Candidate>, Searched), DiskError> {
    let scan = Scan::new(sector)?;
    let mut found = Vec::new();
    for (family, branch) in scan.families().into_iter().enumerate() {
        for tau in scan.crossings(branch)? {
            let s = scan.at(tau)?.roots[branch];
            let elongation = amplitude(tau) * sector.slip_elongation;
            found.push(Candidate { wave: sector.wave, family, elongation, angular_frequency: s.im });
        }
    }
    let e = sector.slip_elongation;
    let last = scan.nodes.len() - 1;
    let searched = Searched {
        elongations: [e, LARGEST_AMPLITUDE * e],
        amplitudes: scan.nodes.len(),
        largest_ratio: amplitude(scan.nodes[last].tau) / amplitude(scan.nodes[last - 1].tau),
        eigenvalues: scan.nodes[0].roots.len(),
        beyond: scan.goes_on_beyond()?,
    };
    Ok((found, searched))
}

/// `a/e` at a sticking angle.
fn amplitude(tau: f64) -> f64 {
    2.0 / (1.0 - tau.cos())
}

struct Scan<'s, 'a> {
    sector: &'s Sector<'a>,
    /// From the slip limit on.
    nodes: Vec<Node>,
    /// Real parts smaller than this are zero.
    zero: f64,
}

impl<'s, 'a> Scan<'s, 'a> {
    fn new(sector: &'s Sector<'a>) -> Result<Self, DiskError> {
        let first = Node { tau: PI, roots: sector.eigenvalues(PI)? };
        let zero = ZERO * first.roots.iter().map(|s| s.norm()).fold(0.0, f64::max);
        let mut scan = Self { sector, nodes: vec![first], zero };
        let least = (1.0 - 2.0 / LARGEST_AMPLITUDE).acos();
        for k in 1..=STEPS {
            let tau = PI + (least - PI) * k as f64 / STEPS as f64;
            let node = scan.from(&scan.nodes[k - 1], tau, MOST_HALVINGS)?;
            scan.nodes.push(node);
        }
        Ok(scan)
    }

    /// The eigenvalues at `tau`, each the continuation of that of `node`.
    fn from(&self, node: &Node, tau: f64, halvings: usize) -> Result<Node, DiskError> {
        let (roots, clear) = continued(&node.roots, self.sector.eigenvalues(tau)?, self.zero);
        if clear || halvings == 0 {
            return Ok(Node { tau, roots });
        }
        let middle = self.from(node, 0.5 * (node.tau + tau), halvings - 1)?;
        self.from(&middle, tau, halvings - 1)
    }

    /// The same from the nearest node on the way.
    fn at(&self, tau: f64) -> Result<Node, DiskError> {
        let nearest = self.nodes.iter().min_by(|a, b| (a.tau - tau).abs().total_cmp(&(b.tau - tau).abs()));
        self.from(nearest.unwrap_or(&self.nodes[0]), tau, MOST_HALVINGS)
    }

    /// Branches in the order of families: those that swing at the slip limit by frequency, then the others.
    fn families(&self) -> Vec<usize> {
        let start = &self.nodes[0].roots;
        let mut order: Vec<usize> = (0..start.len()).collect();
        let rank = |b: &usize| (start[*b].im <= self.zero, start[*b].im);
        order.sort_by(|a, b| rank(a).partial_cmp(&rank(b)).unwrap_or(std::cmp::Ordering::Equal));
        order
    }

    /// Sign of the growth of a branch; none where it is zero to rounding or the branch does not swing as this wave.
    fn sign(&self, s: C) -> Option<f64> {
        (s.im > self.zero && s.re.abs() > self.zero).then(|| s.re.signum())
    }

    /// All tau at which a branch crosses the imaginary axis, in order of amplitude.
    fn crossings(&self, branch: usize) -> Result<Vec<f64>, DiskError> {
        let mut found = Vec::new();
        let mut before: Option<(f64, f64)> = None;
        for (k, node) in self.nodes.iter().enumerate() {
            let s = node.roots[branch];
            if s.im <= self.zero {
                before = None;
            }
            let Some(sign) = self.sign(s) else { continue };
            if let Some((tau, other)) = before.filter(|(_, other)| *other != sign) {
                found.push(self.bisected(branch, [tau, node.tau], other)?);
            }
            before = Some((node.tau, sign));
            if let Some(tau) = self.beyond_zero(branch, k, sign)? {
                found.push(self.bisected(branch, [self.nodes[k - 1].tau, tau], sign)?);
                found.push(self.bisected(branch, [tau, self.nodes[k + 1].tau], -sign)?);
            }
        }
        found.sort_by(|a, b| b.total_cmp(a));
        Ok(found)
    }

    /// Where node k is nearer to zero than its neighbours on the same side: a tau between them on the other side of zero, if the extreme lies there.
    fn beyond_zero(&self, branch: usize, k: usize, sign: f64) -> Result<Option<f64>, DiskError> {
        if k == 0 || k + 1 == self.nodes.len() {
            return Ok(None);
        }
        let height = |j: usize| self.nodes[j].roots[branch];
        let same = |j: usize| self.sign(height(j)) == Some(sign) && sign * height(j).re >= sign * height(k).re;
        if !(same(k - 1) && same(k + 1)) {
            return Ok(None);
        }
        let [mut low, mut high] = [self.nodes[k - 1].tau, self.nodes[k + 1].tau];
        let part = 0.5 * (5.0_f64.sqrt() - 1.0);
        let of = |tau: f64| Ok::<f64, DiskError>(sign * self.at(tau)?.roots[branch].re);
        for _ in 0..GOLDEN_STEPS {
            let [a, b] = [high - part * (high - low), low + part * (high - low)];
            let [fa, fb] = [of(a)?, of(b)?];
            let (best, value) = if fa < fb { (a, fa) } else { (b, fb) };
            if value < -self.zero {
                return Ok(Some(best));
            }
            if fa < fb { high = b } else { low = a }
        }
        Ok(None)
    }

    /// The crossing between two tau; at the first the branch has the sign given.
    fn bisected(&self, branch: usize, [mut from, mut to]: [f64; 2], sign: f64) -> Result<f64, DiskError> {
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (from + to);
            if sign * self.at(middle)?.roots[branch].re > 0.0 { from = middle } else { to = middle }
        }
        Ok(0.5 * (from + to))
    }

    /// Whether some branch has another sign at infinite amplitude, where contacts do nothing, than at the largest.
    fn goes_on_beyond(&self) -> Result<bool, DiskError> {
        let last = &self.nodes[self.nodes.len() - 1];
        let free = self.from(last, 0.0, MOST_HALVINGS)?;
        let signs = |(a, b): (&C, &C)| self.sign(*a).zip(self.sign(*b));
        Ok(last.roots.iter().zip(&free.roots).filter_map(signs).any(|(a, b)| a != b))
    }
}

/// `roots` in the order of `before`, the nearest to each; and whether that was clear: every one moved by less than half of the way to the next.
fn continued(before: &[C], mut roots: Vec<C>, zero: f64) -> (Vec<C>, bool) {
    let mut clear = true;
    let ordered = before.iter().map(|old| {
        let distance = |s: &C| (s - old).norm();
        roots.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        if let [first, second, ..] = roots[..] {
            clear &= distance(&first) <= 0.5 * distance(&second) || distance(&first) <= zero;
        }
        roots.remove(0)
    });
    let ordered = ordered.collect();
    (ordered, clear)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Aerodynamics, BladedDisk, ContactPlace, FrictionContacts, InfluenceCoefficient};

    fn ring(own: f64, next: f64) -> BladedDisk {
        let l = |offset, real, imaginary| InfluenceCoefficient { offset, real, imaginary };
        BladedDisk {
            friction: vec![FrictionContacts::everywhere(ContactPlace::Foot, 0.6)],
            aerodynamics: Some(Aerodynamics::Coefficients {
                coefficients: vec![l(0, 0.0, own), l(1, next, 0.0), l(-1, -next, 0.0)],
                reference_frequency: 1.0,
            }),
            ..BladedDisk::ring(4, 0.01)
        }
    }

    fn candidates(disk: &BladedDisk, n: i64) -> (Vec<Candidate>, Searched) {
        search(&Sector::new(disk, NodalDiameter::new(n, 4)).unwrap()).unwrap()
    }

    #[test]
    fn cycles_of_a_wave_damped_at_rest_are_found_singly_and_in_pairs() {
        // Stuck, wave 1 has the damping own - 2 next > 0; slipping it is slower, w^2 about 0.4, and fed: own w - 2 next < 0.
        let (found, searched) = candidates(&ring(0.05, 0.0225), 1);
        assert_eq!(found.len(), 1);
        // The exact cycle, by shooting with matrix exponentials outside the project, has amplitude 60.13 and w = 0.6497: the describing function
        // leaves out harmonics of some per cent.
        assert!((found[0].elongation / 60.13 - 1.0).abs() < 0.05, "{:?}", found[0]);
        assert!((found[0].angular_frequency / 0.6497 - 1.0).abs() < 0.01 && !searched.beyond);
        assert!(candidates(&ring(0.05, 0.0225), -1).0.is_empty());
        // Damping own w - 2 next of the free blade a little above zero, below it at some amplitude in between, if friction were off: none here.
        let (none, searched) = candidates(&ring(0.05, 0.0155), 1);
        assert!(none.is_empty() && !searched.beyond, "{none:?}");
    }

    #[test]
    fn friction_that_holds_up_to_an_amplitude_gives_a_stable_and_an_unstable_cycle() {
        // Fed at rest, held by friction, and beyond the largest amplitude of the scan friction is too weak again: 4 R/(pi a) against the feeding.
        let fed = ring(-0.02, 0.0);
        let (found, searched) = candidates(&fed, 0);
        assert!(found.len() == 2 && !searched.beyond, "{found:?} {searched:?}");
        // Work balance of free sliding, pi d w a = 4 R with R = 0.6 and w near sqrt(0.4): a = 2.4/(pi 0.02 w).
        let expected = 2.4 / (PI * 0.02 * found[1].angular_frequency);
        assert!((found[1].elongation / expected - 1.0).abs() < 0.05, "{found:?} {expected}");
        // A tenth of the feeding moves it by ten, one hundredth beyond the scan, which says so.
        assert!(candidates(&ring(-0.0002, 0.0), 0).1.beyond);
    }

    #[test]
    fn eigenvalues_keep_their_branches() {
        let at = |re, im| C::new(re, im);
        let (roots, clear) = continued(&[at(0.0, 1.0), at(0.0, -1.0)], vec![at(0.1, -1.0), at(0.1, 1.1)], 0.0);
        assert!(clear && roots == [at(0.1, 1.1), at(0.1, -1.0)]);
        let (_, clear) = continued(&[at(0.0, 1.0), at(0.0, 1.2)], vec![at(0.0, 1.1), at(0.0, 1.15)], 0.0);
        assert!(!clear, "two eigenvalues equally near cannot be told apart");
    }
}
