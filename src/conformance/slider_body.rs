//! Loop area of a Jenkins element (stiffness 1, slip force 1) whose slider has a mass m, in continuous time under `x =
//! a sin t`:
//!
//! ```text
//! m s'' = (x - s) - sgn s'  in slip,     s' = 0 while |x - s| <= 1
//! slip in the sense c = +-1 from rest at t0:   s = g sin t - c + C cos w(t - t0) + D sin w(t - t0),   w = 1/sqrt m,  g
//! = a/(1 - m)
//! ```
//!
//! It ends where s' = 0 again: in stick, or at once in the other sense if the spring pulls by more than 1. In a
//! periodic motion neither spring nor mass keep work, so that the loop area is what friction takes: the whole way of
//! the slider in a cycle. With m = 0 that is 4 (a - 1).

use std::f64::consts::{PI, TAU};

/// Cycles until the motion is periodic: what is left of the start falls by ten or more in each.
const CYCLES: u32 = 20;
/// Steps in a period of the slider's own oscillation, in which the end of slip is looked for. It lasts about half of
/// one at least.
const STEPS: f64 = 200.0;

struct Slider {
    amplitude: f64,
    mass: f64,
    time: f64,
    position: f64,
}

/// Area of the loop of the force `x - s` over x. Needs an amplitude above 1 and a mass between 0 and 1.
#[must_use]
pub fn loop_area(amplitude: f64, mass: f64) -> f64 {
    let mut slider = Slider { amplitude, mass, time: 0.0, position: 0.0 };
    let (mut way, mut cycle) = (0.0, 0);
    while cycle < CYCLES {
        let sense = slider.stick();
        // A slip belongs to the cycle in which it starts.
        let this = (slider.time / TAU) as u32;
        if this > cycle {
            cycle = this;
            if cycle == CYCLES {
                break;
            }
            way = 0.0;
        }
        way += slider.slip(sense);
    }
    way
}

impl Slider {
    fn pull(&self) -> f64 {
        self.amplitude * self.time.sin() - self.position
    }

    /// Waits until the spring pulls by 1, and returns in which sense.
    fn stick(&mut self) -> f64 {
        if self.pull().abs() > 1.0 {
            return self.pull().signum();
        }
        // It gets there while x rises with +1, and while x falls with -1.
        let next = |sense: f64| {
            let rising = ((self.position + sense) / self.amplitude).asin();
            let first = if sense > 0.0 { rising } else { PI - rising };
            let wait = (first - self.time).rem_euclid(TAU);
            // Positions out of reach have no arc sine.
            if wait.is_nan() { f64::INFINITY } else { wait }
        };
        let (up, down) = (next(1.0), next(-1.0));
        self.time += up.min(down);
        if up <= down { 1.0 } else { -1.0 }
    }

    /// Slips until it stops, and returns how far.
    fn slip(&mut self, sense: f64) -> f64 {
        let (w, g, t0) = (1.0 / self.mass.sqrt(), self.amplitude / (1.0 - self.mass), self.time);
        let (c, d) = (self.position - g * t0.sin() + sense, -g * t0.cos() / w);
        let position = |t: f64| g * t.sin() - sense + c * (w * (t - t0)).cos() + d * (w * (t - t0)).sin();
        let speed = |t: f64| sense * (g * t.cos() + w * (d * (w * (t - t0)).cos() - c * (w * (t - t0)).sin()));
        let step = TAU / w / STEPS;
        let (mut before, mut after) = (t0 + step, t0 + 2.0 * step);
        while speed(after) > 0.0 {
            (before, after) = (after, after + step);
        }
        // Bisection to the last bit.
        for _ in 0..60 {
            let middle = 0.5 * (before + after);
            if speed(middle) > 0.0 { before = middle } else { after = middle }
        }
        let start = std::mem::replace(&mut self.position, position(after));
        self.time = after;
        (self.position - start).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loop_areas_are_those_of_an_independent_integration() {
        // Computed outside the project with 25 digits, the area by quadrature over the phases of stick and slip:
        // 2.346318579, 2.034332918.
        assert!((loop_area(1.5, 0.01) - 2.346_318_579).abs() < 1e-8, "{}", loop_area(1.5, 0.01));
        assert!((loop_area(1.5, 0.001) - 2.034_332_918).abs() < 1e-8, "{}", loop_area(1.5, 0.001));
        // Without mass 4 (a - 1); the overshoot is of the order of the root of the mass.
        assert!((loop_area(1.5, 1e-8) - 2.0).abs() < 1e-3);
    }
}
