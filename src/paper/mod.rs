//! The figures and the table of the paper, computed, checked and drawn.
//!
//! One file per figure: a [`PaperItem`] whose `compute` gives [`Findings`]: checks against stated expectations, tables, a figure, one
//! line of verdict. [`run`] computes items in parallel into an output directory and takes over finished ones; [`write_index`] makes the page.
//!
//! Expectations come from the paper, from theory or from computations outside this project, never from the code that is checked.
//! Those bound to the nominal parameters do not apply to others ([`Case::nominal_only`]).

mod basin;
mod check;
mod differences;
mod doubling;
mod error;
mod exact;
mod fig1;
mod fig10;
mod fig2;
mod fig3;
mod fig4;
mod fig5;
mod fig6;
mod fig7;
mod fig8;
mod fig9;
mod index;
mod item;
mod lyapunov;
mod rotation;
mod run;
mod schematic;
mod slow;
mod table1;

pub use check::{Check, Value};
pub use error::PaperError;
pub use index::write_index;
pub use item::{Case, Effort, Findings, Number, Origin, Overview, PaperItem, numbers, with_words};
pub use run::{ItemResult, News, run, stored};

/// All items in the order of the page.
pub const ITEMS: &[PaperItem] = &[
    fig1::ITEM,
    fig2::ITEM,
    fig3::ITEM,
    fig4::ITEM,
    fig5::ITEM,
    fig6::ITEM,
    fig7::ITEM,
    fig8::ITEM,
    table1::ITEM,
    fig9::ITEM,
    fig10::ITEM,
    lyapunov::ITEM,
    rotation::ITEM,
    doubling::ITEM,
    basin::ITEM,
];

/// The items with the given names in the order of the page; all for none.
///
/// # Errors
/// [`PaperError::UnknownItem`] with the names there are.
pub fn select(ids: &[String]) -> Result<Vec<&'static PaperItem>, PaperError> {
    if let Some(id) = ids.iter().find(|id| !ITEMS.iter().any(|item| item.id == *id)) {
        let known = ITEMS.iter().map(|item| item.id).collect::<Vec<_>>().join(", ");
        return Err(PaperError::UnknownItem { id: id.clone(), known });
    }
    Ok(ITEMS.iter().filter(|item| ids.is_empty() || ids.iter().any(|id| id == item.id)).collect())
}
