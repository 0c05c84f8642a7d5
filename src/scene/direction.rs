//! How a film looks at its motion: panels, camera, captions, slow motion. Times are seconds of film, angles degrees.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A live panel of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Panel {
    /// Displacements over time: of both masses, or of three blades.
    Series,
    /// Slider force over the displacement of mass 1, or over the elongation of one contact of a disk.
    Hysteresis,
    /// Velocity over displacement of mass 1, with the points of a Poincare section.
    Phase,
    /// Amplitude of mass 2 over that of mass 1; of a disk the amplitudes of its strongest waves over time.
    Amplitudes,
    /// Energy put in and taken out in the last period.
    Energy,
    /// Where the scene stands in the amplitude-damping diagram.
    Map,
    /// Disks: amplitude of every wave by nodal diameter, backward ones at the left and forward ones at the right.
    Spectrum,
    /// Disks: deflection of every blade over time, as colour.
    Carpet,
}

impl Panel {
    /// Those of the rig, in the order in which they stand where a scene does not say.
    pub const ALL: [Self; 6] = [Self::Series, Self::Hysteresis, Self::Phase, Self::Amplitudes, Self::Energy, Self::Map];

    /// Those of a bladed disk.
    pub const DISK: [Self; 6] =
        [Self::Carpet, Self::Spectrum, Self::Amplitudes, Self::Series, Self::Hysteresis, Self::Energy];
}

/// How the motion is shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Direction {
    /// Panels, at most six: up to three stand below the scene; of more the first three beside it, the others below; all below in an upright picture. Without it all of them, or for a prescribed motion those that say something about it. A disk has other panels than the rig.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub panels: Option<Vec<Panel>>,
    /// A disk is seen from higher up where none is given.
    pub camera: CameraMove,
    /// Captions by time; the scene's own caption stands where there is none.
    pub captions: Vec<Caption>,
    /// Stretches of the film that show the motion slower or faster, in order of time and apart from each other.
    pub slow_motion: Vec<SlowMotion>,
    /// Displacements are drawn this many times as large as fits between the parts of the rig or beside a disk. Above 1 the parts of the rig run into each other at the largest displacements of the film.
    pub magnification: f64,
}

impl Default for Direction {
    fn default() -> Self {
        Self {
            panels: None,
            camera: CameraMove::default(),
            captions: Vec::new(),
            slow_motion: Vec::new(),
            magnification: 1.0,
        }
    }
}

/// From where the rig is seen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct View {
    /// From the front towards the right.
    pub azimuth: f64,
    /// Above the horizon.
    pub elevation: f64,
    /// 1 shows the whole rig, 2 half of it.
    pub zoom: f64,
    /// From the middle of the rig to what is looked at: along the rail, up, towards the front. The rig is 6 long.
    pub shift: [f64; 3],
}

impl Default for View {
    fn default() -> Self {
        Self { azimuth: -15.5, elevation: 23.0, zoom: 1.0, shift: [0.0; 3] }
    }
}

/// How a movement begins and ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Easing {
    /// Gently.
    #[default]
    Smooth,
    /// At once, with constant speed.
    Linear,
    /// The old view stays until the new one's time: a cut.
    Cut,
}

impl Easing {
    /// Part of the way at a part of the time, both 0 to 1.
    fn part(self, time: f64) -> f64 {
        let time = time.clamp(0.0, 1.0);
        match self {
            Self::Smooth => time * time * (3.0 - 2.0 * time),
            Self::Linear => time,
            Self::Cut => time.floor(),
        }
    }
}

/// A view at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Key {
    pub at: f64,
    #[serde(default)]
    pub view: View,
    /// How the camera comes here from the key before.
    #[serde(default)]
    pub easing: Easing,
}

/// What the camera does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "move", rename_all = "snake_case", deny_unknown_fields)]
pub enum CameraMove {
    /// Stands still.
    Fixed {
        #[serde(default)]
        view: View,
    },
    /// Goes round the rig.
    Orbit {
        #[serde(default)]
        view: View,
        degrees_per_second: f64,
    },
    /// Goes from one view to another in the course of the film.
    Dolly {
        #[serde(default)]
        from: View,
        #[serde(default)]
        to: View,
        #[serde(default)]
        easing: Easing,
    },
    /// Goes through views at given times.
    Keyframes { keys: Vec<Key> },
}

impl Default for CameraMove {
    fn default() -> Self {
        Self::Fixed { view: View::default() }
    }
}

impl View {
    fn towards(&self, other: &Self, part: f64) -> Self {
        let mix = |a: f64, b: f64| a + part * (b - a);
        Self {
            azimuth: mix(self.azimuth, other.azimuth),
            elevation: mix(self.elevation, other.elevation),
            // Evenly to the eye: by factors.
            zoom: self.zoom * (other.zoom / self.zoom).powf(part),
            shift: std::array::from_fn(|axis| mix(self.shift[axis], other.shift[axis])),
        }
    }
}

impl CameraMove {
    /// The view at a time of a film of the given length.
    #[must_use]
    pub fn view(&self, time: f64, length: f64) -> View {
        match self {
            Self::Fixed { view } => *view,
            Self::Orbit { view, degrees_per_second } => {
                View { azimuth: view.azimuth + degrees_per_second * time, ..*view }
            }
            Self::Dolly { from, to, easing } => {
                let part = if length > 0.0 { time / length } else { 1.0 };
                from.towards(to, easing.part(part))
            }
            Self::Keyframes { keys } => {
                let after = keys.partition_point(|key| key.at <= time);
                match (after.checked_sub(1).map(|i| &keys[i]), keys.get(after)) {
                    (Some(last), Some(next)) => {
                        last.view.towards(&next.view, next.easing.part((time - last.at) / (next.at - last.at)))
                    }
                    (Some(only), None) | (None, Some(only)) => only.view,
                    (None, None) => View::default(),
                }
            }
        }
    }

    /// All views it is made of.
    fn views(&self) -> Vec<View> {
        match self {
            Self::Fixed { view } | Self::Orbit { view, .. } => vec![*view],
            Self::Dolly { from, to, .. } => vec![*from, *to],
            Self::Keyframes { keys } => keys.iter().map(|key| key.view).collect(),
        }
    }
}

/// Words under the headline for a while.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Caption {
    pub from: f64,
    pub to: f64,
    pub text: String,
}

/// A stretch of film in which the motion passes `factor` times as fast.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SlowMotion {
    pub from: f64,
    pub to: f64,
    pub factor: f64,
}

/// Field of the direction at fault and what it must be.
pub(super) type Fault = (&'static str, &'static str);

impl Direction {
    /// Seconds of film at the film's own speed that have passed of the motion after `time` seconds of film.
    #[must_use]
    pub fn elapsed(&self, time: f64) -> f64 {
        // Stretches lie apart, so their changes add up.
        let change = |s: &SlowMotion| (s.factor - 1.0) * (time.min(s.to) - s.from).max(0.0);
        time + self.slow_motion.iter().map(change).sum::<f64>()
    }

    /// Seconds of film after which `elapsed` seconds at the film's own speed have passed: the inverse of [`Self::elapsed`].
    #[must_use]
    pub fn film_time(&self, elapsed: f64) -> f64 {
        let (mut film, mut passed) = (0.0, 0.0);
        for s in &self.slow_motion {
            let before = passed + (s.from - film);
            if elapsed <= before {
                break;
            }
            let after = before + s.factor * (s.to - s.from);
            if elapsed <= after {
                return s.from + (elapsed - before) / s.factor;
            }
            (film, passed) = (s.to, after);
        }
        film + (elapsed - passed)
    }

    /// The caption at a time, and how far it has faded in, 0 to 1.
    #[must_use]
    pub fn caption(&self, time: f64) -> Option<(&str, f64)> {
        const FADE: f64 = 0.4;
        let caption = self.captions.iter().find(|caption| (caption.from..caption.to).contains(&time))?;
        let shown = ((time - caption.from) / FADE).min((caption.to - time) / FADE).clamp(0.0, 1.0);
        Some((&caption.text, shown))
    }

    /// `all` are the panels there are.
    pub(super) fn check(&self, all: &[Panel]) -> Result<(), Fault> {
        let require = |holds: bool, field, allowed| if holds { Ok(()) } else { Err((field, allowed)) };
        let chosen = self.panels.as_deref().unwrap_or_default();
        require(chosen.len() <= all.len(), "panels", "a list of at most 6 panels")?;
        let is_repeated = |(n, panel)| chosen[..n].contains(panel);
        require(!chosen.iter().enumerate().any(is_repeated), "panels", "a list that names each panel once")?;
        let known = chosen.iter().all(|panel| all.contains(panel));
        require(
            known,
            "panels",
            "made of panels of the rig (series, hysteresis, phase, amplitudes, energy, map) or, for a disk, of carpet, spectrum, amplitudes, series, hysteresis, energy",
        )?;
        let in_range = |view: &View| {
            view.azimuth.is_finite()
                && (0.0..=85.0).contains(&view.elevation)
                && (0.2..=20.0).contains(&view.zoom)
                && view.shift.iter().all(|shift| shift.abs() <= 10.0)
        };
        require(
            self.camera.views().iter().all(in_range),
            "camera",
            "made of views with elevation 0 to 85 degrees, zoom 0.2 to 20 and shifts up to 10",
        )?;
        if let CameraMove::Keyframes { keys } = &self.camera {
            let in_order = keys.windows(2).all(|pair| pair[0].at < pair[1].at) && keys.iter().all(|k| k.at >= 0.0);
            require(!keys.is_empty() && in_order, "camera.keys", "a list of keys at increasing times from 0 on")?;
        }
        if let CameraMove::Orbit { degrees_per_second, .. } = &self.camera {
            require(degrees_per_second.abs() <= 360.0, "camera.degrees_per_second", "from -360 to 360")?;
        }
        let lasting = |from: f64, to: f64| from >= 0.0 && from < to && to.is_finite();
        let following = self.captions.windows(2).all(|pair| pair[0].to <= pair[1].from);
        let sound = self.captions.iter().all(|c| lasting(c.from, c.to));
        require(following && sound, "captions", "a list in order of time, apart, 0 <= from < to")?;
        let slow = &self.slow_motion;
        let apart = slow.windows(2).all(|pair| pair[0].to <= pair[1].from);
        let sound = slow.iter().all(|s| lasting(s.from, s.to) && (0.001..=100.0).contains(&s.factor));
        require(apart && sound, "slow_motion", "a list in order of time, apart, 0 <= from < to, factor 0.001 to 100")?;
        require((0.05..=5.0).contains(&self.magnification), "magnification", "from 0.05 to 5")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slowed() -> Direction {
        let slow_motion =
            vec![SlowMotion { from: 2.0, to: 4.0, factor: 0.25 }, SlowMotion { from: 5.0, to: 6.0, factor: 3.0 }];
        Direction { slow_motion, ..Direction::default() }
    }

    /// 2 s as they are, 2 s at a quarter, 1 s as it is, 1 s at three times the speed.
    #[test]
    fn slow_motion_stretches_its_own_time_only_and_can_be_inverted() {
        let direction = slowed();
        for (film, expected) in [(1.0, 1.0), (2.0, 2.0), (3.0, 2.25), (4.0, 2.5), (5.0, 3.5), (5.5, 5.0), (7.0, 7.5)] {
            // Sums of a few numbers below 10.
            assert!((direction.elapsed(film) - expected).abs() < 1e-14, "{film}");
            assert!((direction.film_time(expected) - film).abs() < 1e-14, "{film}");
        }
        assert_eq!(Direction::default().film_time(7.25), 7.25);
    }

    #[test]
    fn a_dolly_starts_and_ends_at_its_views_and_eases_between() {
        let (from, to) = (View::default(), View { azimuth: 24.5, zoom: 4.0, ..View::default() });
        let dolly = CameraMove::Dolly { from, to, easing: Easing::Smooth };
        assert_eq!(dolly.view(0.0, 8.0), from);
        assert_eq!(dolly.view(8.0, 8.0).azimuth, to.azimuth);
        // Smoothstep: 5/32 after a quarter of the time; zoom by factors.
        assert!((dolly.view(2.0, 8.0).azimuth - (-15.5 + 40.0 * 5.0 / 32.0)).abs() < 1e-12);
        assert!((dolly.view(4.0, 8.0).zoom - 2.0).abs() < 1e-12);
    }

    #[test]
    fn keyframes_hold_before_the_first_and_after_the_last_and_cut_where_told() {
        let key = |at, azimuth, easing| Key { at, view: View { azimuth, ..View::default() }, easing };
        let keys = vec![key(1.0, 0.0, Easing::Smooth), key(3.0, 10.0, Easing::Linear), key(4.0, 50.0, Easing::Cut)];
        let camera = CameraMove::Keyframes { keys };
        let azimuth = |time| camera.view(time, 10.0).azimuth;
        assert_eq!([0.0, 1.0, 2.0, 3.0, 3.99, 4.0, 9.0].map(azimuth), [0.0, 0.0, 5.0, 10.0, 10.0, 50.0, 50.0]);
    }

    #[test]
    fn an_orbit_turns_evenly() {
        let orbit = CameraMove::Orbit { view: View::default(), degrees_per_second: 12.0 };
        assert_eq!(orbit.view(2.0, 10.0).azimuth, -15.5 + 24.0);
    }

    #[test]
    fn captions_come_and_go_at_their_times() {
        let captions = vec![Caption { from: 1.0, to: 3.0, text: "now".to_owned() }];
        let direction = Direction { captions, ..Direction::default() };
        assert_eq!(direction.caption(0.5), None);
        assert_eq!(direction.caption(2.0), Some(("now", 1.0)));
        let (_, shown) = direction.caption(1.1).unwrap();
        // A quarter of the fade.
        assert!((shown - 0.25).abs() < 1e-12);
        assert_eq!(direction.caption(3.0), None);
    }

    #[test]
    fn senseless_directions_are_refused_with_their_field() {
        let fault = |direction: Direction| direction.check(&Panel::ALL).unwrap_err().0;
        let view = View { zoom: f64::NAN, ..View::default() };
        assert_eq!(fault(Direction { camera: CameraMove::Fixed { view }, ..Direction::default() }), "camera");
        assert_eq!(
            fault(Direction { camera: CameraMove::Keyframes { keys: vec![] }, ..Direction::default() }),
            "camera.keys"
        );
        let mut overlapping = slowed();
        overlapping.slow_motion[1].from = 3.0;
        assert_eq!(fault(overlapping), "slow_motion");
        assert_eq!(fault(Direction { magnification: 0.0, ..Direction::default() }), "magnification");
        let captions = vec![Caption { from: 2.0, to: 1.0, text: String::new() }];
        assert_eq!(fault(Direction { captions, ..Direction::default() }), "captions");
        let caption = |from, to| Caption { from, to, text: String::new() };
        let captions = vec![caption(0.0, 2.0), caption(1.0, 3.0)];
        assert_eq!(fault(Direction { captions, ..Direction::default() }), "captions");
        let twice = Some(vec![Panel::Map, Panel::Series, Panel::Map]);
        assert_eq!(fault(Direction { panels: twice, ..Direction::default() }), "panels");
        assert!(slowed().check(&Panel::ALL).is_ok());
        let carpet = Direction { panels: Some(vec![Panel::Carpet]), ..Direction::default() };
        assert!(carpet.check(&Panel::DISK).is_ok());
        assert_eq!(fault(carpet), "panels");
    }
}
