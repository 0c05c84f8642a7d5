//! Texts that the program prints about itself.

use super::{document, stickslip};

#[test]
fn generated_texts_are_there() {
    let schema = document(&["schema", "scene"]);
    assert_eq!(schema["title"], "Scene");
    for shell in ["bash", "zsh", "fish"] {
        let text = stickslip(&["completions", shell]).stdout;
        assert!(String::from_utf8(text).unwrap().contains("stickslip"));
    }
    let man = String::from_utf8(stickslip(&["man"]).stdout).unwrap();
    assert!(man.contains(".TH") && man.contains("simulate"));
}
