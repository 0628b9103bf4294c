//! Scene files and meshes to scene descriptions; the only reader of scene files.
//!
//! The format is a subset of Mitsuba 3's XML, so that one file renders alike in both; files of its predecessor (version
//! 0.6) are read, too, and so are scenes of pbrt and glTF. All problems of a file are found in one go, each with its place and the nearest known name.
//! Nothing is rendered or downloaded here, and media are not read.
//!
//! ```
//! let xml = r#"<scene version="3.0.0">
//!     <default name="r" value="1"/>
//!     <sensor type="perspective"/>
//!     <shape type="sphere"><float name="radius" value="$r"/><emitter type="area"/></shape>
//! </scene>"#;
//! let no_files = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
//! let options = foton_format::Options { defines: vec![("r".into(), "2".into())], ..Default::default() };
//! let opened = foton_format::read_str("ball.xml", xml, &no_files, &options).unwrap();
//! assert_eq!(opened.description.shapes.len(), 1);
//! ```

mod diagnostic;
mod encoding;
mod excerpt;
mod files;
mod gltf;
mod hash;
mod ies;
mod image;
mod limits;
mod mesh;
mod mitsuba;
mod open;
mod opened;
mod options;
mod pbrt;
mod refused;
mod sky;
mod spelling;
mod standalone;
mod suggested;
mod watch;

pub use diagnostic::{Diagnostic, OpenError, Place, Severity};
pub use excerpt::Excerpt;
pub use mitsuba::document::{Attribute, Document, Element, MAX_DEPTH, Node, NodeId};
pub use mitsuba::save::{Saved, save_edited};
pub use mitsuba::write::beyond::beyond_mitsuba_3;
pub use mitsuba::write::write_scene;
pub use open::{import, open, open_from, read_str};
pub use opened::{ForeignScene, MitsubaScene, Opened, Origin, SceneNodes};
pub use options::{Options, ReadFile};
pub use suggested::Suggested;
pub use watch::Progress;
