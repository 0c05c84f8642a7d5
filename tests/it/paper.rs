//! The command that reproduces the paper, as a user meets it, and its checks, which must be able to fail.

use crate::cli::{document, refused};
use assert_cmd::Command;
use std::fs;
use std::path::Path;
use stickslip::model::RigParameters;
use stickslip::paper::{
    Case, Check, Effort, Findings, ITEMS, Origin as Place, PaperError, PaperItem, numbers, run, write_index,
};
use stickslip::store::{Existing, Origin, OutputDir};

/// Standard error of a run that must succeed.
fn news(args: &[&str]) -> String {
    let output = Command::cargo_bin("stickslip").unwrap().args(args).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{args:?}: {said}");
    said
}

#[test]
fn quick_items_pass_their_checks_and_leave_data_pictures_and_a_page() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_str().unwrap();
    let json = document(&["paper", "--quick", "--only", "fig2,fig5", "-o", path, "--json"]);
    let items = json["items"].as_array().unwrap();
    assert_eq!(items.iter().map(|item| item["id"].as_str().unwrap()).collect::<Vec<_>>(), ["fig2", "fig5"]);
    for item in items {
        assert_eq!(item["passed"], true, "{item}");
        assert!(item["checks"].as_array().unwrap().len() >= 3);
        for check in item["checks"].as_array().unwrap() {
            assert!(
                ["name", "expected", "found", "tolerance", "passed", "reason"]
                    .iter()
                    .all(|key| check.get(key).is_some())
            );
            assert!(!check["reason"].as_str().unwrap().is_empty());
        }
        for file in item["files"].as_array().unwrap() {
            assert!(folder.path().join(file.as_str().unwrap()).exists());
        }
    }
    let table = fs::read_to_string(folder.path().join("fig2.csv")).unwrap();
    assert!(table.contains("# parameters: xi2 = 0.011, kappa = 0.1, gamma = 0.5") && table.contains("x1 [1]"));
    let page = fs::read_to_string(folder.path().join("index.html")).unwrap();
    assert!(page.contains("Where we differ") && page.contains("A quick run"));
    assert_eq!(page.matches("<img").count(), 2);
}

#[test]
fn finished_items_are_kept_and_damaged_ones_made_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_str().unwrap();
    let only = |ids: &str| news(&["paper", "--quick", "--only", ids, "-o", path]);
    assert!(only("fig2").contains("fig2 done"));
    let before = fs::read(folder.path().join("fig2.svg")).unwrap();
    assert!(only("fig2").contains("fig2 kept"));
    fs::write(folder.path().join("fig2.svg"), "damaged").unwrap();
    assert!(only("fig2").contains("fig2 done"));
    assert_eq!(fs::read(folder.path().join("fig2.svg")).unwrap(), before, "the same bytes again");
    // Other parameters are another paper.
    refused(&["paper", "--quick", "--only", "fig2", "-o", path, "--gamma", "0.7"], &["gamma", "--force"]);
}

#[test]
fn unknown_items_are_refused_with_the_list() {
    let ids: Vec<&str> = ITEMS.iter().map(|item| item.id).collect();
    refused(&["paper", "--only", "fig99"], &ids);
    refused(&["paper", "--only", "fig2", "--gamma", "1.5"], &["gamma = 1.5"]);
}

#[test]
fn expectations_of_the_nominal_rig_do_not_apply_to_another() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_str().unwrap();
    let json = document(&["paper", "--quick", "--only", "fig1", "--gamma", "0.7", "-o", path, "--json"]);
    let checks = json["items"][0]["checks"].as_array().unwrap();
    assert!(checks.iter().any(|check| check["passed"].is_null()));
    assert_eq!(json["items"][0]["passed"], true);
}

/// At gamma = 0.7 the torus shrinks back to the limit cycle and never doubles: Table 1 says so, and the page is written.
#[test]
fn parameters_without_doublings_have_a_page_that_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_str().unwrap();
    let json = document(&["paper", "--quick", "--only", "fig2,table1", "--gamma", "0.7", "-o", path, "--json"]);
    let items = json["items"].as_array().unwrap();
    assert!(items.iter().all(|item| item["passed"] == true), "{items:?}");
    assert!(items[1]["verdict"].as_str().unwrap().contains("never doubles"), "{}", items[1]["verdict"]);
    let ends: Vec<&str> = items[1]["numbers"].as_array().unwrap().iter().filter_map(|n| n["value"].as_str()).collect();
    assert!(ends.iter().any(|value| value.contains("shrinks back to a fixed point")), "{ends:?}");
    let page = fs::read_to_string(folder.path().join("index.html")).unwrap();
    assert!(page.contains("never doubles") && page.contains("not the paper's nominal set"));
}

fn compute_nothing(case: &Case) -> Result<Findings, PaperError> {
    let fold = case.nominal_only(Check::near("fold", -0.2, -0.215_051_734, 1e-3, "deliberately wrong"));
    Ok(Findings { verdict: "wrong".to_owned(), checks: vec![fold], ..Findings::default() })
}

/// An expectation that is not met.
const WRONG: PaperItem = PaperItem {
    id: "wrong",
    origin: Place::Beyond,
    title: "a wrong expectation",
    caption: "",
    revision: 1,
    compute: compute_nothing,
};

fn cannot_compute(case: &Case) -> Result<Findings, PaperError> {
    Err(PaperError::missing("unicorn", case.parameters))
}

/// An item that fails for the nominal parameters.
const FAILING: PaperItem = PaperItem { id: "failing", compute: cannot_compute, ..WRONG };

#[test]
fn an_item_that_cannot_be_computed_is_a_failed_entry_and_is_tried_again() {
    let folder = tempfile::tempdir().unwrap();
    let case = Case { parameters: RigParameters::default(), effort: Effort::Quick };
    let dir = OutputDir::open(folder.path(), &Origin::new("paper", serde_json::json!({})), Existing::Resume).unwrap();
    let results = run(&[&FAILING, &WRONG], &case, &dir, |_| {}).unwrap();
    assert!(!results[0].passed && results[0].verdict.contains("unicorn"));
    assert_eq!(results[1].verdict, "wrong", "the others are computed");
    write_index(&[(&FAILING, results[0].clone())], &case, &dir).unwrap();
    let page = fs::read_to_string(folder.path().join("index.html")).unwrap();
    assert!(page.contains("unicorn") && page.contains("✗ failed"));
    assert!(stickslip::paper::stored(&FAILING, &dir).is_none());
}

fn compute_elsewhere(case: &Case) -> Result<Findings, PaperError> {
    let mut findings = Findings::default();
    let table = || numbers(vec![("x", vec![1.0])]);
    findings.table("own", table());
    findings.table_at("elsewhere", RigParameters { kappa: 0.074, ..case.parameters }, table());
    Ok(findings)
}

#[test]
fn a_table_made_with_other_parameters_names_them() {
    const ITEM: PaperItem = PaperItem { id: "tables", compute: compute_elsewhere, ..WRONG };
    let folder = tempfile::tempdir().unwrap();
    let case = Case { parameters: RigParameters::default(), effort: Effort::Quick };
    let dir = OutputDir::open(folder.path(), &Origin::new("paper", serde_json::json!({})), Existing::Resume).unwrap();
    run(&[&ITEM], &case, &dir, |_| {}).unwrap();
    let header = |file: &str| fs::read_to_string(folder.path().join(file)).unwrap();
    assert!(header("tables.csv").contains("# parameters: xi2 = 0.011, kappa = 0.1, gamma = 0.5"));
    let other = header("tables-elsewhere.csv");
    assert!(other.contains("# parameters: xi2 = 0.011, kappa = 0.074, gamma = 0.5") && !other.contains("kappa = 0.1,"));
}

fn passes(parameters: RigParameters, folder: &Path) -> bool {
    let case = Case { parameters, effort: Effort::Quick };
    let dir = OutputDir::open(folder, &Origin::new("paper", serde_json::json!({})), Existing::Resume).unwrap();
    let results = run(&[&WRONG], &case, &dir, |_| {}).unwrap();
    write_index(&[(&WRONG, results[0].clone())], &case, &dir).unwrap();
    results[0].passed
}

#[test]
fn a_wrong_expectation_fails_its_item() {
    let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    assert!(!passes(RigParameters::default(), folders[0].path()));
    assert!(fs::read_to_string(folders[0].path().join("index.html")).unwrap().contains("✗ failed"));
    // It is one of the nominal parameters.
    assert!(passes(RigParameters { gamma: 0.6, ..Default::default() }, folders[1].path()));
}
