//! `--licences`: the notices of all that is in the program, as its licences demand.

use super::Verdict;
use super::common::print;

/// Made from Cargo.lock and the sources of the packages by `cargo run --example notice`.
const NOTICE: &str = include_str!("../../NOTICE");

pub fn run() -> anyhow::Result<Verdict> {
    print(NOTICE.trim_end())?;
    Ok(Verdict::Done)
}
