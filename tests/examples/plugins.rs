//! Prints `docs/plugins.md`.

#![allow(clippy::print_stdout, reason = "the page goes to standard output")]

fn main() {
    print!("{}", foton_tests::plugins::document());
}
