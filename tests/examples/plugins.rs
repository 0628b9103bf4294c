//! Prints `docs/plugins.md`.

fn main() {
    print!("{}", foton_tests::plugins::document());
}
