//! Any chain through a general ODE solver from a library (diffsol, Tsitouras 4(5)), restarted at every switch.
//!
//! Root functions, positive within a phase: `(1 + 1e-12)^2 - f^2` while sticking (the hair keeps a phase that starts at |f| = 1
//! from ending at once; it moves switches by 1e-12), `s b^T v` while slipping.

use diffsol::{NalgebraMat, OdeBuilder, OdeEquations, OdeSolverMethod, OdeSolverStopReason, Vector};
use stickslip::dynamics::State;
use stickslip::model::{Attachment, ContactState, Direction, OscillatorChain};

type Matrix = NalgebraMat<f64>;

/// State at `t_end` and the number of switches.
pub fn solve(chain: &OscillatorChain, initial: &State, t_end: f64, tolerance: f64) -> (State, usize) {
    let (n, m) = (chain.oscillators(), chain.sliders());
    let size = 2 * n + m;
    // Parameters of the solver: the state at the start of a phase, then a code per element: 0 stick, +1 or -1 slip.
    let code = |contact: &ContactState| match contact {
        ContactState::Stick => 0.0,
        ContactState::Slip(direction) => direction.sign(),
    };
    let mut parameters: Vec<f64> = initial.components().collect();
    parameters.extend(initial.initial_contacts(chain).iter().map(code));
    let system = FlatSystem::new(chain);
    let rhs = |y: &[f64], p: &[f64], out: &mut [f64]| {
        system.accelerations(y, out);
        for (j, element) in chain.jenkins().iter().enumerate() {
            let rate = element.normalised_stiffness() * element.attachment.elongation(&y[n..2 * n]);
            out[2 * n + j] = if p[size + j] == 0.0 { rate } else { 0.0 };
        }
    };
    let guards = |y: &[f64], p: &[f64], out: &mut [f64]| {
        for (j, element) in chain.jenkins().iter().enumerate() {
            let f = y[2 * n + j];
            out[j] = match p[size + j] {
                0.0 => (1.0 + 1e-12) * (1.0 + 1e-12) - f * f,
                side => side * element.attachment.elongation(&y[n..2 * n]),
            };
        }
    };
    let mut problem = OdeBuilder::<Matrix>::new()
        .rtol(tolerance)
        .atol([tolerance])
        .p(parameters.clone())
        .rhs(|y, p, _t, out| rhs(y, p, out))
        .init(move |p, _t, y| y.copy_from_slice(&p[..size]), size)
        .root(|y, p, _t, out| guards(y, p, out), m)
        .build()
        .unwrap();
    let mut switches = 0;
    while problem.t0 < t_end {
        let p = Vector::from_vec(parameters.clone(), *problem.context());
        problem.eqn.set_params(&p);
        let (time, element) = {
            let mut solver = problem.tsit45().unwrap();
            solver.set_stop_time(t_end).unwrap();
            loop {
                match solver.step().unwrap() {
                    OdeSolverStopReason::InternalTimestep => {}
                    OdeSolverStopReason::TstopReached => {
                        parameters[..size].copy_from_slice(solver.state().y.batch_as_slice(0));
                        break (t_end, None);
                    }
                    OdeSolverStopReason::RootFound(time, element) => {
                        parameters[..size].copy_from_slice(solver.interpolate(time).unwrap().batch_as_slice(0));
                        break (time, Some(element));
                    }
                }
            }
        };
        problem.t0 = time;
        if let Some(element) = element {
            switch(&mut parameters, 2 * n + element, size + element);
            switches += 1;
        }
    }
    let [positions, velocities, slider_forces] = [0..n, n..2 * n, 2 * n..size].map(|range| parameters[range].to_vec());
    (State { positions, velocities, slider_forces }, switches)
}

/// The equation of motion without allocation, so that a comparison of speed is fair.
struct FlatSystem<'a> {
    chain: &'a OscillatorChain,
    /// `-M^-1 K` and `-M^-1 (D + S)`, row by row.
    stiffness: Vec<f64>,
    damping: Vec<f64>,
}

impl<'a> FlatSystem<'a> {
    fn new(chain: &'a OscillatorChain) -> Self {
        let (n, damping) = (chain.oscillators(), chain.total_damping());
        let rows = |entry: &dyn Fn(usize, usize) -> f64| {
            (0..n * n).map(|k| -entry(k / n, k % n) / chain.mass()[k / n]).collect::<Vec<f64>>()
        };
        Self { chain, stiffness: rows(&|i, j| chain.stiffness()[(i, j)]), damping: rows(&|i, j| damping[(i, j)]) }
    }

    /// Writes `x' = v` and `v'` for `y = (x, v, f)`.
    fn accelerations(&self, y: &[f64], out: &mut [f64]) {
        let n = self.chain.oscillators();
        for i in 0..n {
            out[i] = y[n + i];
            let row = i * n..(i + 1) * n;
            let spring = self.stiffness[row.clone()].iter().zip(&y[..n]).map(|(k, x)| k * x).sum::<f64>();
            let damper = self.damping[row].iter().zip(&y[n..2 * n]).map(|(d, v)| d * v).sum::<f64>();
            out[n + i] = spring + damper;
        }
        for (element, f) in self.chain.jenkins().iter().zip(&y[2 * n..]) {
            let force = element.slip_force * f;
            let push = |i: usize, force: f64, out: &mut [f64]| out[n + i] -= force / self.chain.mass()[i];
            match element.attachment {
                Attachment::Ground(i) => push(i, force, out),
                Attachment::Between(i, j) => {
                    push(i, force, out);
                    push(j, -force, out);
                }
            }
        }
    }
}

fn switch(parameters: &mut [f64], force: usize, code: usize) {
    if parameters[code] == 0.0 {
        let side = Direction::of(parameters[force]).unwrap();
        (parameters[force], parameters[code]) = (side.sign(), side.sign());
    } else {
        parameters[code] = 0.0;
    }
}
