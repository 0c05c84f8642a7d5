//! Every shader is valid WGSL, checked without a graphics adapter.

use naga::front::wgsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::fs;
use std::path::PathBuf;

fn shaders() -> Vec<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("src/render/gpu");
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.filter(|path| path.extension().is_some_and(|extension| extension == "wgsl")).collect()
}

fn validate(source: &str) -> Result<(), String> {
    let module = wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    // No capabilities beyond plain WebGPU: what passes here needs nothing special of an adapter.
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(&module).map(|_| ()).map_err(|error| error.emit_to_string(source))
}

#[test]
fn every_shader_is_valid() {
    assert_eq!(shaders().len(), 2);
    for path in shaders() {
        validate(&fs::read_to_string(&path).unwrap()).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }
}

/// Negative control.
#[test]
fn a_shader_with_a_wrong_type_is_refused() {
    let source = fs::read_to_string(&shaders()[0]).unwrap();
    assert!(validate(&format!("{source}\nfn wrong() -> f32 {{ return vec2<f32>(1.0); }}")).is_err());
}
