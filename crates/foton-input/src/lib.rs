//! What comes from outside: files opened by their kind and size, and their words as messages may quote them.
//!
//! Every file that foton reads and did not write itself is opened by [`read_file`], and every word of such a file that stands in
//! a message goes through [`quoted`]. No format is known here.
//!
//! ```
//! use foton_input::{Limit, Named, quoted, read_file};
//!
//! let refused = read_file(std::env::temp_dir().as_path(), Named::ByFile, Limit::NONE, &|| false);
//! assert_eq!(refused.unwrap_err().to_string(), "it is a folder, not a file");
//! assert_eq!(quoted("a\u{1b}[2J"), "\"a\\u{1b}[2J\"");
//! ```

mod open;
mod other_case;
mod quote;

pub use open::{Limit, Named, Refusal, read_file};
pub use other_case::of_other_case;
pub use quote::{MAX_QUOTE, is_printable, json, printable, quoted, shown, shown_bytes, shown_path};
