//! Set-ups and references as plain files for any other engine, and the scoring of what it made of them.
//!
//! `NAME.json` holds the equation of motion in matrices, the start, the sample times and what is judged; `NAME.csv` the exact motion at
//! these times. An engine writes its own motion with the columns `t, x1, ..., v1, ..., f1, ...` (velocities and slider forces may be left
//! out where nothing judged needs them) and is scored by [`score`].

mod motions;
mod score;
mod setup;
mod table;

pub use motions::setups;
pub use score::{Score, ScoreCheck};
pub use setup::{Element, Judged, Prescribed, Quantity, Setup, Start};
