//! What a figure or table is: what it needs, and what it leaves behind.

use super::check::Check;
use super::error::PaperError;
use crate::model::RigParameters;
use crate::report::Figure;
use crate::store::{Column, ColumnData, Table};
use serde::{Deserialize, Serialize};

/// How much is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Effort {
    /// As published.
    Full,
    /// Fewer points and shorter motions, to see in seconds that everything works.
    Quick,
}

/// The parameter set of a run; `xi1` is varied by the items.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Case {
    pub parameters: RigParameters,
    pub effort: Effort,
}

impl Case {
    /// Whether xi2, kappa and gamma are the paper's nominal ones.
    #[must_use]
    pub fn is_nominal(&self) -> bool {
        let (nominal, p) = (RigParameters::default(), self.parameters);
        (p.xi2, p.kappa, p.gamma) == (nominal.xi2, nominal.kappa, nominal.gamma)
    }

    #[must_use]
    pub fn at(&self, xi1: f64) -> RigParameters {
        RigParameters { xi1, ..self.parameters }
    }

    /// The check as it is for the nominal parameters, and not applicable for others.
    #[must_use]
    pub fn nominal_only(&self, check: Check) -> Check {
        if self.is_nominal() { check } else { Check { passed: None, ..check } }
    }

    /// `full`, or `quick` for a quick run.
    #[must_use]
    pub fn choose<T>(&self, full: T, quick: T) -> T {
        match self.effort {
            Effort::Full => full,
            Effort::Quick => quick,
        }
    }
}

/// Part of the page an item belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// As the paper calls it, such as `Fig. 5`.
    Paper(&'static str),
    /// Not in the paper.
    Beyond,
}

/// A figure or table.
#[derive(Debug, Clone, Copy)]
pub struct PaperItem {
    /// Name on the command line and of the files, such as `fig5`.
    pub id: &'static str,
    pub origin: Origin,
    pub title: &'static str,
    /// What is shown and how it was made, in our own words.
    pub caption: &'static str,
    /// Raised whenever the item's result changes, so that stored results are not taken for it.
    pub revision: u32,
    pub compute: fn(&Case) -> Result<Findings, PaperError>,
}

/// A named number for the page.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Number {
    pub name: String,
    pub value: String,
}

/// What an item found.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Findings {
    /// One line.
    pub verdict: String,
    pub checks: Vec<Check>,
    pub numbers: Vec<Number>,
    pub figure: Option<Figure>,
    /// Each becomes a CSV file: the first `ID.csv`, further ones `ID-NAME.csv`.
    pub tables: Vec<(String, Table)>,
}

impl Findings {
    pub fn number(&mut self, name: &str, value: impl std::fmt::Display) {
        self.numbers.push(Number { name: name.to_owned(), value: value.to_string() });
    }

    pub fn table(&mut self, name: &str, table: Table) {
        self.tables.push((name.to_owned(), table));
    }

    /// A table made with other parameters than the run's; its header names them instead. `xi1` is no part of it.
    pub fn table_at(&mut self, name: &str, parameters: RigParameters, mut table: Table) {
        table.metadata.push((PARAMETERS.to_owned(), described(parameters)));
        self.table(name, table);
    }
}

/// Key of the parameters in the header of a table.
pub(super) const PARAMETERS: &str = "parameters";

/// The parameters other than xi1, for the header of a table.
pub(super) fn described(RigParameters { xi2, kappa, gamma, .. }: RigParameters) -> String {
    format!("xi2 = {xi2}, kappa = {kappa}, gamma = {gamma}")
}

/// A table of non-dimensional numbers; values that are not finite are left out.
#[must_use]
pub fn numbers(columns: Vec<(&str, Vec<f64>)>) -> Table {
    let column = |(name, values): (&str, Vec<f64>)| {
        let finite = |v: f64| v.is_finite().then_some(v);
        let values = if values.iter().all(|v| v.is_finite()) {
            ColumnData::F64(values)
        } else {
            ColumnData::OptionalF64(values.into_iter().map(finite).collect())
        };
        Column { name: name.to_owned(), unit: "1".to_owned(), values }
    };
    Table { metadata: Vec::new(), columns: columns.into_iter().map(column).collect() }
}

/// The table with a column of words more.
#[must_use]
pub fn with_words(mut table: Table, name: &str, words: Vec<String>) -> Table {
    table.columns.push(Column { name: name.to_owned(), unit: String::new(), values: ColumnData::Text(words) });
    table
}
