//! Every shader of the project, by the compiler that will meet it in the window.

use std::fs;
use std::path::Path;

use naga::valid::{Capabilities, ValidationFlags, Validator};

#[test]
fn every_shader_is_valid() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shaders");
    let mut seen = 0;
    for entry in fs::read_dir(&folder).expect("shaders/ is there") {
        let path = entry.expect("a readable folder").path();
        if path.extension().is_none_or(|extension| extension != "wgsl") {
            continue;
        }
        let source = fs::read_to_string(&path).expect("a text file");
        let name = path.display().to_string();
        let module = naga::front::wgsl::parse_str(&source)
            .unwrap_or_else(|fault| panic!("{}", fault.emit_to_string_with_path(&source, &name)));
        Validator::new(ValidationFlags::all(), Capabilities::empty())
            .validate(&module)
            .unwrap_or_else(|fault| panic!("{}", fault.emit_to_string_with_path(&source, &name)));
        seen += 1;
    }
    assert!(seen > 0, "no shader in {}", folder.display());
}
