//! Limits of the system, and what they leave.

use super::*;

#[test]
fn the_tightest_of_nested_control_groups_counts() {
    let root = std::env::temp_dir().join(format!("foton-groups-{}", std::process::id()));
    let group = |path: &str, files: &[(&str, &str)]| {
        let folder = root.join(path);
        fs::create_dir_all(&folder).expect("a folder");
        files.iter().for_each(|(name, text)| fs::write(folder.join(name), text).expect("written"));
    };
    group("a/b", &[("memory.max", "max\n"), ("memory.current", "10\n")]);
    group(
        "a",
        &[
            ("memory.max", "1000\n"),
            ("memory.current", "700\n"),
            ("memory.stat", "anon 1\ninactive_file 200\n"),
        ],
    );
    group("", &[("memory.max", "9000\n"), ("memory.current", "100\n")]);
    group("memory/c", &[("memory.limit_in_bytes", "400\n"), ("memory.usage_in_bytes", "100\n")]);
    assert_eq!(left_in_groups("0::/a/b\n", &root), Some(500.0));
    assert_eq!(left_in_groups("0::/gone\n", &root), Some(8900.0));
    assert_eq!(left_in_groups("1:cpu:/c\n4:blkio,memory:/c\n", &root), Some(300.0));
    assert_eq!(left_in_groups("1:cpu:/a\nbroken\n", &root), None);
    let _ = fs::remove_dir_all(root);
}

#[test]
fn address_space_that_is_used_or_kept_is_no_room() {
    let mebibytes = |n: i32| f64::from(n) * f64::from(1 << 20);
    let confined = Confined {
        limit: mebibytes(500),
        used: mebibytes(36),
        reserved: mebibytes(128),
        option: "ulimit -v",
    };
    assert_eq!(confined.room(), mebibytes(500 - 20 - 128));
    let said = "the system confines the program to 500 MiB (ulimit -v), of which it has 36 MiB already and the C library keeps up \
                to 128 MiB for threads (none with MALLOC_ARENA_MAX=1)";
    assert_eq!(confined.to_string(), said);
}
