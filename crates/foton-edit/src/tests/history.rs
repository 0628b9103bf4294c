//! Undo and redo.

use std::sync::Arc;

use foton_scene::description::SceneDescription;

use crate::{History, MAX_STEPS};

fn depth(n: u32) -> SceneDescription {
    SceneDescription { max_depth: Some(n), ..SceneDescription::default() }
}

fn history() -> History {
    History::new(Arc::new(depth(0)))
}

#[test]
fn a_drag_is_one_step() {
    let mut h = history();
    h.begin("move ring");
    for n in 1..50 {
        h.proceed(depth(n));
        assert_eq!(h.base().max_depth, Some(0));
    }
    h.commit();
    assert_eq!((h.len(), h.current().max_depth), (1, Some(49)));
    assert_eq!((h.undo().as_deref(), h.current().max_depth), (Some("move ring"), Some(0)));
    assert_eq!(h.undo(), None);
    assert!(!h.is_changed());
    assert_eq!(h.redo_name(), Some("move ring"));
    assert_eq!(h.redo().as_deref(), Some("move ring"));
    assert_eq!(h.current().max_depth, Some(49));
}

#[test]
fn a_step_without_a_change_or_cancelled_leaves_no_trace() {
    let mut h = history();
    h.record("one", depth(1));
    h.undo();
    h.begin("nothing");
    h.commit();
    h.begin("move");
    h.proceed(depth(7));
    assert_eq!(h.cancel().max_depth, Some(0));
    assert_eq!((h.len(), h.redo_name()), (0, Some("one")));
}

#[test]
fn a_new_step_forgets_what_was_undone_and_undo_ends_a_step_under_way() {
    let mut h = history();
    h.record("one", depth(1));
    h.undo();
    h.begin("two");
    h.proceed(depth(2));
    assert_eq!(h.undo().as_deref(), Some("two"));
    assert_eq!((h.current().max_depth, h.redo_name()), (Some(0), Some("two")));
}

#[test]
fn the_oldest_steps_are_forgotten() {
    let mut h = history();
    for n in 1..=300 {
        h.record(format!("step {n}"), depth(n));
    }
    assert_eq!(h.len(), MAX_STEPS);
    while h.undo().is_some() {}
    assert_eq!(h.current().max_depth, Some(100));
}
