//! Reading scene files, and saying where in them a fault lies.

use super::case::Case;
use super::description::Scene;
use super::error::{Place, SceneError};
use std::path::Path;

/// The scene that runs when none is named, and the others that come with the program: name and text.
pub const BUILT_IN: [(&str, &str); 7] = [
    ("limit_torus", include_str!("../../scenes/limit_torus.toml")),
    ("limit_cycle", include_str!("../../scenes/limit_cycle.toml")),
    ("stick", include_str!("../../scenes/stick.toml")),
    ("chaos", include_str!("../../scenes/chaos.toml")),
    ("divergence", include_str!("../../scenes/divergence.toml")),
    ("sweep", include_str!("../../scenes/sweep.toml")),
    ("hysteresis", include_str!("../../scenes/hysteresis.toml")),
];

/// Scenes about bladed disks that come with the program.
pub const BUILT_IN_DISKS: [(&str, &str); 5] = [
    ("disk_forward_wave", include_str!("../../scenes/disk_forward_wave.toml")),
    ("disk_competition", include_str!("../../scenes/disk_competition.toml")),
    ("disk_mistuned", include_str!("../../scenes/disk_mistuned.toml")),
    ("disk_shroud", include_str!("../../scenes/disk_shroud.toml")),
    ("chain_100", include_str!("../../scenes/chain_100.toml")),
];

impl Scene {
    /// The built-in scene `limit_torus`.
    ///
    /// # Errors
    /// Never in a released program: a test loads every built-in scene.
    pub fn built_in() -> Result<(Self, Case), SceneError> {
        let (name, text) = BUILT_IN[0];
        Self::parse(text, &format!("{name} (built in)"))
    }

    /// Reads and checks the scene file at `path`.
    ///
    /// # Errors
    /// [`SceneError`] with file, line and field.
    pub fn load(path: &Path) -> Result<(Self, Case), SceneError> {
        let text =
            std::fs::read_to_string(path).map_err(|source| SceneError::Unreadable { path: path.to_owned(), source })?;
        Self::parse(&text, &path.display().to_string())
    }

    /// Parses and checks the text of a scene; `origin` names it in errors.
    ///
    /// # Errors
    /// [`SceneError`] with origin, line and field.
    pub fn parse(text: &str, origin: &str) -> Result<(Self, Case), SceneError> {
        let scene: Self = toml::from_str(text).map_err(|error| SceneError::Syntax {
            origin: origin.to_owned(),
            line: error.span().map_or(1, |span| line_at(text, span.start)),
            message: error.to_string().trim_end().to_owned(),
        })?;
        let case = scene.check(text, origin)?;
        Ok((scene, case))
    }

    /// Checks a scene whose fields may have been changed since it was read.
    ///
    /// # Errors
    /// [`SceneError::Parameter`] with `origin` and field.
    pub fn checked(&self, origin: &str) -> Result<Case, SceneError> {
        self.check("", origin)
    }

    /// `text` serves to find the line of a field at fault.
    fn check(&self, text: &str, origin: &str) -> Result<Case, SceneError> {
        self.resolve().map_err(|(field, fault)| SceneError::Parameter {
            origin: origin.to_owned(),
            place: Place { line: line_of(text, &field), field },
            fault,
        })
    }
}

/// Line (from 1) of a byte offset.
pub(super) fn line_at(text: &str, offset: usize) -> usize {
    text.as_bytes().iter().take(offset).filter(|byte| **byte == b'\n').count() + 1
}

/// Line on which the dotted field is given, if it is.
fn line_of(text: &str, field: &str) -> Option<usize> {
    let document = toml::de::DeTable::parse(text).ok()?;
    let mut table = document.get_ref();
    let mut line = None;
    for key in field.split('.') {
        // An entry of a list stands on the line where the list begins.
        let key = key.split('[').next().unwrap_or(key);
        let (name, value) = table.iter().find(|(name, _)| name.get_ref() == key)?;
        line = Some(line_at(text, name.span().start));
        match value.get_ref() {
            toml::de::DeValue::Table(inner) => table = inner,
            _ => break,
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> String {
        Scene::parse(text, "test.toml").unwrap_err().to_string()
    }

    #[test]
    fn faults_are_reported_with_file_line_and_field() {
        let found = message("title = \"x\"\n[rig]\nxi1 = -0.06\ngamma = 1.5\n");
        assert!(found.contains("test.toml, line 4, field rig.gamma"), "{found}");
        assert!(found.contains("gamma = 1.5 is not allowed"), "{found}");
        let found = message("title = \"x\"\n\n[engine]\ndt = 0.0\n");
        assert!(found.contains("line 4, field engine.dt"), "{found}");
        let found = message("title = \"x\"\n[rig]\nxi1 = nan\n");
        assert!(found.contains("line 3, field rig.xi1: xi1 = NaN"), "{found}");
    }

    #[test]
    fn unknown_fields_and_malformed_files_are_refused_with_their_line() {
        let found = message("title = \"x\"\n[rig]\nxi3 = 1.0\n");
        assert!(found.contains("line 3") && found.contains("xi3"), "{found}");
        let found = message("title = \"x\"\n[rig\n");
        assert!(found.contains("line 2"), "{found}");
        let found = message("title = \"x\"\n[film]\nfps = -3\n");
        assert!(found.contains("line 3"), "{found}");
    }

    #[test]
    fn two_rigs_are_one_too_many() {
        let si = "[rig_si]\nmass = 1.0\nground_stiffness = 1.0\njenkins_stiffness = 1.0\nslip_force = 1.0\n\
                  coupling_stiffness = 1.0\nground_damping = 0.0\ncoupling_damping = 0.0\n";
        assert!(message(&format!("title = \"x\"\n[rig]\n{si}")).contains("either [rig] or [rig_si]"));
    }

    #[test]
    fn an_si_scene_is_made_non_dimensional_with_its_own_scales() {
        // w0 = 20 rad/s, length unit 0.02 m.
        let text = "title = \"x\"\n[rig_si]\nmass = 2.0\nground_stiffness = 300.0\njenkins_stiffness = 500.0\n\
                    slip_force = 10.0\ncoupling_stiffness = 80.0\nground_damping = -2.4\ncoupling_damping = 1.42\n\
                    [initial]\nstart = \"state\"\nstate = [0.02, 0.01, 0.4, 0.0, 5.0]\n\
                    [simulation]\nduration = 8.0\n[film]\nspeed = 0.4\n";
        let (_, case) = Scene::parse(text, "si").unwrap();
        assert!((case.duration - 160.0).abs() < 1e-12);
        assert!((case.film.speed - 8.0).abs() < 1e-12);
        let crate::scene::Initial::State { state } = case.initial else { panic!("a state was given") };
        for (found, expected) in state.iter().zip([1.0, 0.5, 1.0, 0.0, 0.5]) {
            // A handful of roundings.
            assert!((found - expected).abs() < 1e-14);
        }
    }
}
