//! Tests of options and their values.

use std::time::Duration;

use foton_integrator::RadiusScale;

use super::parse::*;
use super::*;

#[test]
fn the_command_line_is_sound() {
    use clap::CommandFactory;
    Args::command().debug_assert();
}

#[test]
fn times_sizes_and_schedules_are_read_and_nonsense_is_refused() {
    assert_eq!(duration("1.5m"), Ok(Duration::from_secs(90)));
    assert_eq!(duration("250ms"), Ok(Duration::from_millis(250)));
    assert_eq!(duration("7"), Ok(Duration::from_secs(7)));
    assert_eq!((bytes("8G"), bytes("1.5MiB")), (Ok(8 << 30), Ok(3 << 19)));
    for bad in ["", "-1s", "0s", "s", "NaNs", "1e300h", "tomorrow"] {
        assert!(duration(bad).is_err(), "{bad}");
    }
    assert_eq!((error_wish("2%"), error_wish("off")), (Ok(ErrorWish::Below(0.02)), Ok(ErrorWish::Off)));
    for bad in ["0", "-1%", "100%", "1", "low"] {
        assert!(error_wish(bad).is_err(), "{bad}");
    }
    assert_eq!("640x480".parse(), Ok(Size { width: 640, height: 480 }));
    for bad in ["640", "0x3", "axb", "70000x1", "-1x5"] {
        assert!(bad.parse::<Size>().is_err(), "{bad}");
    }
    assert_eq!(("pow2".parse(), "3".parse()), (Ok(Every::PowersOfTwo), Ok(Every::Nth(3))));
    assert!("0".parse::<Every>().is_err());
    assert!(Every::Nth(3).is_due(6) && !Every::Nth(3).is_due(7) && Every::PowersOfTwo.is_due(8));
    let half = RadiusScale::new(0.5).map(Radius::Footprint);
    assert_eq!((radius("0.2").ok(), radius("x0.5").ok()), (Some(Radius::World(0.2)), half));
    for bad in ["0", "-1", "x", "x0", "0.5x", "xNaN", "inf"] {
        assert!(radius(bad).is_err(), "{bad}");
    }
    assert!(exr("a.exr".into()).is_ok() && exr("a.png".into()).is_err());
    for bad in ["0", "1.01", "NaN", "-1"] {
        assert!(alpha(bad).is_err(), "{bad}");
    }
}
