//! BSDFs beyond the common ones: the principled models, and what stands in for plugins that are not modelled.

use std::io;

use foton_format::{Opened, Options, read_str, write_string};
