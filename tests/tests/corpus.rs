//! What fuzzing found is read again: no panic, and no more memory than the bound that fuzzing holds readers to.
//!
//! The files in `tests/corpus` reach most of what libFuzzer reached. Beside them go inputs that once broke something, or that
//! would. Not here: the time that an input takes, which only fuzzing looks at.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Memory is counted for the whole process.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

#[track_caller]
fn replay(target: &str) {
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(target);
    let mut paths: Vec<_> =
        std::fs::read_dir(folder).expect("a folder").map(|e| e.expect("a file").path()).collect();
    paths.sort();
    assert!(paths.len() >= 40, "{target}: {} files", paths.len());
    let faults = paths.iter().filter(|path| {
        let data = std::fs::read(path).expect("a file");
        catch_unwind(AssertUnwindSafe(|| foton_fuzz::check(target, &data))).is_err()
    });
    let faults: Vec<_> = faults.map(|path| path.display().to_string()).collect();
    assert!(faults.is_empty(), "{target}:\n{}", faults.join("\n"));
}

#[test]
fn scenes_that_fuzzing_found_break_nothing() {
    replay("xml");
}

#[test]
fn scenes_of_pbrt_that_fuzzing_found_break_nothing() {
    replay("pbrt");
}

#[test]
fn obj_files_that_fuzzing_found_break_nothing() {
    replay("obj");
}

#[test]
fn other_meshes_that_fuzzing_found_break_nothing() {
    replay("ply");
}

#[test]
fn pictures_that_fuzzing_found_break_nothing() {
    replay("image");
}

#[test]
fn gltf_files_that_fuzzing_found_break_nothing() {
    replay("gltf");
}

#[test]
fn checkpoints_that_fuzzing_found_break_nothing() {
    replay("checkpoint");
}

/// What is mutated reaches what a checksum guards.
#[test]
fn a_genuine_state_in_a_header_of_our_own_is_taken_up() {
    // Readers of one process share the file that they read from.
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let (file, state) = foton_fuzz::genuine_checkpoint();
    for data in [[&[0], &file[..]].concat(), [&[1], &state[..]].concat()] {
        let said = foton_fuzz::read_checkpoint(&data);
        assert!(said.starts_with("taken up"), "{said}");
    }
}
