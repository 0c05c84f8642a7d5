//! Disks whose rest is a node, that diverge, that rest, or that move on a torus: what is said of them. Right values were computed outside
//! the project by shooting with matrix exponentials, eigenvalues of the system matrices, and closed forms.

use crate::cli::{document, refused};

fn case(name: &str) -> String {
    format!("{}/tests/cases/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn every_eigenvalue_counts_for_stability() {
    // In phase s^2 - 3 s + 1 = 0; stiffness 1 - 2 = -1; s^2 + 5 s + 1 = 0 of the wave without coupling.
    let root = 0.5 * (3.0 + 5.0_f64.sqrt());
    let slow = -0.5 * (5.0 - 21.0_f64.sqrt());
    for (name, largest, allowed, stability) in [
        ("modes_unstable_node", root, 1e-12, "divergence"),
        ("modes_static_divergence", 1.0, 1e-12, "divergence"),
        // Blades 1 % apart.
        ("modes_static_divergence_mistuned", 1.0, 0.02, "divergence"),
        ("modes_overdamped", slow, 1e-12, "stable"),
    ] {
        let json = document(&["modes", &case(name), "--json"]);
        let eigenvalues = json["eigenvalues"].as_array().unwrap();
        let found = eigenvalues.last().unwrap()["re"].as_f64().unwrap();
        assert!((found - largest).abs() < allowed, "{name}: {found}");
        assert!((json["flutter_margin"].as_f64().unwrap() + 2.0 * found).abs() < 1e-15, "{name}");
        assert_eq!(json["stability"], stability, "{name}");
        assert!(eigenvalues.windows(2).all(|pair| pair[0]["re"].as_f64() <= pair[1]["re"].as_f64()), "{name}");
        assert!(json["overdamped"].as_u64().unwrap() > 0, "{name}");
    }
    // A tuned ring of four with every wave overdamped has eight real eigenvalues.
    assert_eq!(document(&["modes", &case("modes_overdamped"), "--json"])["overdamped"], 8);
}

#[test]
fn a_wave_damped_at_rest_has_its_unstable_cycle() {
    let json = document(&["disk", "waves", &case("nonlinear_instability"), "--json"]);
    let wave = json["waves"].as_array().unwrap().iter().find(|wave| wave["nodal_diameter"] == 1).unwrap();
    let cycle = &wave["limit_cycle"];
    assert_eq!(cycle["stable"], false, "{wave}");
    let number = |name: &str| cycle[name].as_f64().unwrap_or_else(|| panic!("{name} in {wave}"));
    // Given to ten digits.
    assert!((number("amplitude") - 60.1346566917).abs() < 1e-7, "{wave}");
    assert!((number("angular_frequency") - 0.6496994648606).abs() < 1e-10, "{wave}");
}

#[test]
fn only_a_cycle_that_the_motion_is_on_is_reported() {
    refused(&["disk", "cycle", &case("nonlinear_instability")], &["at rest"]);
    refused(&["disk", "cycle", &case("mistuned_stabilised")], &["at rest"]);
    refused(&["disk", "cycle", &case("modes_static_divergence")], &["diverges"]);
    // The motion stays on two waves, 0.73 of n = 0 and 0.45 of n = 1.
    refused(&["disk", "cycle", &case("cycle_of_a_torus"), "--settle", "20000"], &["+0: 0.7", "+1: 0.4"]);
}

#[test]
fn a_chain_without_damping_is_neutral() {
    let output = std::process::Command::new(assert_cmd::cargo::cargo_bin("stickslip"))
        .args(["disk", "cycle", &case("undamped_chain_of_three"), "--json"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
    assert!(said.contains("neutral") && !said.contains("\"unstable\""), "{said}");
}

#[test]
fn work_without_end_is_refused() {
    let scene = case("nonlinear_instability");
    refused(&["disk", "cycle", &scene, "--settle", "1e26"], &["1e26"]);
    refused(&["disk", "simulate", &scene, "--t-end", "1e26", "--sample", "1e26"], &["1e26"]);
    let mistuned = format!("{}/scenes/disk_mistuned.toml", env!("CARGO_MANIFEST_DIR"));
    refused(&["disk", "flutter", &mistuned, "--periods", "1e26"], &["1e26"]);
    refused(&["disk", "simulate", &case("huge_start"), "--with", "rapier"], &["1e308"]);
    refused(&["disk", "flutter", &scene], &["mistuning"]);
}

/// Several Jenkins elements at one place make an Iwan element. By shooting outside the project: a = 1.5035493977, w = 0.948598904344.
#[test]
fn elements_in_parallel_make_an_iwan_element() {
    let json = document(&["disk", "cycle", &case("iwan_three_sliders"), "--json"]);
    let amplitude = json["amplitudes"][0].as_f64().unwrap();
    assert!((amplitude - 1.5035493977).abs() < 1e-9, "{json}");
    assert!((json["angular_frequency"].as_f64().unwrap() - 0.948598904344).abs() < 1e-10, "{json}");
}
