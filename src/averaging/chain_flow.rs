//! Slow flow of a chain or ring of any number of oscillators with any number of Jenkins elements.
//!
//! With `x_j = Re z_j exp(i phi)`, `phi' = w` one carrier frequency common to all, averaging over a cycle leaves
//!
//! ```text
//! 2 i w m_j z_j' = (m_j w^2 z - K z - i w (D + S) z)_j - sum_e b_(e,j) N_e(|u_e|) u_e,      u_e = b_e^T z
//! N_e(a) = k_e ( keq(a/s_e) + i (w deq)(a/s_e) ),   s_e = R_e/k_e
//! ```
//!
//! with the describing function (13)-(14) of the paper for every element, to ground or between oscillators, at the amplitude of its own elongation.
//! K, D and S may be non-symmetric. For two oscillators this is the slow flow (10)-(12) in complex amplitudes.
//!
//! # The carrier frequency
//!
//! The two-mass slow flow takes w from the energy along its branch of limit cycles. Many blades have a branch for every wave, and w is no function of the
//! energy; here it is [`Carrier::Mean`], the frequency at which the mean phase rests, `Re z^H (2 i w M z') = 0`:
//!
//! ```text
//! w^2 z^H M z + w Im(z^H (D + S) z) - Re(z^H K z) - sum_e Re N_e |u_e|^2 = 0
//! ```
//!
//! that is, averaged kinetic and (equivalent) potential energy are equal, but for the term of a non-symmetric damping. On every motion of one frequency,
//! whatever the amplitudes and phases, it is that frequency, and the fixed points of the slow flow are those of harmonic balance
//! with one harmonic.
//!
//! # Assumptions
//!
//! Amplitudes and phases change little in a cycle, so all frequencies present lie near w: one that differs by `d` is wrong by `d^2/(2 w)`, and what the air
//! does to it by the part `d/w`. A second family of modes, such as disk segments with their own frequencies, is beyond that. One
//! harmonic carries every elongation.

use super::describing::DescribingFunction;
use super::error::AveragingError;
use crate::dynamics::{Outcome, State};
use crate::model::{OscillatorChain, Range, SparseMatrix};
use nalgebra::Complex;

const I: Complex<f64> = Complex::new(0.0, 1.0);
/// Some |z| beyond this has diverged, unless told otherwise.
const DEFAULT_AMPLITUDE_BOUND: f64 = 1000.0;
/// Steps of the fixed point between amplitudes and frequency of a given state; it converges like the part of the energy in other frequencies.
const MOST_TRIALS: usize = 200;

/// The common carrier frequency.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Carrier {
    /// The mean frequency of the present motion.
    #[default]
    Mean,
    /// A constant.
    Given(f64),
}

/// Averaged motion of a chain.
#[derive(Debug, Clone)]
pub struct ChainSlowFlow {
    mass: Vec<f64>,
    stiffness: SparseMatrix,
    damping: SparseMatrix,
    contacts: Vec<Contact>,
    carrier: Carrier,
    pub(super) amplitude_bound: f64,
}

/// A Jenkins element.
#[derive(Debug, Clone, Copy)]
struct Contact {
    first: usize,
    second: Option<usize>,
    stiffness: f64,
    slip_elongation: f64,
}

impl Contact {
    fn elongation(&self, z: &[Complex<f64>]) -> Complex<f64> {
        z[self.first] - self.second.map_or(Complex::ZERO, |second| z[second])
    }

    /// Complex stiffness at an amplitude of the elongation.
    fn equivalent(&self, amplitude: f64) -> Complex<f64> {
        let d = DescribingFunction::at(amplitude / self.slip_elongation);
        self.stiffness * Complex::new(d.stiffness, d.damping)
    }
}

/// Complex amplitudes at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainSlowState {
    /// `z_j`, one per oscillator.
    pub amplitudes: Vec<Complex<f64>>,
    /// Integral of the carrier frequency over time, rad.
    pub phase: f64,
}

impl ChainSlowFlow {
    /// With the mean frequency as carrier.
    #[must_use]
    pub fn new(chain: &OscillatorChain) -> Self {
        let contact = |element: &crate::model::JenkinsElement| {
            let mut ends = element.attachment.direction().map(|(end, _)| end);
            Contact {
                first: ends.next().unwrap_or_default(),
                second: ends.next(),
                stiffness: element.stiffness,
                slip_elongation: 1.0 / element.normalised_stiffness(),
            }
        };
        Self {
            mass: chain.mass().as_slice().to_vec(),
            stiffness: SparseMatrix::of(chain.stiffness()),
            damping: SparseMatrix::of(&chain.total_damping()),
            contacts: chain.jenkins().iter().map(contact).collect(),
            carrier: Carrier::Mean,
            amplitude_bound: DEFAULT_AMPLITUDE_BOUND,
        }
    }

    /// # Errors
    /// [`AveragingError::Parameter`] for a given frequency that is not positive.
    pub fn with_carrier(self, carrier: Carrier) -> Result<Self, AveragingError> {
        if let Carrier::Given(w) = carrier {
            Range::Positive.check("carrier", w)?;
        }
        Ok(Self { carrier, ..self })
    }

    /// A motion in which some |z| exceeds the bound has diverged.
    ///
    /// # Errors
    /// [`AveragingError::Parameter`] unless the bound is positive.
    pub fn with_amplitude_bound(self, bound: f64) -> Result<Self, AveragingError> {
        Ok(Self { amplitude_bound: Range::Positive.check("amplitude_bound", bound)?, ..self })
    }

    /// Number of complex amplitudes.
    #[must_use]
    pub fn oscillators(&self) -> usize {
        self.mass.len()
    }

    /// Rates of the amplitudes, into `rates` of the same length, and the carrier frequency. `None` where there is no mean frequency: all amplitudes
    /// vanish, or the mean stiffness is not positive; `rates` mean nothing then.
    pub fn rates(&self, z: &[Complex<f64>], rates: &mut [Complex<f64>]) -> Option<f64> {
        // K z and the contacts into `rates`; the damping apart, for it meets w first.
        let product = |row: &[(usize, f64)]| row.iter().map(|(j, value)| z[*j] * *value).sum::<Complex<f64>>();
        rates.iter_mut().zip(self.stiffness.rows()).for_each(|(rate, row)| *rate = product(row));
        for contact in &self.contacts {
            let u = contact.elongation(z);
            let force = contact.equivalent(u.norm()) * u;
            rates[contact.first] += force;
            if let Some(second) = contact.second {
                rates[second] -= force;
            }
        }
        let damped: Vec<Complex<f64>> = self.damping.rows().map(product).collect();
        let w = match self.carrier {
            Carrier::Given(w) => w,
            Carrier::Mean => self.mean_frequency(z, rates, &damped)?,
        };
        for (j, rate) in rates.iter_mut().enumerate() {
            let force = self.mass[j] * w * w * z[j] - *rate - I * w * damped[j];
            *rate = -I * force / (2.0 * w * self.mass[j]);
        }
        Some(w)
    }

    /// `w` from `K z` with the contacts, and `D z`.
    fn mean_frequency(&self, z: &[Complex<f64>], elastic: &[Complex<f64>], damped: &[Complex<f64>]) -> Option<f64> {
        let sum = |of: &dyn Fn(usize) -> f64| (0..z.len()).map(of).sum::<f64>();
        let inertia = sum(&|j| self.mass[j] * z[j].norm_sqr());
        let potential = sum(&|j| (z[j].conj() * elastic[j]).re);
        let gyroscopic = sum(&|j| (z[j].conj() * damped[j]).im);
        // w^2 inertia + w gyroscopic - potential = 0
        let w = ((gyroscopic * gyroscopic + 4.0 * inertia * potential).sqrt() - gyroscopic) / (2.0 * inertia);
        Some(w).filter(|w| w.is_finite() && *w > 0.0)
    }

    /// The mean frequency of a motion, or the one given; `None` where there is none.
    #[must_use]
    pub fn frequency(&self, z: &[Complex<f64>]) -> Option<f64> {
        self.rates(z, &mut vec![Complex::ZERO; z.len()])
    }

    /// `z_j = x_j - i v_j/w` with the frequency of these amplitudes; slider forces are those of the steady hysteresis and are not used.
    ///
    /// # Errors
    /// [`AveragingError::NoCarrier`] for a state of rest, and where the frequency cannot be found.
    pub fn slow_state(&self, state: &State) -> Result<ChainSlowState, AveragingError> {
        let at = |w: f64| -> Vec<Complex<f64>> {
            state.positions.iter().zip(&state.velocities).map(|(x, v)| Complex::new(*x, -v / w)).collect()
        };
        let mut w = 1.0;
        for _ in 0..MOST_TRIALS {
            let next = self.frequency(&at(w)).ok_or(AveragingError::NoCarrier { time: 0.0 })?;
            let change = (next - w).abs();
            // Half a step: velocities scale with 1/w, which would make the plain iteration swing.
            w = 0.5 * (w + next);
            // Far below what averaging leaves out, far above the rounding of the sums over a thousand blades.
            if change <= 1e-12 * w {
                return Ok(ChainSlowState { amplitudes: at(w), phase: 0.0 });
            }
        }
        Err(AveragingError::NoCarrier { time: 0.0 })
    }
}

/// Where an averaged motion ended, and what it took.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainSlowArrival {
    pub state: ChainSlowState,
    pub outcome: Outcome,
    /// Steps taken, and evaluations of the rates.
    pub steps: usize,
    pub evaluations: usize,
}
