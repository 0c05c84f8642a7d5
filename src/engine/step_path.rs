//! Friction averaged over a step, along the path that is predicted for it.
//!
//! A force law evaluated at the steps sees a switch between stick and slip a whole number of steps late: the motion is of second order all the same, but
//! its derivative with respect to the start jumps wherever a switch moves from one step into the next. The mean of the friction force over the
//! step does not: with the velocity linear in the step, as the engine's own velocities `w_n`, half a step before `t_n`, have it,
//!
//! ```text
//! u(s) = w_n s + a s^2/2,   0 <= s <= h        the elongation gained since t_n - h/2
//! f(s)                                         the Jenkins law along it, from the slider force carried at t_n - h/2
//! force over the step  R mean f,  with a = a_(n-1);     slider force carried to t_n + h/2 with a = a_n;     recorded: f(h/2)
//! ```
//!
//! All in closed form: u turns at most once, and each monotone piece sticks until f is at its limit and slips from there. Velocities are half a step
//! early for one substep only: for more the window lies off the middle, and the method is of first order as without it.

use crate::model::{Attachment, JenkinsElement};

/// Where the carriages go during a step, as well as it is known.
#[derive(Debug, Clone, Copy)]
pub struct StepPath<'a> {
    /// Velocities at its beginning, length N.
    pub velocities: &'a [f64],
    /// Accelerations, constant along it, length N.
    pub accelerations: &'a [f64],
    pub duration: f64,
}

/// Slider force at the end of a path, and its mean over it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Along {
    pub end: f64,
    pub mean: f64,
}

impl StepPath<'_> {
    /// Change of an elongation from the beginning to the end.
    pub(super) fn elongation(&self, attachment: Attachment) -> f64 {
        let (w, a) = (attachment.elongation(self.velocities), attachment.elongation(self.accelerations));
        self.duration * (w + 0.5 * a * self.duration)
    }
}

/// The Jenkins law along a path, from the normalised slider force `f`.
pub(super) fn along(element: &JenkinsElement, f: f64, path: &StepPath<'_>) -> Along {
    let stiffness = element.normalised_stiffness();
    let rate = stiffness * element.attachment.elongation(path.velocities);
    let acceleration = stiffness * element.attachment.elongation(path.accelerations);
    let turn = -rate / acceleration;
    let whole = path.duration;
    if turn > 0.0 && turn < whole {
        let (there, out) = monotone(f, rate, acceleration, turn);
        let (end, back) = monotone(there, 0.0, acceleration, whole - turn);
        return Along { end, mean: (out + back) / whole };
    }
    let (end, area) = monotone(f, rate, acceleration, whole);
    Along { end, mean: area / whole }
}

/// Slider force after a time in which `rate t + acceleration t^2/2` is monotone, and its integral.
fn monotone(f: f64, rate: f64, acceleration: f64, time: f64) -> (f64, f64) {
    let stuck = |t: f64| t * (f + t * (0.5 * rate + acceleration * t / 6.0));
    let gained = time * (rate + 0.5 * acceleration * time);
    let limit = if gained < 0.0 { -1.0 } else { 1.0 };
    if (f + gained) * limit <= 1.0 {
        return (f + gained, stuck(time));
    }
    // The first root of rate t + acceleration t^2/2 = room, in the form that does not cancel.
    let room = limit - f;
    let root = (rate * rate + 2.0 * acceleration * room).max(0.0).sqrt();
    let slip = if room == 0.0 { 0.0 } else { (2.0 * room / (rate + limit * root)).clamp(0.0, time) };
    (limit, stuck(slip) + limit * (time - slip))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Stiffness and slip force 2, so that the normalised stiffness is 1.
    fn element() -> JenkinsElement {
        JenkinsElement { attachment: Attachment::Ground(0), stiffness: 2.0, slip_force: 2.0 }
    }

    fn found(f: f64, rate: f64, acceleration: f64, duration: f64) -> [f64; 2] {
        let path = StepPath { velocities: &[rate], accelerations: &[acceleration], duration };
        let Along { end, mean } = along(&element(), f, &path);
        [end, mean]
    }

    #[test]
    fn simple_paths_have_the_means_found_by_hand() {
        assert_eq!(found(0.25, 0.5, 0.0, 1.0), [0.75, 0.5]);
        // Slips from t = 1 on: (3/4 + 1)/2.
        assert_eq!(found(0.5, 0.5, 0.0, 2.0), [1.0, 0.875]);
        assert_eq!(found(1.0, 1.0, 0.0, 3.0), [1.0, 1.0]);
        assert_eq!(found(-1.0, -1.0, -1.0, 3.0), [-1.0, -1.0]);
        // Slips out, turns at t = 1, and unloads by t^2/2: the mean is 1 - (1/6)/2.
        let [end, mean] = found(1.0, 1.0, -1.0, 2.0);
        assert!((end - 0.5).abs() < 1e-15 && (mean - (1.0 - 1.0 / 12.0)).abs() < 1e-15);
        assert_eq!(found(0.3, 0.0, 0.0, 2.0), [0.3, 0.3]);
    }

    #[test]
    fn the_mean_is_that_of_many_small_return_mappings() {
        for (f, rate, acceleration) in
            [(0.2, 1.3, -1.1), (-0.9, 2.0, -3.0), (0.9, -0.4, 2.5), (0.0, -3.0, 1.0), (1.0, 0.1, -5.0)]
        {
            let (steps, duration) = (20_000, 1.7);
            let d = duration / f64::from(steps);
            let (mut force, mut sum, mut u) = (f, 0.0, 0.0_f64);
            for k in 1..=steps {
                let t = f64::from(k) * d;
                let next = t * (rate + 0.5 * acceleration * t);
                let moved = (force + next - u).clamp(-1.0, 1.0);
                sum += 0.5 * d * (force + moved);
                (force, u) = (moved, next);
            }
            let [end, mean] = found(f, rate, acceleration, duration);
            // Turning points and corners missed by a small step: 8.5e-5 squared times rates of up to 10, and a part of a step at each corner.
            assert!(
                (end - force).abs() < 1e-6 && (mean - sum / duration).abs() < 1e-6,
                "{f} {rate}: {end} {force} {mean}"
            );
        }
    }
}
