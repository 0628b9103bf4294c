//! Cameras: where they are, what they see, how their pixels are filtered.

use std::fmt;

use foton_math::glam::DAffine3;

/// A camera. [`SensorDescription::default`] is Mitsuba's.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorDescription {
    /// The id in the file, or `sensor`, `sensor-2`, …
    pub name: String,
    /// Camera to world. The camera looks along its +z; +y is up in the image and +x points to the image's *left*. Its scale matters
    /// to [`Projection::Orthographic`] alone.
    pub to_world: DAffine3,
    /// How what it sees gets onto its film.
    pub projection: Projection,
    /// Field of view of a perspective in degrees along `fov_axis`, in (0, 180).
    pub fov_degrees: f64,
    /// What `fov_degrees` spans.
    pub fov_axis: FovAxis,
    /// Image width in pixels, at least 1.
    pub width: u32,
    /// Image height in pixels, at least 1.
    pub height: u32,
    /// The part of the image that is rendered; `None`: all of it.
    pub crop: Option<Crop>,
    /// How eye samples spread around a pixel's centre.
    pub filter: Filter,
    /// Nothing nearer than this depth along the camera's z is seen, in world units. `None`: no bound.
    pub near_clip: Option<f64>,
    /// Nothing farther than this depth along the camera's z is seen, in world units. `None`: no bound.
    pub far_clip: Option<f64>,
    /// What blurs things away from the plane in focus. `None`: a pinhole, which shows everything sharp.
    pub lens: Option<Lens>,
    /// Where the middle of the image looks, in shares of its width to the right and of its height down from the camera's z.
    pub principal_point_offset: [f64; 2],
}

impl Default for SensorDescription {
    fn default() -> Self {
        Self {
            name: "sensor".to_owned(),
            to_world: DAffine3::IDENTITY,
            projection: Projection::default(),
            fov_degrees: 40.0,
            fov_axis: FovAxis::default(),
            width: 768,
            height: 576,
            crop: None,
            filter: Filter::Gaussian { stddev: 0.5 },
            near_clip: None,
            far_clip: None,
            lens: None,
            principal_point_offset: [0.0; 2],
        }
    }
}

/// How what a camera sees gets onto its film.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Projection {
    /// By rays through one point, within the field of view.
    #[default]
    Perspective,
    /// By parallel rays along the camera's z. Half the width of the image shows as many world units as the camera's x axis is long in
    /// the world; its height as many as its y axis is long, times height over width: an even scale shows squares as squares.
    Orthographic,
}

/// A thin lens: a disc around the camera's position, perpendicular to its z, that brings one plane into focus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Radius of the disc in world units; 0 is a pinhole.
    pub aperture_radius: f64,
    /// Depth along the camera's z at which things are sharp, in world units, above 0.
    pub focus_distance: f64,
}

impl Lens {
    /// Whether it makes an image.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.aperture_radius.is_finite()
            && self.aperture_radius >= 0.0
            && self.focus_distance.is_finite()
            && self.focus_distance > 0.0
    }
}

impl SensorDescription {
    /// Renders a part of the image alone, in place of any other.
    ///
    /// # Errors
    /// Where the part is empty or not all inside, in words.
    pub fn show_only(&mut self, region: Crop) -> Result<(), String> {
        let Crop { x, y, width, height } = region;
        let fits = |first: u32, count: u32, all: u32| {
            count > 0 && u64::from(first) + u64::from(count) <= u64::from(all)
        };
        if !fits(x, width, self.width) || !fits(y, height, self.height) {
            return Err(format!(
                "the region {region} is not inside the image of {} x {} pixels",
                self.width, self.height
            ));
        }
        self.crop = Some(region);
        Ok(())
    }

    /// The same view at another size in pixels, a crop in proportion.
    pub fn resize(&mut self, width: u32, height: u32) {
        if let Some(crop) = &mut self.crop {
            // Rounded outwards, which keeps it inside and not empty.
            let scaled = |first: &mut u32, count: &mut u32, old: u32, new: u32| {
                let (old, new) = (u64::from(old.max(1)), u64::from(new));
                let end = (u64::from(*first) + u64::from(*count)) * new;
                let begin = u64::from(*first) * new / old;
                (*first, *count) = (begin as u32, (end.div_ceil(old) - begin) as u32);
            };
            scaled(&mut crop.x, &mut crop.width, self.width, width);
            scaled(&mut crop.y, &mut crop.height, self.height, height);
        }
        (self.width, self.height) = (width, height);
    }
}

/// A window of an image, in pixels from its top left. It must lie inside and hold a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl fmt::Display for Crop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{},{},{}", self.x, self.y, self.width, self.height)
    }
}

/// The image axis that a field of view spans.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FovAxis {
    /// Horizontal.
    #[default]
    X,
    /// Vertical.
    Y,
    /// Corner to corner.
    Diagonal,
    /// The shorter side.
    Smaller,
    /// The longer side.
    Larger,
}

impl FovAxis {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::X, Self::Y, Self::Diagonal, Self::Smaller, Self::Larger];

    /// How long what it spans is in an image of that width and height.
    #[must_use]
    pub fn spanned(self, [width, height]: [f64; 2]) -> f64 {
        match self {
            Self::X => width,
            Self::Y => height,
            Self::Diagonal => width.hypot(height),
            Self::Smaller => width.min(height),
            Self::Larger => width.max(height),
        }
    }

    /// What files call it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Diagonal => "diagonal",
            Self::Smaller => "smaller",
            Self::Larger => "larger",
        }
    }
}

/// A separable reconstruction filter, sampled in proportion to its height. Widths in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// Constant over `|x| ≤ radius`; 0.5 covers the pixel exactly.
    Box {
        /// Half the width.
        radius: f64,
    },
    /// A triangle that falls to zero at `radius`.
    Tent {
        /// Half the base.
        radius: f64,
    },
    /// A Gaussian cut off, and lowered to zero, at four standard deviations.
    Gaussian {
        /// Standard deviation.
        stddev: f64,
    },
}
