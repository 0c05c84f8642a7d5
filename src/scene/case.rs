//! A scene made ready: validated, non-dimensional, with the units to go back.

use super::description::{DEFAULT_AMPLITUDE_BOUND, DEFAULT_PERTURBATION, Engine, Film, Initial, MotionKind, Scene};
use super::direction::{Direction, Panel};
use super::disk::DiskCase;
use super::error::{Fault, Place, SceneError};
use super::ramp::{Excitation, Ramp};
use crate::model::{ParameterError, PrescribedMotion, Range, RigParameters, Scales};
use serde::{Deserialize, Serialize};

/// More frames than an hour at 60 frames a second are a mistake in `speed`.
const MAX_FRAMES: u64 = 216_000;
/// Largest side of a picture, pixels: 8K.
const MAX_SIDE: u64 = 7680;

/// A scene with every number checked and non-dimensional. Multiply by [`Scales`] to return to the units of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Case {
    pub title: String,
    pub caption: String,
    pub parameters: RigParameters,
    /// Unity for a non-dimensional scene.
    pub scales: Scales,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ramp: Option<Ramp>,
    pub initial: Initial,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prescribed: Option<PrescribedMotion>,
    /// A bladed disk; `parameters` and `initial` mean nothing then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disk: Option<DiskCase>,
    pub duration: f64,
    pub amplitude_bound: f64,
    pub engine: Engine,
    /// Longest step of the engine; the one taken may be shorter, to divide the time between two samples.
    pub longest_step: f64,
    /// States are compared up to here.
    pub horizon: f64,
    pub motion: MotionKind,
    pub film: Film,
    #[serde(default)]
    pub direction: Direction,
}

/// The path of the field at fault, and the fault.
pub(super) type Refusal = (String, Fault);

fn checked(range: Range, path: &'static str, value: f64) -> Result<f64, Refusal> {
    let name = path.rsplit('.').next().unwrap_or(path);
    range.check(name, value).map_err(|fault| (path.to_owned(), fault.into()))
}

fn whole(path: &'static str, found: u64, least: u64, most: u64, allowed: &'static str) -> Result<(), Refusal> {
    let field = path.rsplit('.').next().unwrap_or(path);
    if (least..=most).contains(&found) {
        Ok(())
    } else {
        Err((path.to_owned(), Fault::Whole { field, found, allowed }))
    }
}

/// Prefixes the field of a parameter error with its table.
fn within(table: &'static str) -> impl Fn(ParameterError) -> Refusal {
    move |fault| match &fault {
        ParameterError::OutOfRange { field, .. } => (format!("{table}.{field}"), fault.into()),
        _ => (table.to_owned(), fault.into()),
    }
}

impl Scene {
    pub(super) fn resolve(&self) -> Result<Case, Refusal> {
        let (parameters, scales) = self.rig_and_scales()?;
        let duration = checked(Range::Positive, "simulation.duration", self.simulation.duration)? / scales.time;
        let amplitude_bound = match self.simulation.amplitude_bound {
            Some(bound) => checked(Range::Positive, "simulation.amplitude_bound", bound)? / scales.length,
            None => DEFAULT_AMPLITUDE_BOUND,
        };
        let horizon = match self.check.horizon {
            Some(horizon) => (checked(Range::Positive, "check.horizon", horizon)? / scales.time).min(duration),
            None => duration,
        };
        let case = Case {
            title: self.title.clone(),
            caption: self.caption.clone(),
            parameters,
            scales,
            ramp: self.checked_ramp(&parameters)?,
            initial: self.initial_state(&scales)?,
            prescribed: self.prescribed_motion(&scales)?,
            disk: self.disk_case()?,
            duration,
            amplitude_bound,
            engine: self.engine,
            longest_step: self.step(&scales)?,
            horizon,
            motion: self.check.motion,
            film: film_settings(self.film, &scales)?,
            direction: self.checked_direction()?,
        };
        case.check_lengths()?;
        Ok(case)
    }

    fn rig_and_scales(&self) -> Result<(RigParameters, Scales), Refusal> {
        match (self.rig, self.rig_si) {
            (Some(_), Some(_)) => Err(("rig_si".to_owned(), Fault::TwoRigs)),
            (None, Some(rig)) => {
                Ok((rig.parameters().map_err(within("rig_si"))?, rig.scales().map_err(within("rig_si"))?))
            }
            (rig, None) => Ok((rig.unwrap_or_default().validated().map_err(within("rig"))?, Scales::UNITY)),
        }
    }

    fn initial_state(&self, scales: &Scales) -> Result<Initial, Refusal> {
        match self.initial {
            Initial::LimitCycle { perturbation } => {
                let perturbation = match perturbation {
                    Some(given) => checked(Range::Finite, "initial.perturbation", given)? / scales.length,
                    None => DEFAULT_PERTURBATION,
                };
                Ok(Initial::LimitCycle { perturbation: Some(perturbation) })
            }
            Initial::State { state } => {
                for value in state {
                    checked(Range::Finite, "initial.state", value)?;
                }
                if state[4].abs() > scales.slip_force {
                    let fault = Fault::BeyondSlipForce { found: state[4], allowed: scales.slip_force };
                    return Err(("initial.state".to_owned(), fault));
                }
                let units = [scales.length, scales.length, scales.velocity, scales.velocity, scales.slip_force];
                Ok(Initial::State { state: std::array::from_fn(|i| state[i] / units[i]) })
            }
        }
    }

    fn checked_ramp(&self, parameters: &RigParameters) -> Result<Option<Ramp>, Refusal> {
        let Some(ramp) = self.ramp else { return Ok(None) };
        if self.rig_si.is_some() || self.prescribed.is_some() {
            return Err(("ramp".to_owned(), Fault::RampOfWhat));
        }
        let end = RigParameters { xi1: ramp.xi1_end, ..*parameters };
        end.validated().map_err(|fault| ("ramp.xi1_end".to_owned(), fault.into()))?;
        checked(Range::Positive, "ramp.hold", ramp.hold)?;
        Ok(Some(ramp))
    }

    fn checked_direction(&self) -> Result<Direction, Refusal> {
        let fault = |(field, allowed)| (format!("direction.{field}"), Fault::Direction { field, allowed });
        let all = if self.disk.is_some() { &Panel::DISK } else { &Panel::ALL };
        self.direction.check(all).map_err(fault)?;
        Ok(self.direction.clone())
    }

    fn prescribed_motion(&self, scales: &Scales) -> Result<Option<PrescribedMotion>, Refusal> {
        let Some(motion) = self.prescribed else { return Ok(None) };
        let PrescribedMotion { amplitude, angular_frequency } = motion.validated().map_err(within("prescribed"))?;
        Ok(Some(PrescribedMotion {
            amplitude: amplitude / scales.length,
            angular_frequency: angular_frequency * scales.time,
        }))
    }

    fn step(&self, scales: &Scales) -> Result<f64, Refusal> {
        whole("engine.substeps", self.engine.substeps as u64, 1, 64, "1 to 64")?;
        match self.engine.dt {
            Some(dt) => Ok(checked(Range::Positive, "engine.dt", dt)? / scales.time),
            None => {
                let steps = checked(Range::Positive, "engine.steps_per_period", self.engine.steps_per_period)?;
                Ok(std::f64::consts::TAU / steps)
            }
        }
    }
}

/// The film with its speed made non-dimensional.
fn film_settings(film: Film, scales: &Scales) -> Result<Film, Refusal> {
    for (path, side) in [("film.width", film.width), ("film.height", film.height)] {
        whole(path, side.into(), 64, MAX_SIDE, "from 64 to 7680")?;
    }
    whole("film.fps", film.fps.into(), 1, 240, "1 to 240")?;
    let speed = checked(Range::Positive, "film.speed", film.speed)? / scales.time;
    Ok(Film { speed, ..film })
}

impl Case {
    /// The self-excitation over the time of the motion.
    #[must_use]
    pub fn excitation(&self) -> Excitation {
        Excitation { start: self.parameters.xi1, duration: self.duration, ramp: self.ramp }
    }

    /// The panels of the film: those asked for, or all that say something about the motion.
    #[must_use]
    pub fn panels(&self) -> &[Panel] {
        match (&self.direction.panels, self.prescribed) {
            (Some(panels), _) => panels,
            (None, None) if self.disk.is_some() => &Panel::DISK,
            (None, None) => &Panel::ALL,
            (None, Some(_)) => &[Panel::Hysteresis, Panel::Series, Panel::Energy],
        }
    }

    /// Time between two frames.
    #[must_use]
    pub fn frame_interval(&self) -> f64 {
        self.film.speed / f64::from(self.film.fps)
    }

    /// Time of the motion that frame `index` shows.
    #[must_use]
    pub fn motion_time(&self, index: u64) -> f64 {
        if self.direction.slow_motion.is_empty() {
            return index as f64 * self.frame_interval();
        }
        self.film.speed * self.direction.elapsed(index as f64 / f64::from(self.film.fps))
    }

    /// Frames that show the motion up to `end`: one at time 0, the last one not after the end.
    #[must_use]
    pub fn frames_until(&self, end: f64) -> u64 {
        // A frame that rounding puts just after the end still belongs to the film.
        (self.frame_position(end) + 1e-9).floor() as u64 + 1
    }

    /// Number of the frame, with its fraction, that shows the motion at `time`.
    fn frame_position(&self, time: f64) -> f64 {
        self.direction.film_time(time / self.film.speed) * f64::from(self.film.fps)
    }

    /// Frames in the whole film.
    #[must_use]
    pub fn frame_count(&self) -> u64 {
        self.frames_until(self.duration)
    }

    /// The same case with another film, its speed in the units of the scene; `origin` names the film in errors.
    ///
    /// # Errors
    /// [`SceneError::Parameter`] with the field of the film at fault.
    pub fn refilmed(self, film: Film, origin: &str) -> Result<Self, SceneError> {
        let refuse = |(field, fault): Refusal| SceneError::Parameter {
            origin: origin.to_owned(),
            place: Place { line: None, field },
            fault,
        };
        let case = Self { film: film_settings(film, &self.scales).map_err(refuse)?, ..self };
        case.check_lengths().map_err(refuse)?;
        Ok(case)
    }

    fn check_lengths(&self) -> Result<(), Refusal> {
        let frames = self.frame_position(self.duration);
        if frames > MAX_FRAMES as f64 {
            return Err(("film.speed".to_owned(), Fault::FrameCount { found: frames, allowed: MAX_FRAMES }));
        }
        Ok(())
    }
}
