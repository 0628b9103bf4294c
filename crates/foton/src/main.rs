//! The foton binary.

fn main() {}
