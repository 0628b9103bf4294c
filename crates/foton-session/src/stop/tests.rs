//! When renders stop.

use super::*;

#[test]
fn the_first_limit_stops_and_a_pass_that_would_end_late_is_not_begun() {
    let s = Duration::from_secs;
    let both = StopRule { passes: Some(10), time: Some(s(60)), error: None };
    assert!(!both.is_reached(9, s(50), s(5), None));
    assert!(both.is_reached(10, s(5), s(5), None));
    assert!(both.is_reached(3, s(58), s(5), None));
    assert!(!both.is_reached(0, s(100), s(5), None), "there is always one pass");
    assert!(!StopRule::default().is_reached(1 << 40, s(1 << 30), s(1), None));
    assert_eq!(both.fraction(2, s(30), None), Some(0.5));
    assert_eq!(StopRule::default().fraction(2, s(30), None), None);
}

#[test]
fn an_error_stops_only_when_it_is_certain() {
    let rule = StopRule { error: Some(0.02), ..StopRule::default() };
    let good = ErrorEstimate {
        total: 0.015,
        noise: 0.013,
        bias: 0.007,
        low: 0.012,
        high: 0.019,
        focus: 0.0,
        unknown_share: 0.01,
        effective_passes: 20.0,
        mean_luminance: 1.0,
        classes: None,
    };
    let stops =
        |error: Option<&ErrorEstimate>| rule.is_reached(30, Duration::from_secs(9), Duration::ZERO, error);
    assert!(stops(Some(&good)) && !stops(None));
    assert!(!stops(Some(&ErrorEstimate { high: 0.021, ..good })), "the upper end counts");
    assert!(!stops(Some(&ErrorEstimate { effective_passes: 4.0, ..good })), "too few passes to tell");
    assert!(!stops(Some(&ErrorEstimate { unknown_share: 0.3, ..good })), "unknown is not dark");
    let doubled = ErrorEstimate { high: 0.04, ..good };
    let share = rule.fraction(1, Duration::ZERO, Some(&doubled)).expect("a limit");
    assert!((share - 0.125).abs() < 1e-12);
}
