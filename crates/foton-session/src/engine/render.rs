//! One render under way, at one level.

use std::sync::Arc;
use std::time::{Duration, Instant};

use foton_film::Plane;
use foton_integrator::{
    Cancel, Cancelled, EyeSamples, LayerKind, Radii, Render, RenderSettings, SettingChange, ShouldSuspend,
    Stage,
};
use foton_scene::Scene;
use foton_scene::description::SensorDescription;
use rayon::ThreadPool;

use super::command::{ErrorPart, ViewMode};
use super::frame::{Picture, RenderStats};
use super::level::Level;
use super::rates::{Mark, PerSecond, Rates};
use crate::findings::{self, Finding, SettingNames};
use crate::session::{PassError, Session, StartError};
use crate::shown::Shown;

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

/// What a picture rests on.
#[derive(Clone, Copy, Debug)]
struct Standing {
    /// Share of hit points without a photon.
    unlit: f64,
    /// Photons that a hit point has found on average; zero where that says nothing.
    found: f64,
}

impl Standing {
    /// Whether a picture with more eye samples, and smaller discs, is better than a preview: few more hit points are unlit, if any, and what
    /// fewer photons add to its noise is less than what smaller discs take from its bias. Measured in docs/performance.md.
    fn beats(self, preview: Self) -> bool {
        const MORE_UNLIT: f64 = 0.06;
        const OF_PHOTONS: f64 = 0.4;
        self.unlit <= preview.unlit + MORE_UNLIT && self.found >= OF_PHOTONS * preview.found
    }
}

/// Eye samples that have been followed, and how long that took.
pub(super) struct Followed {
    eye: EyeSamples,
    took: Duration,
}

impl Followed {
    /// None yet of a render of a scene.
    pub(super) fn none(scene: Arc<Scene>, settings: RenderSettings) -> Self {
        Self { eye: EyeSamples::new(scene, settings), took: Duration::ZERO }
    }

    /// The share of all samples.
    pub(super) fn share(&self) -> f64 {
        f64::from(self.eye.followed()) / f64::from(self.eye.settings().samples_per_pixel.get())
    }
}

/// A render at one level.
pub(super) struct LevelRender {
    session: Session,
    level: Level,
    rates: Rates,
    /// How long the pass under way has taken so far.
    pass_took: Duration,
    /// What the picture rests on that is shown before this one's.
    preview: Option<Standing>,
    no_photon_share: f64,
    /// Photons that hit points have found in all passes.
    found: u64,
    photons_in_pass: u64,
    /// Radii that were at the radius floor in the last pass.
    radii_at_floor: u64,
    radii: Option<RecentRadii>,
    followed: Option<Followed>,
}

impl LevelRender {
    /// A picture of fewer pixels than the whole.
    pub(super) fn start(
        level: Level,
        scene: &Scene,
        sensors: &[SensorDescription],
        settings: &RenderSettings,
        pool: &Arc<ThreadPool>,
        cancel: &Cancel,
    ) -> Result<Self, StartError> {
        let mut sensors = sensors.to_vec();
        for sensor in &mut sensors {
            let [width, height] = sensor.crop.map_or([sensor.width, sensor.height], |c| [c.width, c.height]);
            let pixels = f64::from(width) * f64::from(height);
            let factor = (f64::from(level.pixels()) / pixels).sqrt().min(1.0);
            let shrink = |n: u32| ((f64::from(n) * factor).round() as u32).max(1);
            sensor.resize(shrink(sensor.width), shrink(sensor.height));
        }
        // Sensors that made a scene once make one at any size.
        let scene = Arc::new(scene.with_sensors(&sensors).map_err(|_| Cancelled)?);
        let settings = level.settings_of_fewer_pixels(settings);
        Ok(Self::over(Session::start_on(Arc::clone(pool), scene, settings, &|_| (), cancel)?, level))
    }

    /// A picture of all pixels, by eye samples of which some have been followed.
    pub(super) fn collect(
        level: Level,
        followed: Followed,
        pool: &Arc<ThreadPool>,
        tell: &(dyn Fn(f64) + Sync),
        cancel: &Cancel,
    ) -> Result<Self, StartError> {
        let Followed { mut eye, took } = followed;
        let (pool, seed) = (Arc::clone(pool), eye.settings().seed);
        let Level::Samples(samples) = level else {
            let session =
                Session::start_by(pool, seed, took, |watch| Render::over(eye, tell, watch, cancel))?;
            return Ok(Self::over(session, level));
        };
        let settings = (level.settings(eye.settings()), level.widened() as f32);
        let session = Session::start_by(pool, seed, took, |watch| {
            Render::over_some((&mut eye, samples), settings, tell, watch, cancel)
        })?;
        let took = session.stages().of(Stage::EyePass);
        Ok(Self { followed: Some(Followed { eye, took }), ..Self::over(session, level) })
    }

    /// The eye samples that have been followed for it, for the level after it.
    pub(super) const fn take_followed(&mut self) -> Option<Followed> {
        self.followed.take()
    }

    fn over(session: Session, level: Level) -> Self {
        let rates = Rates::since(Mark::of(&session));
        Self {
            session,
            level,
            rates,
            pass_took: Duration::ZERO,
            preview: None,
            no_photon_share: 1.0,
            found: 0,
            photons_in_pass: 0,
            radii_at_floor: 0,
            radii: None,
            followed: None,
        }
    }

    /// The render once its session has resumed a checkpoint: clocks, photons and rays are then the checkpoint's.
    pub(super) fn resumed(self) -> Self {
        Self { preview: self.preview, ..Self::over(self.session, self.level) }
    }

    /// As the one that is shown instead of a preview, once it is better.
    pub(super) fn after(self, preview: Option<&Self>) -> Self {
        Self { preview: preview.map(Self::standing), ..self }
    }

    /// What its picture rests on. With fewer pixels, photons say nothing.
    fn standing(&self) -> Standing {
        let hit_points = self.render().start_report().hit_points.max(1) as f64;
        let counts = self.level > Level::Middle;
        Standing {
            unlit: self.no_photon_share,
            found: if counts { self.found as f64 / hit_points } else { 0.0 },
        }
    }

    /// Whether the picture is better than that of the preview. That with fewer pixels is no match for one of all of them. After some
    /// passes, what is dark then will stay dark for a while.
    pub(super) fn beats_its_preview(&self) -> bool {
        const PASSES: u64 = 16;
        let is_done = self.render().passes() >= self.level.passes().min(PASSES);
        is_done
            || self.level <= Level::Samples(1)
            || self.preview.is_none_or(|preview| self.standing().beats(preview))
    }

    pub(super) const fn level(&self) -> Level {
        self.level
    }

    pub(super) fn is_whole(&self) -> bool {
        self.level == Level::Whole
    }

    /// The level that is due once this one is as good as it gets, where the whole has so many pixels and these settings.
    pub(super) fn next_level(&self, pixels: u64, whole: &RenderSettings) -> Option<Level> {
        (self.render().passes() >= self.level.passes()).then(|| self.level.next(pixels, whole))
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

    /// From the next pass on with α and photons of these settings.
    pub(super) fn steer(&mut self, wanted: &RenderSettings) {
        let (render, wanted) = (self.session.render_mut(), wanted.ppm);
        let now = render.settings().ppm;
        if now.alpha != wanted.alpha {
            render.change(SettingChange::Alpha(wanted.alpha));
        }
        if now.photons_per_pass != wanted.photons_per_pass {
            render.change(SettingChange::PhotonsPerPass(wanted.photons_per_pass));
        }
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
        self.found += report.accepted;
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
                Picture::Colour(Arc::new(classes(reflected, emission).image(render)))
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

/// Some kinds of light.
fn classes(reflected: [bool; 3], emission: bool) -> Shown {
    let wanted = Shown::KINDS.into_iter().zip(reflected.into_iter().chain([emission]));
    Shown::Light(wanted.filter(|(_, wanted)| *wanted).map(|(kind, _)| kind).collect())
}

#[cfg(test)]
mod tests;
