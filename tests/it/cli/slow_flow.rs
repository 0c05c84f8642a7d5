//! The slow flow on the command line.

use super::{document, refused};

#[test]
fn bifurcations_of_the_slow_flow_are_printed_with_their_parameters() {
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let hopf = document(&["slow-flow", "hopf", "--json"]);
    // Computed outside this project to seven decimal places.
    assert!((number(&hopf["xi1"]) - -0.035_002_1).abs() < 1e-6);
    let hopf = document(&["slow-flow", "hopf", "--energy", "equivalent-stiffness", "--json"]);
    assert!((number(&hopf["xi1"]) - -0.034_834_4).abs() < 1e-6);
    assert_eq!(hopf["parameters"]["energy"], "equivalent_stiffness");
    // The limit cycle regains its stability.
    let twice = document(&["slow-flow", "hopf", "--kappa", "0.074", "--json"]);
    assert_eq!(twice["secondary_hopf"].as_array().unwrap().len(), 2);
    let fold = document(&["slow-flow", "fold", "--json"]);
    assert!((number(&fold["xi1"]) - -0.213_986_24).abs() < 1e-7 && (number(&fold["a1"]) - 2.726_382).abs() < 1e-6);
    let doublings = document(&["slow-flow", "doublings", "--count", "3", "--json"]);
    for (found, expected) in doublings["doublings"].as_array().unwrap().iter().zip([-0.105_942, -0.127_459, -0.133_161])
    {
        assert!((number(&found["xi1"]) - expected).abs() < 3e-6, "{found}");
    }
    // (.127459 - .105942)/(.133161 - .127459) from six digits: three of the ratio.
    assert!((number(&doublings["doublings"][1]["ratio"]) - 3.774).abs() < 5e-3);
    refused(&["slow-flow", "doublings", "--count", "0"], &["--count"]);
    refused(&["slow-flow", "hopf", "--kappa", "0"], &["kappa"]);
    refused(&["slow-flow", "hopf", "--xi1", "-0.1"], &["--xi1"]);
    refused(&["slow-flow", "hopf", "--nodes", "1"], &["nodes"]);
}

#[test]
fn motions_of_the_slow_flow_are_simulated_and_classified() {
    // From a reversal on, the first slip within the first half cycle counts, and so does the one under way at the end.
    let short = document(&["simulate", "--with", "slow-flow", "--t-end", "6", "--json"]);
    assert_eq!(short["events"], 3);
    assert_eq!(short["final"]["contact"], "slip+");
    let slow = document(&["simulate", "--with", "slow-flow", "--xi1", "-0.02", "--t-end", "50", "--json"]);
    assert_eq!(
        (slow["diverged"].as_bool(), slow["parameters"]["energy"].as_str()),
        (Some(false), Some("mean_potential"))
    );
    let diagram = document(&["diagram", "--with", "slow-flow", "--from=-0.02", "--to=-0.2", "--count", "4", "--json"]);
    let outcomes: Vec<_> = diagram["rows"].as_array().unwrap().iter().map(|row| row["outcome"].clone()).collect();
    // Values -0.02, -0.08, -0.14, -0.2: stable, beyond the Hopf point, beyond the doublings, beyond divergence.
    assert_eq!(
        (&outcomes[0], &outcomes[1], &outcomes[3]),
        (&"limit_cycle".into(), &"torus".into(), &"diverged".into())
    );
    refused(&["simulate", "--energy", "mean-potential"], &["--with slow-flow"]);
}
