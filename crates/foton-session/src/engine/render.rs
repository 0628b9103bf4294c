//! One render under way: a small quick picture first, then the whole one.

use std::num::NonZeroU32;
use std::sync::Arc;
use std::time::{Duration, Instant};

use foton_film::{Image, Plane};
use foton_integrator::{
    Cancel, Cancelled, LayerKind, PpmSettings, Radii, RadiusScale, Render, RenderSettings, ShouldSuspend,
};
use foton_math::Rgb;
use foton_scene::Scene;
use foton_scene::description::SensorDescription;
use rayon::ThreadPool;

use super::command::{ErrorPart, ViewMode};
use super::frame::{Picture, RenderStats};
use super::rates::{Mark, PerSecond, Rates};
use crate::findings::{self, Finding, SettingNames};
use crate::session::{PassError, Session, StartError};

/// How much of the whole picture is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Level {
    /// Few pixels: eye pass and first pass take some tens of milliseconds on two cores.
    Small,
    /// Something to look at while the hit points of the whole are collected.
    Middle,
    /// All of it.
    Whole,
}

impl Level {
    /// Pixels at most.
    const fn pixels(self) -> u32 {
        match self {
            Self::Small => 160 * 120,
            Self::Middle => 480 * 360,
            Self::Whole => u32::MAX,
        }
    }

    /// Passes that are rendered before the next level, if nothing moves.
    const fn passes(self) -> u64 {
        match self {
            Self::Small => 1,
            Self::Middle => 2,
            Self::Whole => u64::MAX,
        }
    }

    /// Photons of a pass at most.
    const fn photons(self) -> NonZeroU32 {
        match self {
            Self::Small => NonZeroU32::new(1 << 13).unwrap(),
            Self::Middle => NonZeroU32::new(1 << 16).unwrap(),
            Self::Whole => NonZeroU32::MAX,
        }
    }

    /// The level after this one. Where the whole has few eye samples anyway, there is nothing in between.
    fn next(self, eye_samples: u64) -> Self {
        match self {
            Self::Small if eye_samples > 2 * u64::from(Self::Middle.pixels()) => Self::Middle,
            _ => Self::Whole,
        }
    }
}

/// Factor on the first radius in pictures that are not the whole: smooth light after a pass or two is worth its bias.
const SMOOTH: f64 = 2.0;

/// Passes that a small picture gets while a person holds still in the middle of a move.
const SMALL_PASSES: u64 = 8;

/// Radii are sorted at most this often: with millions of hit points that takes a while.
const RADII_EVERY: Duration = Duration::from_millis(500);

/// Radii as they were a short while ago.
#[derive(Clone, Copy)]
struct RecentRadii {
    at: Instant,
    radii: Radii,
}

/// A render at one level.
pub(super) struct LevelRender {
    session: Session,
    level: Level,
    rates: Rates,
    /// How long the pass under way has taken so far.
    pass_took: Duration,
    /// Share of hit points without a photon in the preview that this render follows.
    preview_share: f64,
    no_photon_share: f64,
    photons_in_pass: u64,
    /// Radii that were at the radius floor in the last pass.
    radii_at_floor: u64,
    radii: Option<RecentRadii>,
}

impl LevelRender {
    /// The scene as the sensor sees it.
    pub(super) fn start(
        level: Level,
        scene: &Arc<Scene>,
        sensors: &[SensorDescription],
        settings: &RenderSettings,
        pool: &Arc<ThreadPool>,
        tell: &(dyn Fn(f64) + Sync),
        cancel: &Cancel,
    ) -> Result<Self, StartError> {
        if level == Level::Whole {
            let (pool, scene) = (Arc::clone(pool), Arc::clone(scene));
            let session = Session::start_on(pool, scene, settings.clone(), tell, cancel)?;
            return Ok(Self::over(session, level));
        }
        let mut sensors = sensors.to_vec();
        for sensor in &mut sensors {
            let [width, height] = sensor.crop.map_or([sensor.width, sensor.height], |c| [c.width, c.height]);
            let pixels = f64::from(width) * f64::from(height);
            let factor = (f64::from(level.pixels()) / pixels).sqrt().min(1.0);
            let shrink = |n: u32| ((f64::from(n) * factor).round() as u32).max(1);
            sensor.resize(shrink(sensor.width), shrink(sensor.height));
        }
        let scale = settings.ppm.radius_scale.get();
        let settings = RenderSettings {
            samples_per_pixel: NonZeroU32::MIN,
            error: false,
            ppm: PpmSettings {
                photons_per_pass: settings.ppm.photons_per_pass.min(level.photons()),
                first_pass: level.photons(),
                radius_scale: RadiusScale::new(SMOOTH * scale).unwrap_or(settings.ppm.radius_scale),
                ..settings.ppm
            },
            ..settings.clone()
        };
        // Sensors that made a scene once make one at any size.
        let scene = Arc::new(scene.with_sensors(&sensors).map_err(|_| Cancelled)?);
        Ok(Self::over(Session::start_on(Arc::clone(pool), scene, settings, tell, cancel)?, level))
    }

    fn over(session: Session, level: Level) -> Self {
        let rates = Rates::since(Mark::of(&session));
        Self {
            session,
            level,
            rates,
            pass_took: Duration::ZERO,
            preview_share: 1.0,
            no_photon_share: 1.0,
            photons_in_pass: 0,
            radii_at_floor: 0,
            radii: None,
        }
    }

    /// The render once its session has resumed a checkpoint: clocks, photons and rays are then the checkpoint's.
    pub(super) fn resumed(self) -> Self {
        Self { preview_share: self.preview_share, ..Self::over(self.session, self.level) }
    }

    /// As the one that is shown instead of a preview, once it is better.
    pub(super) fn after(self, preview: Option<&Self>) -> Self {
        Self { preview_share: preview.map_or(1.0, |preview| preview.no_photon_share), ..self }
    }

    /// Whether the picture is better than that of the preview: few more hit points are still without a photon, if any, at more pixels.
    /// After some passes, what is dark then will stay dark for a while.
    pub(super) fn beats_its_preview(&self) -> bool {
        const MORE: f64 = 0.02;
        const PASSES: u64 = 16;
        self.no_photon_share <= self.preview_share + MORE || self.render().passes() >= PASSES
    }

    pub(super) const fn level(&self) -> Level {
        self.level
    }

    pub(super) fn is_whole(&self) -> bool {
        self.level == Level::Whole
    }

    /// The level that is due once this one is as good as it gets, where the whole has so many eye samples.
    pub(super) fn next_level(&self, eye_samples: u64) -> Option<Level> {
        (self.render().passes() >= self.level.passes()).then(|| self.level.next(eye_samples))
    }

    /// Whether there is nothing to do until a person goes on, or stops.
    pub(super) fn waits_for_a_move(&self) -> bool {
        self.level == Level::Small && self.render().passes() >= SMALL_PASSES
    }

    pub(super) const fn render(&self) -> &Render {
        self.session.render()
    }

    pub(super) const fn session(&self) -> &Session {
        &self.session
    }

    pub(super) const fn session_mut(&mut self) -> &mut Session {
        &mut self.session
    }

    pub(super) const fn elapsed(&self) -> Duration {
        self.session.elapsed()
    }

    /// One pass, or a part of it; returns how long the pass took, once it is whole.
    pub(super) fn advance(
        &mut self,
        should_suspend: ShouldSuspend<'_>,
    ) -> Result<Option<Duration>, PassError> {
        let before = self.session.elapsed();
        let outcome = self.session.advance_unless(should_suspend, &Cancel::default());
        self.pass_took += self.session.elapsed().saturating_sub(before);
        let report = match outcome {
            Ok(report) => report,
            Err(PassError::Suspended(_)) => return Ok(None),
            Err(error) => return Err(error),
        };
        self.no_photon_share = report.no_photon_share;
        self.photons_in_pass = report.photons_in_pass;
        self.radii_at_floor = report.floored;
        self.rates.add(Mark::of(&self.session));
        Ok(Some(std::mem::take(&mut self.pass_took)))
    }

    /// What a person should know of the render, whose error is to fall to a goal.
    fn findings(&self, goal: Option<f64>) -> Vec<Finding> {
        let (render, names) = (self.session.render(), &SettingNames::CONTROLS);
        let mut found = findings::of_render(render, names);
        // Edits may have taken it away.
        found.extend(findings::without_light(render.scene()));
        found.extend(goal.and_then(|goal| findings::above_goal(render, goal, self.radii_at_floor, names)));
        found
    }

    /// How the render stands, whose error is to fall to a goal.
    pub(super) fn stats(&mut self, goal: Option<f64>) -> RenderStats {
        let render = self.session.render();
        let RecentRadii { radii, .. } = match self.radii {
            Some(recent) if recent.at.elapsed() < RADII_EVERY => recent,
            _ => *self.radii.insert(RecentRadii { at: Instant::now(), radii: render.radii() }),
        };
        let PerSecond { photons: photons_per_s, rays: rays_per_s } = self.rates.per_second();
        RenderStats {
            passes: render.passes(),
            photons: render.photons_emitted(),
            photons_in_pass: self.photons_in_pass,
            elapsed: self.session.elapsed(),
            photons_per_s,
            rays_per_s,
            stages: *self.session.stages(),
            hit_points: render.start_report().hit_points,
            no_photon_share: self.no_photon_share,
            error: render.error(),
            ledger: *render.ledger(),
            radii,
            bytes: render.bytes(),
            findings: Arc::new(self.findings(goal)),
        }
    }

    /// The picture as it stands; radiance where what is asked for is not estimated.
    pub(super) fn picture(&self, view: ViewMode) -> Picture {
        let render = self.render();
        let measure = |label, values: Vec<f32>| {
            let image = &render.scene().sensors()[render.settings().sensor];
            let plane = Plane { width: image.width, height: image.height, values };
            Picture::Measure { label, plane: Arc::new(plane) }
        };
        match view {
            ViewMode::Radiance => Picture::Colour(Arc::new(render.image())),
            ViewMode::Classes { reflected, emission } => {
                Picture::Colour(Arc::new(classes(render, reflected, emission)))
            }
            ViewMode::Radius => measure("radius (world units)", render.mean_radii()),
            ViewMode::PhotonCount => {
                measure("photons found", render.photons_found().into_iter().map(|n| n as f32).collect())
            }
            ViewMode::Luminance => {
                measure("luminance (W/m²/sr)", render.image().pixels.iter().map(|c| c.luminance()).collect())
            }
            ViewMode::Unknown => measure("unlit hit points", render.unknown_share()),
            ViewMode::Error(part) => {
                let (label, kind) = match part {
                    ErrorPart::Noise => ("noise (W/m²/sr)", LayerKind::ErrorNoise),
                    ErrorPart::Bias => ("bias (W/m²/sr)", LayerKind::ErrorBias),
                    ErrorPart::Total => ("error (W/m²/sr)", LayerKind::ErrorTotal),
                };
                render
                    .error_plane(kind)
                    .map_or_else(|| Picture::Colour(Arc::new(render.image())), |plane| measure(label, plane))
            }
        }
    }
}

/// The sum of some kinds of light.
fn classes(render: &Render, reflected: [bool; 3], emission: bool) -> Image {
    let kinds = [LayerKind::Direct, LayerKind::Caustic, LayerKind::Indirect, LayerKind::Emission];
    let wanted = [reflected[0], reflected[1], reflected[2], emission];
    let mut layers = kinds
        .into_iter()
        .zip(wanted)
        .filter(|(_, wanted)| *wanted)
        .map(|(kind, _)| render.colour_layer(kind));
    let Some(first) = layers.next() else {
        let image = render.image();
        return Image::black(image.width, image.height);
    };
    let add = |sum: Option<Image>, layer: Option<Image>| {
        let (mut sum, layer) = (sum?, layer?);
        sum.pixels.iter_mut().zip(&layer.pixels).for_each(|(s, &l): (&mut Rgb, &Rgb)| *s += l);
        Some(sum)
    };
    layers.fold(first, add).unwrap_or_else(|| render.image())
}
