//! Linear images, tone mapping, and the EXR and PNG files that carry them with their metadata.
//!
//! Images are linear radiance; a tone map is applied on the way to 8 bits and nowhere else. Every file is written
//! beside its target and renamed over it, so that a reader meets the old file or the new one, never half of one.
//! Not here: accumulation of samples, pixel filters, metrics, other image formats.
//!
//! ```
//! use foton_film::{Image, Layer, LayerData, Metadata, Plane, ToneMap, read_exr, write_exr, write_png};
//! use foton_math::Rgb;
//!
//! let folder = std::env::temp_dir().join(format!("foton-film-doc-{}", std::process::id()));
//! std::fs::create_dir_all(&folder)?;
//!
//! let mut image = Image::black(4, 2);
//! image.pixels[5] = Rgb::new(0.5, 8.0, 0.25);
//! let photons = Plane { width: 4, height: 2, values: vec![7u32; 8] };
//! let layers = [Layer { name: "photon_count".into(), channels: LayerData::U32(photons) }];
//! let mut metadata = Metadata::default();
//! metadata.set("foton:passes", 64);
//!
//! write_exr(&folder.join("out.exr"), &image, &layers, &metadata)?;
//! write_png(&folder.join("out.png"), &image, ToneMap::default(), 0.0, &metadata)?;
//!
//! let (again, text) = read_exr(&folder.join("out.exr"))?;
//! assert_eq!(again, image);
//! assert_eq!(text.get("foton:passes"), Some("64"));
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod atomic;
mod error;
mod exr_header;
mod exr_read;
mod exr_write;
mod image;
mod input;
mod metadata;
mod png_read;
mod png_write;
pub mod tone_map;

pub use atomic::{
    atomic_write, check_writable, create_log, head_of, is_same_file, stands_for, write_new, write_spare,
};
pub use error::{ContentError, ReadError, WriteError};
pub use exr_read::{decode_exr, read_exr, read_exr_within};
pub use exr_write::write_exr;
pub use image::{Image, Layer, LayerData, Plane};
pub use metadata::{Metadata, MetadataError};
pub use png_read::{decode_png, read_png, read_png_within};
pub use png_write::write_png;
pub use tone_map::ToneMap;
