//! A story: several scenes filmed one after the other, with cuts between them.

use super::case::Case;
use super::description::Scene;
use super::error::{Fault, Place, SceneError};
use super::load::line_at;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The story of the paper in about a minute, which comes with the program.
const BUILT_IN: &str = include_str!("../../stories/paper.toml");

/// Scenes in the order in which they are shown. All have pictures of one size and one frame rate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Story {
    pub scene: Vec<Scene>,
}

impl Story {
    /// The built-in story.
    ///
    /// # Errors
    /// Never in a released program: a test loads it.
    pub fn built_in() -> Result<Self, SceneError> {
        Self::parse(BUILT_IN, "paper (built in)")
    }

    /// Reads the story at `path`.
    ///
    /// # Errors
    /// [`SceneError`] with file and line; its scenes are checked by [`Story::cases`].
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        let text =
            std::fs::read_to_string(path).map_err(|source| SceneError::Unreadable { path: path.to_owned(), source })?;
        Self::parse(&text, &path.display().to_string())
    }

    fn parse(text: &str, origin: &str) -> Result<Self, SceneError> {
        toml::from_str(text).map_err(|error| SceneError::Syntax {
            origin: origin.to_owned(),
            line: error.span().map_or(1, |span| line_at(text, span.start)),
            message: error.to_string().trim_end().to_owned(),
        })
    }

    /// The scenes, checked; `origin` names the story in errors.
    ///
    /// # Errors
    /// [`SceneError::Parameter`] with the number of the scene (from 1) and its field; also for a story without scenes, and where sizes or
    /// frame rates differ.
    pub fn cases(&self, origin: &str) -> Result<Vec<Case>, SceneError> {
        let of = |number: usize| format!("{origin}, scene {}", number + 1);
        let refuse = |number: usize, field: &str, fault| SceneError::Parameter {
            origin: of(number),
            place: Place { line: None, field: field.to_owned() },
            fault,
        };
        let cases = self.scene.iter().enumerate().map(|(n, s)| s.checked(&of(n))).collect::<Result<Vec<Case>, _>>()?;
        let Some(first) = cases.first() else { return Err(refuse(0, "scene", Fault::EmptyStory)) };
        let format = |case: &Case| (case.film.width, case.film.height, case.film.fps, case.film.background);
        match cases.iter().position(|case| format(case) != format(first)) {
            Some(number) => Err(refuse(number, "film", Fault::OtherFormat)),
            None => Ok(cases),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_built_in_story_is_valid_and_lasts_a_minute() {
        let cases = Story::built_in().unwrap().cases("built in").unwrap();
        let seconds: f64 = cases.iter().map(|case| case.frame_count() as f64 / f64::from(case.film.fps)).sum();
        assert!((50.0..75.0).contains(&seconds), "{seconds} s");
    }

    #[test]
    fn scenes_of_different_formats_and_empty_stories_are_refused() {
        let message =
            |text: &str| Story::parse(text, "s").and_then(|s| s.cases("s").map(|_| ())).unwrap_err().to_string();
        let other = "[[scene]]\ntitle = \"a\"\n[[scene]]\ntitle = \"b\"\n[scene.film]\nfps = 25\n";
        assert!(message(other).contains("s, scene 2"), "{}", message(other));
        assert!(message("scene = []\n").contains("at least one"));
        assert!(message("[[scene]]\ntitle = \"a\"\n[scene.rig]\ngamma = 2.0\n").contains("scene 1, field rig.gamma"));
    }
}
