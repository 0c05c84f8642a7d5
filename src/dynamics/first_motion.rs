//! Which way an element at its slip force moves first: the sign of the first derivative of its elongation rate that is not zero.
//!
//! Derivatives of the motion at its start follow from each other,
//!
//! ```text
//! x^(n+2) = M^-1 ( -K x^(n) - (D + S) x^(n+1) - sum_j R_j f_j^(n) b_j ),
//! f_j^(n) = (k_j/R_j) b_j^T x^(n)  while sticking,  0  while slipping      (n >= 1).
//! ```
//!
//! Stick and slip agree up to the first derivative of the rate that is not zero, because the force follows the elongation: so
//! the sign of that derivative decides, and no guess of the contact is needed before it is known.
//!
//! A sum that vanishes in exact terms comes out as a rounding of its terms, and so does one whose terms carry the rounding of the
//! matrices (`1 - gamma + kappa` less `kappa`). So every sum carries a bound on its rounding, and what lies within it is zero.

use crate::model::{ContactState, Direction, OscillatorChain};

/// Relative rounding of a term: of its coefficient, which is itself a sum, of the product and of the addition.
const TERM_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Contact states at a start with positions, velocities and slider forces of the right lengths.
pub(super) fn contacts_at(chain: &OscillatorChain, x: &[f64], v: &[f64], f: &[f64]) -> Vec<ContactState> {
    let elements = chain.jenkins();
    let rate = |j: usize| elements[j].attachment.elongation(v);
    let mut contacts: Vec<Option<ContactState>> = (0..elements.len())
        .map(|j| if f[j].abs() < 1.0 { Some(ContactState::Stick) } else { decided(f[j], rate(j)) })
        .collect();
    if contacts.iter().any(Option::is_none) {
        Derivatives::new(chain, x, v, f).decide(f, &mut contacts);
    }
    contacts.into_iter().map(|contact| contact.unwrap_or(ContactState::Stick)).collect()
}

/// Slip where the element is loaded further, stick where it is unloaded, `None` where it does not move.
fn decided(force: f64, motion: f64) -> Option<ContactState> {
    let direction = Direction::of(motion)?;
    Some(if Direction::of(force) == Some(direction) { ContactState::Slip(direction) } else { ContactState::Stick })
}

/// A sum with a bound on its rounding.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    value: f64,
    rounding: f64,
}

impl Sum {
    fn exactly(value: f64) -> Self {
        Self { value, rounding: 0.0 }
    }

    fn add(&mut self, factor: f64, term: Self) {
        let product = factor * term.value;
        self.value += product;
        self.rounding += TERM_ROUNDING * product.abs() + (factor * term.rounding).abs();
    }

    fn over(self, divisor: f64) -> Self {
        if self.value.abs() <= self.rounding {
            return Self::default();
        }
        Self { value: self.value / divisor, rounding: self.rounding / divisor.abs() }
    }
}

/// The latest two derivatives of the positions, and the latest of the forces.
struct Derivatives<'a> {
    chain: &'a OscillatorChain,
    x: Vec<Sum>,
    next: Vec<Sum>,
    forces: Vec<Sum>,
}

impl<'a> Derivatives<'a> {
    fn new(chain: &'a OscillatorChain, x: &[f64], v: &[f64], f: &[f64]) -> Self {
        let exact = |values: &[f64]| values.iter().map(|value| Sum::exactly(*value)).collect();
        Self { chain, x: exact(x), next: exact(v), forces: exact(f) }
    }

    /// Goes through the derivatives until every contact is known. A motion of N oscillators with m elements whose first 2 N + m
    /// derivatives do not move an element never does.
    fn decide(&mut self, f: &[f64], contacts: &mut [Option<ContactState>]) {
        for _ in 0..2 * self.chain.oscillators() + self.chain.sliders() {
            let latest = self.accelerations();
            let moves = latest.iter().any(|a| a.value != 0.0);
            self.x = std::mem::replace(&mut self.next, latest);
            self.forces = self.rates(contacts);
            for (j, contact) in contacts.iter_mut().enumerate().filter(|(_, contact)| contact.is_none()) {
                *contact = decided(f[j], self.elongation(j, &self.next).value);
            }
            let rests = !moves && self.x.iter().chain(&self.forces).all(|value| value.value == 0.0);
            if rests || contacts.iter().all(Option::is_some) || !self.next.iter().all(|a| a.value.is_finite()) {
                return;
            }
        }
    }

    fn accelerations(&self) -> Vec<Sum> {
        let chain = self.chain;
        let n = chain.oscillators();
        let mut sums = vec![Sum::default(); n];
        for (i, sum) in sums.iter_mut().enumerate() {
            for j in 0..n {
                sum.add(-chain.stiffness()[(i, j)], self.x[j]);
                sum.add(-chain.damping()[(i, j)], self.next[j]);
                sum.add(-chain.self_excitation()[(i, j)], self.next[j]);
            }
        }
        for (element, force) in chain.jenkins().iter().zip(&self.forces) {
            for (i, sign) in element.attachment.direction() {
                sums[i].add(-sign * element.slip_force, *force);
            }
        }
        sums.into_iter().zip(chain.mass().iter()).map(|(sum, mass)| sum.over(*mass)).collect()
    }

    /// Derivatives of the forces of the order of `x`. An element not decided yet has not moved: its rate is zero in either state.
    fn rates(&self, contacts: &[Option<ContactState>]) -> Vec<Sum> {
        let of = |(j, contact): (usize, &Option<ContactState>)| match contact {
            Some(ContactState::Slip(_)) => Sum::default(),
            _ => {
                let mut rate = Sum::default();
                rate.add(self.chain.jenkins()[j].normalised_stiffness(), self.elongation(j, &self.x));
                rate
            }
        };
        contacts.iter().enumerate().map(of).collect()
    }

    fn elongation(&self, j: usize, values: &[Sum]) -> Sum {
        let mut sum = Sum::default();
        for (i, sign) in self.chain.jenkins()[j].attachment.direction() {
            sum.add(sign, values[i]);
        }
        sum.over(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Attachment, ChainBuilder, JenkinsElement, RigParameters, TwoMassRig};

    /// Three masses in a row, a contact to ground at the first: a force on the third moves the contact by the fifth derivative of
    /// the elongation, two for each spring on the way.
    #[test]
    fn the_first_derivative_that_is_not_zero_decides_however_late_it_comes() {
        let contact = JenkinsElement { attachment: Attachment::Ground(0), stiffness: 1.0, slip_force: 1.0 };
        let chain = ChainBuilder::new(vec![1.0; 3])
            .ground_spring(0, 1.0)
            .coupling_spring(0, 1, 0.1)
            .coupling_spring(1, 2, 0.1)
            .jenkins(contact)
            .build()
            .unwrap();
        // x1 = x2 = -1 balances f = 1; the third mass lags by `pull`.
        let start = |pull: f64| contacts_at(&chain, &[-1.0, -1.0, -1.0 + pull], &[0.0; 3], &[1.0])[0];
        assert_eq!(start(1e-9), ContactState::Slip(Direction::Positive));
        assert_eq!(start(-1e-9), ContactState::Stick);
        assert_eq!(start(0.0), ContactState::Stick);
    }

    /// x1 = x2 = -1, f = 1: (1 - gamma) x1 + gamma f = 0 in exact terms, though 1 - gamma + kappa less kappa is not 1 - gamma in
    /// doubles. The second mass is pulled back with x2'' = 1 and pulls the first: the third derivative of w is kappa x2''.
    #[test]
    fn what_vanishes_in_exact_terms_is_not_decided_by_the_rounding_of_the_matrices() {
        let rig = TwoMassRig::new(RigParameters { kappa: 0.059, gamma: 0.5, ..RigParameters::default() }).unwrap();
        let stiffness = rig.chain().stiffness();
        assert_ne!(stiffness[(0, 0)] + stiffness[(0, 1)], 0.5, "no rounding to be misled by");
        for sign in [1.0, -1.0] {
            let x = [-sign, -sign];
            let direction = Direction::of(sign).unwrap();
            assert_eq!(contacts_at(rig.chain(), &x, &[0.0; 2], &[sign]), [ContactState::Slip(direction)]);
        }
    }
}
