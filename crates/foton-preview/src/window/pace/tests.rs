//! When frames are drawn.

use super::*;

const fn ms(n: u64) -> Duration {
    Duration::from_millis(n)
}

/// Something drew at `start`, and nothing has happened since.
fn pace(start: Instant, is_software: bool) -> Pace {
    Pace { is_software, ..Pace::new(start) }
}

#[test]
fn in_software_a_frame_that_answers_a_move_waits_for_its_picture_but_not_for_ever() {
    let start = Instant::now();
    let mut pace = pace(start, true);
    assert!(pace.may_wait());
    pace.begin();
    pace.wait(start + ms(500));
    assert_eq!(pace.due(), Some(start + ms(570)), "without a picture");
    pace.hear(start + ms(530), true);
    assert!(pace.due().is_some_and(|due| due <= start + ms(530)), "the picture is shown at once");
    assert!(!pace.may_wait(), "a hand that never rests sees something");
    pace.drawn(start + ms(540));
    assert!(pace.may_wait());
}

#[test]
fn what_the_passes_before_a_move_asked_for_does_not_cut_the_wait_short() {
    let start = Instant::now();
    let mut pace = pace(start, true);
    pace.input(start);
    pace.hear(start + ms(10), false);
    assert_eq!(pace.due(), Some(start + SOFTWARE_ATTENTIVE_GAP));
    pace.wait(start + ms(100));
    assert_eq!(pace.due(), Some(start + ms(170)), "another pass had asked before");
    pace.hear(start + ms(110), false);
    assert_eq!(pace.due(), Some(start + ms(170)), "another pass asks now");
}

#[test]
fn where_a_graphics_card_draws_no_frame_waits() {
    assert!(!pace(Instant::now(), false).may_wait());
}

#[test]
fn in_software_passes_are_drawn_seldom_and_more_often_while_a_person_acts() {
    let start = Instant::now();
    let due = |is_software, input, is_news| {
        let mut pace = pace(start, is_software);
        if input {
            pace.input(start);
        }
        pace.hear(start + ms(10), is_news);
        pace.due().expect("due") - start
    };
    assert_eq!(due(true, false, false), SOFTWARE_GAP);
    assert_eq!(due(true, true, false), SOFTWARE_ATTENTIVE_GAP);
    assert_eq!(due(true, false, true), HARDWARE_GAP);
    assert_eq!(due(false, false, false), HARDWARE_GAP);
}

#[test]
fn attention_fades() {
    let start = Instant::now();
    let mut pace = pace(start, true);
    pace.input(start);
    pace.hear(start + ATTENTION, false);
    assert_eq!(pace.due(), Some(start + SOFTWARE_GAP));
}

#[test]
fn the_soonest_of_what_is_due_counts_and_nothing_is_due_after_it() {
    let start = Instant::now();
    let mut pace = pace(start, true);
    pace.repaint(start, Duration::MAX);
    assert_eq!(pace.due(), None, "never");
    pace.repaint(start, Duration::ZERO);
    assert_eq!(pace.due(), Some(start + SOFTWARE_ATTENTIVE_GAP), "egui alone is in no hurry");
    pace.draw_at(start + ms(5));
    pace.draw_at(start + ms(50));
    assert_eq!(pace.due(), Some(start + ms(5)));
    pace.begin();
    assert_eq!(pace.due(), None);
}
