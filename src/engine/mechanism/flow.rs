//! Runs a [`MechanismRig`] and records every so many steps.

use super::kind::{ElementSpring, FrictionMechanism, LinearMechanism};
use super::plan::{self, CarriagePlan, NativeBlueprint, NativeWorld, SliderPlan, SpringPlan};
use super::rig::{Drive, FrictionElement, GroundSpring, MechanismRig};
use crate::dynamics::Outcome;
use crate::engine::force_law::{ForceLaw, Known, laws_of};
use crate::engine::geometry::JointDrift;
use crate::engine::settings::EngineSettings;
use crate::engine::{DEFAULT_AMPLITUDE_BOUND, EngineError, EngineInfo};
use crate::model::Range;
use std::sync::Arc;

/// A rig with native mechanisms, and how the engine is run.
#[derive(Debug, Clone)]
pub struct MechanismFlow {
    rig: MechanismRig,
    settings: EngineSettings,
    laws: Vec<Arc<dyn ForceLaw>>,
}

/// State at one time. Velocities are the engine's, brought to the time of the positions where the scheme asks for it.
#[derive(Debug, Clone, PartialEq)]
pub struct MechanismSample {
    pub time: f64,
    pub positions: Vec<f64>,
    pub velocities: Vec<f64>,
    pub slider: Option<SliderSample>,
}

/// The slider of a Jenkins element, as a body or as a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SliderSample {
    /// Displacement of the slider.
    pub position: f64,
    /// Force in the spring between carriage and slider, positive when it pulls the carriage back.
    pub force: f64,
}

/// What was recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct MechanismMotion {
    pub samples: Vec<MechanismSample>,
    /// Largest over all steps.
    pub drift: JointDrift,
    pub outcome: Outcome,
}

impl MechanismFlow {
    /// # Errors
    /// [`EngineError::Parameter`] for values outside their range, [`EngineError::Unavailable`] for mechanisms that Rapier does not have on
    /// such joints.
    pub fn new(rig: MechanismRig, settings: EngineSettings) -> Result<Self, EngineError> {
        let settings = settings.validated()?;
        let rig = rig.validated(settings.joints)?;
        let laws = laws_of(&rig.chain);
        Ok(Self { rig, settings, laws })
    }

    #[must_use]
    pub fn settings(&self) -> EngineSettings {
        self.settings
    }

    /// Name and version of the engine in use.
    #[must_use]
    pub fn engine(&self) -> EngineInfo {
        EngineInfo::of(self.settings.precision)
    }

    /// `steps` steps from the given positions and velocities of the carriages and the force of the Jenkins element, every `stride`-th
    /// recorded. The velocities are handed to the engine as they are.
    ///
    /// # Errors
    /// [`EngineError::Parameter`] if the lengths do not fit, and what the engine reports on the way.
    pub fn run(&self, start: &MechanismSample, steps: u64, stride: u64) -> Result<MechanismMotion, EngineError> {
        let mut run = Run::start(self, start)?;
        let mut motion =
            MechanismMotion { samples: vec![run.sample()], drift: JointDrift::default(), outcome: Outcome::Completed };
        for n in 0..steps {
            run.step(n)?;
            motion.drift = motion.drift.or_larger(run.world.drift());
            if run.positions.iter().any(|x| x.abs() > DEFAULT_AMPLITUDE_BOUND) {
                motion.outcome = Outcome::Diverged { time: run.time, bound: DEFAULT_AMPLITUDE_BOUND };
                return Ok(motion);
            }
            if (n + 1).is_multiple_of(stride.max(1)) {
                motion.samples.push(run.sample());
            }
        }
        Ok(motion)
    }

    /// The element, if its slider is a body.
    fn slider_body(&self) -> Option<&FrictionElement> {
        self.rig.friction.as_ref().filter(|element| element.mechanism.has_slider_body())
    }
}

impl MechanismSample {
    /// A start of one carriage, without force in the Jenkins element.
    #[must_use]
    pub fn single(position: f64, velocity: f64) -> Self {
        Self::at(vec![position], vec![velocity], 0.0)
    }

    /// A start at time 0 with the force `force` in the Jenkins element.
    #[must_use]
    pub fn at(positions: Vec<f64>, velocities: Vec<f64>, force: f64) -> Self {
        let slider = Some(SliderSample { position: 0.0, force });
        Self { time: 0.0, positions, velocities, slider }
    }
}

/// A motion under way; slices hold the carriages, then the slider body.
struct Run<'a> {
    flow: &'a MechanismFlow,
    world: Box<dyn NativeWorld>,
    time: f64,
    positions: Vec<f64>,
    /// The engine's velocities, now and one step ago.
    velocities: Vec<f64>,
    before: Vec<f64>,
    forces: Vec<f64>,
    /// Slider of the hook.
    hook_slider: f64,
}

impl<'a> Run<'a> {
    fn start(flow: &'a MechanismFlow, start: &MechanismSample) -> Result<Self, EngineError> {
        let count = flow.rig.chain.oscillators();
        for (field, values) in [("positions", &start.positions), ("velocities", &start.velocities)] {
            if values.len() != count {
                let (found, expected) = (values.len(), count);
                let wrong = crate::dynamics::StateError::WrongLength { field, found, expected, per: "carriage" };
                return Err(wrong.into());
            }
            for (i, &value) in values.iter().enumerate() {
                Range::Finite.check(format!("{field}[{i}]"), value)?;
            }
        }
        let (mut positions, mut velocities) = (start.positions.clone(), start.velocities.clone());
        let force = start.slider.map_or(0.0, |slider| slider.force);
        let slider_at = |element: &FrictionElement| start.positions[element.carriage] - force / element.stiffness;
        let hook_slider = flow.rig.friction.as_ref().map_or(0.0, slider_at);
        if flow.slider_body().is_some() {
            positions.push(hook_slider);
            velocities.push(0.0);
        }
        let carriages: Vec<CarriagePlan> = (0..count).map(|i| carriage_plan(flow, start, i)).collect();
        let slider = flow.slider_body().map(|element| slider_plan(element, hook_slider));
        let blueprint =
            NativeBlueprint { settings: flow.settings, solver: flow.rig.solver, carriages: &carriages, slider };
        let world = plan::build(&blueprint)?;
        let forces = vec![0.0; positions.len()];
        Ok(Self { flow, world, time: 0.0, positions, before: velocities.clone(), velocities, forces, hook_slider })
    }

    fn step(&mut self, n: u64) -> Result<(), EngineError> {
        self.find_forces();
        let time = (n + 1) as f64 * self.flow.settings.step;
        if let Some(oscillator) = self.forces.iter().position(|force| !force.is_finite()) {
            let found = self.forces[oscillator];
            return Err(EngineError::ForceNotFinite { time: self.time, oscillator, found });
        }
        let target = match self.flow.rig.drive {
            Drive::Free => None,
            Drive::Prescribed(motion) => Some(motion.position(time)),
            Drive::Held => Some(self.positions[0]),
        };
        self.world.step(&self.forces, target).map_err(|found| EngineError::Quarantined { time, found })?;
        self.time = time;
        std::mem::swap(&mut self.before, &mut self.velocities);
        self.world.read(&mut self.positions, &mut self.velocities);
        if let Some(oscillator) = self.positions.iter().position(|x| !x.is_finite()) {
            return Err(EngineError::MotionNotFinite { time, oscillator, found: self.positions[oscillator] });
        }
        self.move_hook_slider();
        Ok(())
    }

    /// Everything that is not native.
    fn find_forces(&mut self) {
        let velocities = self.known_velocities();
        let count = self.flow.rig.chain.oscillators();
        self.forces.fill(0.0);
        let known = Known {
            time: self.time,
            positions: &self.positions[..count],
            velocities: &velocities[..count],
            slider_forces: &[],
        };
        for law in &self.flow.laws {
            law.add_force(&known, &mut self.forces[..count]);
        }
        for spring in self.flow.rig.springs.iter().filter(|s| s.mechanism == LinearMechanism::Hook) {
            let GroundSpring { carriage, stiffness, damping, .. } = *spring;
            self.forces[carriage] -= stiffness * self.positions[carriage] + damping * velocities[carriage];
        }
        if let Some(element) = &self.flow.rig.friction {
            let hooked = match element.mechanism {
                FrictionMechanism::Hook => true,
                FrictionMechanism::SaturatingMotor => false,
                _ => element.spring == ElementSpring::Hook,
            };
            if hooked {
                let force = self.element_force(element);
                self.forces[element.carriage] -= force;
                if let Some(slider) = self.forces.get_mut(count) {
                    *slider += force;
                }
            }
        }
    }

    /// At the time of the positions, as well as they are known: carried on by the acceleration over the last step.
    fn known_velocities(&self) -> Vec<f64> {
        let lead = self.flow.settings.stagger() / self.flow.settings.step;
        self.velocities.iter().zip(&self.before).map(|(now, before)| now + lead * (now - before)).collect()
    }

    fn slider_position(&self) -> f64 {
        self.positions.get(self.flow.rig.chain.oscillators()).copied().unwrap_or(self.hook_slider)
    }

    fn element_force(&self, element: &FrictionElement) -> f64 {
        let x = self.positions[element.carriage];
        match element.mechanism {
            // What the motor is told to exert; its slider stays where it started.
            FrictionMechanism::SaturatingMotor => {
                (element.stiffness * x).clamp(-element.slip_force, element.slip_force)
            }
            _ => element.stiffness * (x - self.slider_position()),
        }
    }

    /// Return mapping: the slider follows as far as the slip force leaves behind.
    fn move_hook_slider(&mut self) {
        if let Some(element) = &self.flow.rig.friction
            && element.mechanism == FrictionMechanism::Hook
        {
            let reach = element.slip_force / element.stiffness;
            let x = self.positions[element.carriage];
            self.hook_slider = self.hook_slider.clamp(x - reach, x + reach);
        }
    }

    fn sample(&self) -> MechanismSample {
        let count = self.flow.rig.chain.oscillators();
        let slider = self.flow.rig.friction.as_ref().map(|element| SliderSample {
            position: match element.mechanism {
                FrictionMechanism::SaturatingMotor => 0.0,
                _ => self.slider_position(),
            },
            force: self.element_force(element),
        });
        MechanismSample {
            time: self.time,
            positions: self.positions[..count].to_vec(),
            velocities: self.known_velocities()[..count].to_vec(),
            slider,
        }
    }
}

fn carriage_plan(flow: &MechanismFlow, start: &MechanismSample, index: usize) -> CarriagePlan {
    let native = |spring: &&GroundSpring| spring.carriage == index && spring.mechanism != LinearMechanism::Hook;
    let spring = flow.rig.springs.iter().find(native).map(|spring| SpringPlan {
        mechanism: spring.mechanism,
        stiffness: spring.stiffness,
        damping: spring.damping,
        max_force: None,
    });
    let saturating = flow
        .rig
        .friction
        .as_ref()
        .filter(|element| element.carriage == index && element.mechanism == FrictionMechanism::SaturatingMotor);
    let saturating = saturating.map(|element| SpringPlan {
        mechanism: LinearMechanism::MotorForceBased,
        stiffness: element.stiffness,
        damping: 0.0,
        max_force: Some(element.slip_force),
    });
    CarriagePlan {
        mass: flow.rig.chain.mass()[index],
        position: start.positions[index],
        velocity: start.velocities[index],
        driven: index == 0 && flow.rig.drive != Drive::Free,
        spring: spring.or(saturating),
    }
}

fn slider_plan(element: &FrictionElement, position: f64) -> SliderPlan {
    SliderPlan {
        carriage: element.carriage,
        mass: element.slider_mass,
        position,
        velocity: 0.0,
        slip_force: element.slip_force,
        mechanism: element.mechanism,
        native_spring: (element.spring == ElementSpring::SpringJoint).then_some(element.stiffness),
    }
}
