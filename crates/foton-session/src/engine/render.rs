//! One render under way: a small quick picture first, then the whole one.

use std::num::NonZeroU32;
use std::sync::Arc;
use std::time::{Duration, Instant};

use foton_film::{Image, Plane};
use foton_integrator::{Cancel, Cancelled, LayerKind, Ppm, Radii, Settings};
use foton_math::Rgb;
use foton_scene::Scene;
use foton_scene::description::SensorDescription;

use super::command::Shown;
use super::frame::{Numbers, Picture};
use crate::session::{Session, StartError};

/// Pixels of a small picture at most: its eye pass and first pass take some tens of milliseconds on two cores.
const SMALL_PIXELS: u32 = 160 * 120;

/// Photons of a small picture's passes.
const SMALL_PASS: NonZeroU32 = NonZeroU32::new(1 << 14).unwrap();

/// Passes that a small picture gets while a person holds still in the middle of a move.
const SMALL_PASSES: u64 = 8;

/// Rates are those of the passes of about this long.
const RATE_SPAN: Duration = Duration::from_secs(2);

/// Radii are sorted at most this often: with millions of hit points that takes a while.
const RADII_EVERY: Duration = Duration::from_millis(500);

/// A render, small or whole.
pub(super) struct Render {
    session: Session,
    small: bool,
    marks: Vec<Mark>,
    no_photon_share: f64,
    photons_in_pass: u64,
    radii: Option<(Instant, Radii)>,
}

/// How far a render was at some time.
struct Mark {
    elapsed: Duration,
    photons: u64,
    rays: u64,
}

impl Render {
    /// A small picture of the scene as the sensor sees it.
    pub(super) fn small(
        scene: &Scene,
        sensors: &[SensorDescription],
        settings: &Settings,
        threads: Option<usize>,
        cancel: &Cancel,
    ) -> Result<Self, StartError> {
        let mut sensors = sensors.to_vec();
        for sensor in &mut sensors {
            let pixels = f64::from(sensor.width) * f64::from(sensor.height);
            let factor = (f64::from(SMALL_PIXELS) / pixels).sqrt().min(1.0);
            let shrink = |n: u32| ((f64::from(n) * factor).round() as u32).max(1);
            sensor.resize(shrink(sensor.width), shrink(sensor.height));
        }
        let settings = Settings {
            samples_per_pixel: NonZeroU32::MIN,
            photons_per_pass: settings.photons_per_pass.min(SMALL_PASS),
            ..settings.clone()
        };
        // Sensors that made a scene once make one at any size.
        let scene = Arc::new(scene.with_sensors(&sensors).map_err(|_| Cancelled)?);
        Ok(Self::over(Session::start(scene, settings, threads, cancel)?, true))
    }

    /// The whole picture.
    pub(super) fn whole(
        scene: &Arc<Scene>,
        settings: &Settings,
        threads: Option<usize>,
        cancel: &Cancel,
    ) -> Result<Self, StartError> {
        Ok(Self::over(Session::start(Arc::clone(scene), settings.clone(), threads, cancel)?, false))
    }

    fn over(session: Session, small: bool) -> Self {
        Self { session, small, marks: Vec::new(), no_photon_share: 1.0, photons_in_pass: 0, radii: None }
    }

    pub(super) const fn is_small(&self) -> bool {
        self.small
    }

    /// Whether a small picture is as good as it gets.
    pub(super) const fn is_good_enough_to_move(&self) -> bool {
        self.small && self.ppm().passes() >= SMALL_PASSES
    }

    pub(super) const fn ppm(&self) -> &Ppm {
        self.session.ppm()
    }

    pub(super) const fn session_mut(&mut self) -> &mut Session {
        &mut self.session
    }

    pub(super) const fn elapsed(&self) -> Duration {
        self.session.elapsed()
    }

    /// One pass; returns how long it took.
    pub(super) fn advance(&mut self, cancel: &Cancel) -> Result<Duration, Cancelled> {
        let before = self.session.elapsed();
        let report = self.session.advance(cancel)?;
        self.no_photon_share = report.no_photon_share;
        self.photons_in_pass = report.photons_in_pass;
        let (elapsed, rays) = (self.session.elapsed(), self.session.rays());
        self.marks.push(Mark { elapsed, photons: report.photons, rays });
        let old = self.marks.partition_point(|m| m.elapsed + RATE_SPAN < elapsed);
        self.marks.drain(..old.min(self.marks.len() - 1));
        Ok(elapsed - before)
    }

    pub(super) fn numbers(&mut self) -> Numbers {
        let ppm = self.session.ppm();
        let radii = match self.radii {
            Some((when, radii)) if when.elapsed() < RADII_EVERY => radii,
            _ => ppm.radii(),
        };
        if self.radii.is_none_or(|(when, _)| when.elapsed() >= RADII_EVERY) {
            self.radii = Some((Instant::now(), radii));
        }
        let (photons_per_s, rays_per_s) = self.rates();
        Numbers {
            passes: ppm.passes(),
            photons: ppm.photons_emitted(),
            photons_in_pass: self.photons_in_pass,
            elapsed: self.session.elapsed(),
            photons_per_s,
            rays_per_s,
            stages: *self.session.stages(),
            hit_points: ppm.start_report().hit_points,
            no_photon_share: self.no_photon_share,
            radii,
            bytes: ppm.bytes(),
        }
    }

    /// Photons and rays a second.
    fn rates(&self) -> (f64, f64) {
        let (Some(first), Some(last)) = (self.marks.first(), self.marks.last()) else { return (0.0, 0.0) };
        let seconds = (last.elapsed - first.elapsed).as_secs_f64();
        let rate = |n: u64| if seconds > 0.0 { n as f64 / seconds } else { 0.0 };
        (rate(last.photons - first.photons), rate(last.rays - first.rays))
    }

    /// The picture as it stands; radiance where what is asked for is not kept.
    pub(super) fn picture(&self, shown: Shown) -> Picture {
        let ppm = self.ppm();
        let measure = |label, values: Vec<f32>| {
            let image = &ppm.scene().sensors()[ppm.settings().sensor];
            let plane = Plane { width: image.width, height: image.height, values };
            Picture::Measure { label, plane: Arc::new(plane) }
        };
        match shown {
            Shown::Radiance => Picture::Colour(Arc::new(ppm.image())),
            Shown::Classes { reflected, emission } => {
                Picture::Colour(Arc::new(classes(ppm, reflected, emission)))
            }
            Shown::Radius => measure("radius (world units)", ppm.mean_radii()),
            Shown::PhotonCount => {
                measure("photons found", ppm.photons_found().into_iter().map(|n| n as f32).collect())
            }
            Shown::Luminance => {
                measure("luminance (W/m²/sr)", ppm.image().pixels.iter().map(|c| c.luminance()).collect())
            }
            Shown::Unknown => measure("hit points without a photon", ppm.unknown_share()),
        }
    }
}

/// The sum of some kinds of light.
fn classes(ppm: &Ppm, reflected: [bool; 3], emission: bool) -> Image {
    let kinds = [LayerKind::Direct, LayerKind::Caustic, LayerKind::Indirect, LayerKind::Emission];
    let wanted = [reflected[0], reflected[1], reflected[2], emission];
    let mut layers =
        kinds.into_iter().zip(wanted).filter(|(_, wanted)| *wanted).map(|(kind, _)| ppm.colour_layer(kind));
    let Some(first) = layers.next() else {
        let image = ppm.image();
        return Image::black(image.width, image.height);
    };
    let add = |sum: Option<Image>, layer: Option<Image>| {
        let (mut sum, layer) = (sum?, layer?);
        sum.pixels.iter_mut().zip(&layer.pixels).for_each(|(s, &l): (&mut Rgb, &Rgb)| *s += l);
        Some(sum)
    };
    layers.fold(first, add).unwrap_or_else(|| ppm.image())
}
