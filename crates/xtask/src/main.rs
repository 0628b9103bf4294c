//! Developer tasks: test, conformance, ci.
fn main() {}
