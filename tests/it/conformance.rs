//! The conformance report on a small plan: the accepted numbers, what repeats, and what never passes.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use stickslip::conformance::{
    Archive, Baseline, Case, Changes, Configuration, ConformanceError, Depth, Fewest, Physics, Rapier, Report, Row,
    Scenario, Verdict, compute, html, markdown, registry, scenario_named,
};
use stickslip::engine::{Joints, Precision, Scheme};
use stickslip::store::{Existing, Origin, OutputDir};

/// One case of the named scenario with other steps.
pub fn case(scenario: &str, variant: &str, configuration: Configuration, steps: &[u32]) -> (Box<dyn Scenario>, Case) {
    let found = scenario_named(scenario).unwrap();
    let case = found
        .cases(Depth::Full)
        .into_iter()
        .find(|case| case.variant == variant && case.configuration == configuration);
    (found, Case { steps: steps.to_vec(), ..case.unwrap() })
}

pub fn rows(scenario: &str, variant: &str, configuration: Configuration, steps: &[u32]) -> Vec<Row> {
    let (scenario, case) = case(scenario, variant, configuration, steps);
    scenario.run(&case, &Rapier).unwrap()
}

const BESIDE: &str = "ten periods beside the cycle at xi1 = -0.06";

#[test]
fn numerical_damping_follows_its_formula_in_both_precisions_at_three_steps() {
    let mut judged = 0;
    for precision in [Precision::Single, Precision::Double] {
        for joints in [Joints::Impulse, Joints::Multibody] {
            for substeps in [1, 2, 4, 8] {
                let configuration = Configuration { precision, joints, substeps, ..Configuration::ENGINE_DEFAULTS };
                let rows = rows("linear_oscillator", "damping ratio 0", configuration, &[64, 256, 377]);
                for row in rows.iter().filter(|row| row.quantity == "numerical_damping") {
                    let (found, h) = (row.found.unwrap(), row.dt.unwrap());
                    // The formula written out here once more, for a frequency of 1.
                    let n = substeps as f64;
                    let formula = -h * (1.0 - (n + 1.0) / (2.0 * n));
                    assert_eq!(row.verdict, Verdict::Passed, "{row:?}");
                    // 2 %; where the formula gives zero, what f32 may round: 1e-6 per unit of time.
                    assert!((found - formula).abs() <= 0.02 * formula.abs() + 3e-6, "{found} for {formula}");
                    judged += 1;
                }
            }
        }
    }
    assert_eq!(judged, 2 * 2 * 4 * 3);
}

#[test]
fn the_second_order_scheme_is_of_second_order_in_state_frequency_damping_and_switching_time() {
    let steps = [64, 128, 256, 512, 1024, 2048];
    for precision in [Precision::Double, Precision::Single] {
        let configuration = Configuration { precision, ..Configuration::SAMPLED_FRICTION };
        let mut all = rows("linear_oscillator", "damping ratio 0.1", configuration, &steps);
        all.extend(rows("limit_cycle", BESIDE, configuration, &steps));
        let order = |quantity: &str, scenario: &str| {
            let wanted =
                |row: &&Row| row.quantity == quantity && row.scenario == scenario && row.steps_per_period.is_none();
            let row = all.iter().find(wanted).unwrap();
            println!("{precision:?} {quantity} {:?} floor {:?}", row.order, row.floor);
            assert_eq!(row.verdict, Verdict::Passed, "{row:?}");
            row.order.unwrap()
        };
        for (quantity, scenario) in [
            ("state_error", "linear_oscillator"),
            ("angular_frequency", "linear_oscillator"),
            ("damping", "linear_oscillator"),
            ("state_error", "limit_cycle"),
            ("switching_time", "limit_cycle"),
        ] {
            assert!((order(quantity, scenario) - 2.0).abs() <= 0.1, "{quantity}");
        }
        let failed: Vec<_> = all.iter().filter(|row| row.verdict == Verdict::Failed).collect();
        assert!(failed.is_empty(), "{failed:#?}");
    }
}

#[test]
fn what_is_as_predicted_may_be_physically_wrong() {
    let rows = rows("linear_oscillator", "damping ratio 0", Configuration::ENGINE_DEFAULTS, &[377]);
    let row = rows.iter().find(|row| row.quantity == "numerical_damping").unwrap();
    assert_eq!((row.verdict, row.physics), (Verdict::Passed, Physics::Wrong));
    // dt = 2 pi/377 against the engine's 1/60: 3e-6 apart in relation.
    assert!((row.dt.unwrap() - 1.0 / 60.0).abs() < 1e-6 && (row.found.unwrap() + 0.00625).abs() < 0.02 * 0.00625);
}

#[test]
fn at_the_defaults_a_torus_stands_where_the_exact_diagram_has_a_limit_cycle() {
    let defaults = Configuration { precision: Precision::Double, ..Configuration::ENGINE_DEFAULTS };
    let xi1 = "xi1 = -0.020";
    for (configuration, steps, physics) in
        [(defaults, 377, Physics::Wrong), (Configuration::AVERAGED_FRICTION, 256, Physics::Right)]
    {
        let rows = rows("amplitude_diagram", xi1, configuration, &[steps]);
        let row = |quantity: &str| rows.iter().find(|row| row.quantity == quantity).unwrap();
        let (largest, smallest) = (row("largest_maximum"), row("smallest_maximum"));
        for row in [largest, smallest] {
            assert_eq!((row.verdict, row.physics), (Verdict::Passed, physics), "{row:?}");
        }
        // The exact cycle is stable down to -0.0346: the 0.001 at the start does not grow.
        assert!((largest.exact.unwrap() - smallest.exact.unwrap()).abs() < 1e-3, "{largest:?}");
        let spread = largest.found.unwrap() - smallest.found.unwrap();
        assert_eq!(spread > 0.01, physics == Physics::Wrong, "{spread}");
    }
}

#[test]
fn short_scenarios_pass_in_the_second_order_scheme() {
    for (scenario, variant, steps) in [
        ("free_flight", "no force", [64, 256, 1024]),
        ("free_flight", "constant force 0.1", [64, 256, 1024]),
        ("negative_damping", "", [64, 256, 1024]),
        ("coupled_oscillators", "", [64, 256, 1024]),
        ("hysteresis", "", [66, 258, 1026]),
        ("friction_decay", "", [64, 256, 1024]),
        ("energy_ledger", "", [64, 256, 1024]),
        ("joint_drift", "", [64, 256, 1024]),
    ] {
        let rows = rows(scenario, variant, Configuration::SAMPLED_FRICTION, &steps);
        assert!(rows.iter().filter(|row| row.verdict == Verdict::Passed).count() >= 3, "{scenario}: {rows:#?}");
        let failed: Vec<_> = rows.iter().filter(|row| row.verdict == Verdict::Failed).collect();
        assert!(failed.is_empty(), "{failed:#?}");
    }
}

/// Two cases of a scenario at coarse steps, one of them beyond the quick run.
struct Small {
    computed: Arc<AtomicUsize>,
}

impl Scenario for Small {
    fn id(&self) -> &'static str {
        "free_flight"
    }
    fn title(&self) -> &'static str {
        "small"
    }
    fn description(&self) -> &'static str {
        "for the test"
    }
    fn reference(&self) -> &'static str {
        "closed form"
    }
    fn cases(&self, _: Depth) -> Vec<Case> {
        let plain = Configuration { scheme: Scheme::Plain, ..Configuration::SAMPLED_FRICTION };
        let fine = Configuration { substeps: 8, ..plain };
        let of = |configuration, depth| {
            let (_, case) = case("linear_oscillator", "damping ratio 0", configuration, &[32, 64, 128]);
            Case { depth, ..case }
        };
        vec![of(Configuration::SAMPLED_FRICTION, Depth::Quick), of(plain, Depth::Quick), of(fine, Depth::Full)]
    }
    fn run(&self, case: &Case, bench: &dyn stickslip::conformance::Bench) -> Result<Vec<Row>, ConformanceError> {
        self.computed.fetch_add(1, Ordering::SeqCst);
        scenario_named("linear_oscillator")?.run(case, bench)
    }
}

fn small() -> Vec<Box<dyn Scenario>> {
    vec![Box::new(Small { computed: Arc::default() })]
}

#[test]
fn rows_repeat_bit_by_bit_on_any_number_of_threads() {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let rows = pool.install(|| compute(&small(), Depth::Full, None, &Rapier, &|_, _| {})).unwrap();
        serde_json::to_string(&rows).unwrap()
    };
    let one = on(1);
    assert_eq!(one, on(3));
    assert!(one.matches("\"trajectory\":\"").count() >= 9, "hashes of all trajectories are in the rows");
}

#[test]
fn finished_cases_are_taken_over_unless_stale_or_damaged() {
    let folder = tempfile::tempdir().unwrap();
    let run = |program: &str| {
        let origin = Origin::new("test", serde_json::json!({}));
        let directory = OutputDir::open(folder.path(), &origin, Existing::Resume).unwrap();
        let computed = Arc::new(AtomicUsize::new(0));
        let scenarios: Vec<Box<dyn Scenario>> = vec![Box::new(Small { computed: Arc::clone(&computed) })];
        let archive = Archive { directory: &directory, program };
        let rows = compute(&scenarios, Depth::Quick, Some(archive), &Rapier, &|_, _| {}).unwrap();
        (serde_json::to_string(&rows).unwrap(), computed.load(Ordering::SeqCst))
    };
    let (first, computed) = run("one build");
    assert_eq!(computed, 2);
    assert_eq!(run("one build"), (first.clone(), 0), "nothing is computed twice");
    assert_eq!(run("another build"), (first.clone(), 2), "rows of another build are stale");
    let saved = std::fs::read_dir(folder.path().join("cases")).unwrap().next().unwrap().unwrap().path();
    let text = std::fs::read_to_string(&saved).unwrap();
    std::fs::write(&saved, text.replace("\"failed\"", "\"passed\"") + " ").unwrap();
    assert_eq!(run("another build"), (first.clone(), 1), "a file that was changed is not believed");
    std::fs::remove_file(&saved).unwrap();
    assert_eq!(run("another build"), (first, 1), "as after a kill");
}

fn small_report(depth: Depth) -> Report {
    let scenarios = small();
    let mut rows = compute(&scenarios, depth, None, &Rapier, &|_, _| {}).unwrap();
    rows.extend(self::rows("limit_cycle", BESIDE, Configuration::SAMPLED_FRICTION, &[64, 128, 256]));
    Report::new(&scenarios, depth, rows, None)
}

#[test]
fn what_was_not_run_is_said_and_never_passes() {
    let report = small_report(Depth::Quick);
    let left_out: Vec<&Row> = report.rows.iter().filter(|row| row.configuration.substeps == 8).collect();
    assert_eq!(left_out.len(), 1);
    assert_eq!((left_out[0].verdict, left_out[0].physics), (Verdict::NotRun, Physics::NotJudged));
    assert!(report.tally.not_run >= 1 && report.tally.failed == 0);
    assert!(
        report.advice.iter().all(|advice| advice.all == Fewest::NotRun),
        "no settled limit cycle was run: {:?}",
        report.advice
    );
    let page = html(&report, None).unwrap();
    assert!(page.contains("not run") && markdown(&report, None).contains("not run"));
}

#[test]
fn the_page_is_whole_in_itself_and_leads_with_the_answer() {
    let page = html(&small_report(Depth::Full), None).unwrap();
    assert!(page.contains("<!DOCTYPE html>") && page.contains("data:image/svg+xml;base64,"));
    for outside in ["src=\"http", "href=\"http", "url(http", "@import"] {
        assert!(!page.contains(outside), "{outside}");
    }
    let at = |text: &str| page.find(text).unwrap_or_else(|| panic!("{text} is missing"));
    assert!(at("behave as the theory") < at("<table") && at("<table") < at("How to read this</h2>"));
}

#[test]
fn the_page_is_readable_at_every_width_light_and_dark_with_all_tables_open() {
    let page = html(&small_report(Depth::Full), None).unwrap();
    let opened = page.replace("<details class=\"packed\">", "<details class=\"packed\" open>");
    assert!(opened.len() > page.len(), "there are packed tables");
    let complaint = r#"<script>if (document.querySelectorAll("details tbody tr").length < 9) console.error("rows are missing")</script>"#;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("report.html");
    std::fs::write(&path, opened + complaint).unwrap();
    let Some(seen) = super::browser::look_at(&path) else { return };
    assert_eq!(super::browser::faults(&seen), Vec::<String>::new());
}

#[test]
fn the_committed_schema_is_fresh_and_accepts_a_report() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/conformance.schema.json");
    let committed: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    assert!(
        committed == Report::json_schema(),
        "renew it: stickslip schema conformance > assets/conformance.schema.json"
    );
    let validator = jsonschema::validator_for(&committed).unwrap();
    let mut report = serde_json::to_value(small_report(Depth::Quick)).unwrap();
    assert!(validator.is_valid(&report), "{:?}", validator.iter_errors(&report).next().map(|error| error.to_string()));
    report["rows"][0]["verdict"] = serde_json::json!("fine");
    assert!(!validator.is_valid(&report));
}

#[test]
fn a_report_that_got_worse_is_noticed() {
    let old = small_report(Depth::Full);
    let between = |old: &Report, new: &Report| Changes::between(&Baseline::of(old), &Baseline::of(new));
    assert!(between(&old, &old).acceptable());
    let mut new = old.clone();
    let right = |row: &Row| row.physics == Physics::Right && row.trajectory.is_some();
    let i = new.rows.iter().position(right).unwrap();
    new.rows[i].physics = Physics::Wrong;
    new.rows[i].found = Some(10.0);
    new.rows[i].trajectory = Some("other".to_owned());
    let gone = new.rows.pop().unwrap();
    let changes = between(&old, &new);
    assert!(!changes.acceptable());
    assert_eq!(
        (changes.worse.len(), changes.other_trajectories, changes.better.len(), &changes.gone),
        (1, 1, 0, &vec![gone.identity()])
    );
    let back = between(&new, &old);
    assert_eq!((back.worse.len(), back.better.len(), &back.added), (0, 1, &vec![gone.identity()]));
    assert!(back.acceptable(), "a new row that passed is told only");
    let page = html(&new, Some(&changes)).unwrap();
    assert!(
        page.contains("Something got worse")
            && page.contains(&gone.quantity)
            && markdown(&new, Some(&changes)).contains("gone")
    );
}

#[test]
fn a_known_failure_passes_and_a_new_one_does_not() {
    let mut old = small_report(Depth::Full);
    let mut new = old.clone();
    let mut failed = old.rows[0].clone();
    failed.verdict = Verdict::Failed;
    failed.quantity = "something new".to_owned();
    new.rows.push(failed.clone());
    let changes = Changes::between(&Baseline::of(&old), &Baseline::of(&new));
    assert_eq!((changes.acceptable(), &changes.added_failed), (false, &vec![failed.identity()]));
    old.rows.push(failed);
    assert!(Changes::between(&Baseline::of(&old), &Baseline::of(&new)).acceptable());
}

#[test]
fn a_baseline_holds_what_is_compared_and_its_file_is_read_back() {
    let report = small_report(Depth::Quick);
    let baseline = Baseline::of(&report);
    let names: Vec<String> = baseline.named_rows().map(|(name, _)| name).collect();
    for row in &report.rows {
        let beyond = row.verdict == Verdict::NotRun && row.quantity == "all quantities";
        assert_eq!(names.contains(&row.identity()), !beyond, "{}", row.identity());
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("baseline.json");
    std::fs::write(&path, baseline.text()).unwrap();
    let read = Baseline::read(&path).unwrap();
    assert_eq!(read.text(), baseline.text());
    // Nine digits are kept, and no hashes: neither is a change.
    let changes = Changes::between(&read, &baseline);
    assert!(changes.acceptable() && changes.moved.is_empty() && changes.common == names.len(), "{changes:?}");
    std::fs::write(&path, serde_json::to_string(&report).unwrap()).unwrap();
    assert!(Changes::between(&Baseline::read(&path).unwrap(), &baseline).acceptable(), "a report.json does as well");
    std::fs::write(&path, "{}").unwrap();
    assert!(Baseline::read(&path).unwrap_err().to_string().contains("neither"));
}

/// What CI compares with must be of this engine and have its rows: a baseline without rows would accept everything.
#[test]
fn the_committed_baseline_is_of_this_engine_and_has_rows_of_every_scenario() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/conformance-baseline.json");
    let baseline = Baseline::read(std::path::Path::new(path)).unwrap();
    let renew = "renew it: stickslip conformance --quick --write-baseline assets/conformance-baseline.json";
    assert_eq!(baseline.parameters.depth, Depth::Quick);
    assert_eq!(baseline.engines, Report::new(&[], Depth::Quick, Vec::new(), None).engines, "{renew}");
    for scenario in registry() {
        let of = |(name, row): &(String, &stickslip::conformance::Known)| {
            name.starts_with(&format!("{} |", scenario.id())) && row.verdict == Verdict::Passed
        };
        assert!(baseline.named_rows().any(|row| of(&row)), "{}: {renew}", scenario.id());
    }
}

#[test]
fn every_scenario_describes_itself_and_has_quick_and_full_cases() {
    for scenario in registry() {
        assert!(!scenario.title().is_empty() && !scenario.description().is_empty() && !scenario.reference().is_empty());
        let cases = scenario.cases(Depth::Quick);
        assert!(cases.iter().any(|case| case.depth == Depth::Quick), "{}", scenario.id());
        assert!(cases.iter().all(|case| case.scenario == scenario.id() && !case.steps.is_empty()), "{}", scenario.id());
    }
    assert!(scenario_named("nothing").is_err());
}
