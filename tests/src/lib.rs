//! Tests across crates live in this package's tests.
