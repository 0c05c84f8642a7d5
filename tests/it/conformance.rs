//! The conformance report, on a small plan.

use stickslip::conformance::{Depth, Rapier, Verdict, registry};

#[test]
fn explore() {
    for scenario in registry() {
        for case in scenario.cases(Depth::Quick).into_iter().filter(|case| case.depth == Depth::Quick) {
            let rows = scenario.run(&case, &Rapier).unwrap();
            for row in rows {
                if row.verdict == Verdict::Passed && row.steps_per_period.is_some() {
                    continue;
                }
                println!(
                    "{:?} {:?} {} exp {:?} found {:?} tol {:?} exact {:?} order {:?} fl {:?} {}",
                    row.verdict,
                    row.physics,
                    row.identity(),
                    row.expected,
                    row.found,
                    row.tolerance,
                    row.exact,
                    row.order,
                    row.floor,
                    if row.verdict == Verdict::NotRun { row.reason.as_str() } else { "" }
                );
            }
        }
    }
}
