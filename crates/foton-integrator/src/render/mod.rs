//! A render under way, by whichever method: what sessions, windows and measurements see of it.

use std::sync::Arc;

use foton_scene::Scene;
use foton_transport::codec::StateError;
use foton_transport::{Cancel, Cancelled, Halt, Ledger, LightUse, Loss, NotFinite, ShouldSuspend, Stage};

use crate::photon_map::KeptMaps;
use crate::ppm::{EyeSamples, Ppm};
use crate::report::{PassReport, Start};
use crate::sampled::Sampled;
use crate::settings::{RenderSettings, SettingChange};

/// A scene, settings, and what passes have made of them so far.
pub struct Render(Running);

/// One variant a method.
enum Running {
    Ppm(Box<Ppm>),
    Sampled(Box<Sampled>),
}

/// The same expression for the render of any method.
macro_rules! each {
    ($render:expr, $method:ident => $body:expr) => {
        match $render {
            Running::Ppm($method) => $body,
            Running::Sampled($method) => $body,
        }
    };
}

mod display;
mod images;
mod parts;

impl Render {
    /// Collects hit points. `watch` is told each stage as it begins.
    ///
    /// # Errors
    /// When cancelled.
    pub fn start(
        scene: Arc<Scene>,
        settings: RenderSettings,
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        Self::start_telling(scene, settings, &|_| (), watch, cancel)
    }

    /// One by progressive photon mapping.
    pub(crate) fn of_ppm(ppm: Ppm) -> Self {
        Self(Running::Ppm(Box::new(ppm)))
    }

    /// As [`Render::start`]; `tell` is told by many threads what share of the eye samples is followed.
    ///
    /// # Errors
    /// When cancelled.
    pub fn start_telling(
        scene: Arc<Scene>,
        settings: RenderSettings,
        tell: &(dyn Fn(f64) + Sync),
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        Self::over(EyeSamples::new(scene, settings), tell, watch, cancel)
    }

    /// As [`Render::start_telling`], over eye samples of which some have been followed: no bit is another for that.
    ///
    /// # Errors
    /// When cancelled.
    pub fn over(
        eye: EyeSamples,
        tell: &(dyn Fn(f64) + Sync),
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let (scene, settings) = (Arc::clone(eye.scene()), eye.settings().clone());
        match Sampled::start(scene, settings, None, watch, cancel)? {
            Some(sampled) => Ok(Self(Running::Sampled(Box::new(sampled)))),
            None => Ok(Self(Running::Ppm(Box::new(Ppm::start(eye, tell, watch, cancel)?)))),
        }
    }

    /// A render by two-pass photon mapping with maps that were made before, of the same scene; by any other method, as
    /// [`Render::start`].
    ///
    /// # Errors
    /// When cancelled.
    pub fn start_with_maps(
        scene: Arc<Scene>,
        settings: RenderSettings,
        maps: &KeptMaps,
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        match Sampled::start(Arc::clone(&scene), settings.clone(), Some(maps), watch, cancel)? {
            Some(sampled) => Ok(Self(Running::Sampled(Box::new(sampled)))),
            None => Self::start(scene, settings, watch, cancel),
        }
    }

    /// The maps of a render by two-pass photon mapping.
    #[must_use]
    pub fn maps(&self) -> Option<KeptMaps> {
        match &self.0 {
            Running::Sampled(sampled) => sampled.maps(),
            Running::Ppm(_) => None,
        }
    }

    /// A render over the first `samples` of each pixel alone, to be looked at while the others are followed. Its passes have `settings` of
    /// their own, and first radii are multiplied by `widened`.
    ///
    /// # Errors
    /// When cancelled.
    pub fn over_some(
        (eye, samples): (&mut EyeSamples, u32),
        (settings, widened): (RenderSettings, f32),
        tell: &(dyn Fn(f64) + Sync),
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        match Sampled::start(Arc::clone(eye.scene()), settings.clone(), None, watch, cancel)? {
            Some(sampled) => Ok(Self(Running::Sampled(Box::new(sampled)))),
            None => {
                let ppm = Ppm::start_with_some((eye, samples), (settings, widened), tell, watch, cancel)?;
                Ok(Self(Running::Ppm(Box::new(ppm))))
            }
        }
    }

    /// One pass.
    ///
    /// # Errors
    /// When cancelled inside it; the pass then has not happened. After [`Render::stop_at_first_not_finite`], when a value is not:
    /// the image is then that of the passes before, and the render is not to go on.
    pub fn advance(&mut self, watch: &mut dyn FnMut(Stage), cancel: &Cancel) -> Result<PassReport, Halt> {
        self.advance_unless(&|| false, watch, cancel)
    }

    /// One pass, or what is left of one that was suspended. `should_suspend` is asked every few milliseconds; once it says yes the
    /// pass stays as it is until the next call, which goes on with it. How often that happens changes no bit.
    ///
    /// # Errors
    /// As [`Render::advance`]; and [`Halt::Suspended`].
    pub fn advance_unless(
        &mut self,
        should_suspend: ShouldSuspend<'_>,
        watch: &mut dyn FnMut(Stage),
        cancel: &Cancel,
    ) -> Result<PassReport, Halt> {
        each!(&mut self.0, r => r.advance(watch, cancel, should_suspend))
    }

    /// How much of a suspended pass is done, from 0 to 1; 0 between passes.
    #[must_use]
    pub fn pass_share(&self) -> f64 {
        each!(&self.0, r => r.pass_share())
    }

    /// Whether a suspended pass has refined hit points: they, and what [`Render::save`] says of them, are then not as the last whole pass
    /// left them. Not to be saved before [`Render::advance`] has finished that pass; the image is as it was.
    #[must_use]
    pub fn has_refined(&self) -> bool {
        each!(&self.0, r => r.has_refined())
    }

    /// Lets a suspended pass that has several batches end early, as a valid pass of fewer photons: after the batch under way; or, if
    /// `drops`, without that one unless its photons have all been traced. [`Render::advance`] then finishes it, and [`Render::changes`]
    /// says after how many batches it ended.
    pub fn cut_pass(&mut self, drops: bool) {
        each!(&mut self.0, r => r.cut_pass(drops));
    }

    /// Photons of the next pass's largest batch.
    #[must_use]
    pub fn next_batch(&self) -> u64 {
        each!(&self.0, r => r.next_batch())
    }

    /// Gives up a suspended pass, which then has not happened; `false` where it has refined hit points, or there is none.
    pub fn discard_pass(&mut self) -> bool {
        each!(&mut self.0, r => r.discard_pass())
    }

    /// From now on a pass in which a value is not finite does not happen. Otherwise such values are left out and counted.
    pub fn stop_at_first_not_finite(&mut self) {
        each!(&mut self.0, r => r.stop_at_first_not_finite());
    }

    /// The first value that was not finite since the render was started or restored, and was left out.
    #[must_use]
    pub fn first_not_finite(&self) -> Option<&NotFinite> {
        each!(&self.0, r => r.first_not_finite())
    }

    /// Changes a setting from the next pass on; not the one that is suspended. The change stands in [`Render::changes`] with the number of passes before it.
    pub fn change(&mut self, change: SettingChange) {
        each!(&mut self.0, r => r.change(change));
    }

    /// The sensors whose renders share its photons, it included; none where it has its own.
    #[must_use]
    pub fn cameras(&self) -> &[usize] {
        self.ppm().map_or(&[], Ppm::cameras)
    }

    /// All changes so far, each with the number of passes before it.
    #[must_use]
    pub fn changes(&self) -> &[(u64, SettingChange)] {
        each!(&self.0, r => r.changes())
    }

    /// The settings as they are now: of a suspended pass, those that it began with.
    #[must_use]
    pub fn settings(&self) -> &RenderSettings {
        each!(&self.0, r => r.settings())
    }

    /// Whether direct light comes by shadow rays, as settings ask or the scene suggests.
    #[must_use]
    pub fn has_shadow_rays(&self) -> bool {
        each!(&self.0, r => r.has_shadow_rays())
    }

    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &Arc<Scene> {
        each!(&self.0, r => r.scene())
    }

    /// Passes so far.
    #[must_use]
    pub fn passes(&self) -> u64 {
        each!(&self.0, r => r.passes())
    }

    /// Photons emitted so far.
    #[must_use]
    pub fn photons_emitted(&self) -> u64 {
        each!(&self.0, r => r.photons_emitted())
    }

    /// What was found when the render was started.
    #[must_use]
    pub fn start_report(&self) -> &Start {
        each!(&self.0, r => r.start_report())
    }

    /// Where all emitted power went.
    #[must_use]
    pub fn ledger(&self) -> &Ledger {
        each!(&self.0, r => r.ledger())
    }

    /// What the photons of each emitter were good for, in the order of the scene's emitters.
    #[must_use]
    pub fn light_use(&self) -> &[LightUse] {
        each!(&self.0, r => r.light_use())
    }

    /// What went missing at each material, in the order of the scene's materials.
    #[must_use]
    pub fn material_losses(&self) -> &[Loss] {
        each!(&self.0, r => r.material_losses())
    }

    /// Bytes held, the scene included.
    #[must_use]
    pub fn bytes(&self) -> usize {
        each!(&self.0, r => r.bytes())
    }

    /// All that passes have changed, as bytes. [`Render::restore`] takes it back into a render that was started with the same
    /// scene and settings, and the passes after that give the same bits as if there had been no break.
    #[must_use]
    pub fn save(&self) -> Vec<u8> {
        each!(&self.0, r => r.save())
    }

    /// Takes what [`Render::save`] gave back. After an error the render is not to be used.
    ///
    /// # Errors
    /// When the bytes are no state, or that of another render; see [`StateError`].
    pub fn restore(&mut self, state: &[u8]) -> Result<(), StateError> {
        each!(&mut self.0, r => r.restore(state))
    }
}

/// For what is particular to a method.
impl Render {
    pub(crate) fn ppm(&self) -> Option<&Ppm> {
        match &self.0 {
            Running::Ppm(ppm) => Some(ppm),
            Running::Sampled(_) => None,
        }
    }

    pub(crate) fn ppm_mut(&mut self) -> Option<&mut Ppm> {
        match &mut self.0 {
            Running::Ppm(ppm) => Some(ppm),
            Running::Sampled(_) => None,
        }
    }
}
