//! Whether there is memory for what is to be rendered next.

use std::num::NonZeroU32;

use foton_integrator::RenderSettings;
use foton_scene::Scene;

use super::level::Level;
use crate::session::Session;

/// The level that is to be collected instead of `level` so that memory suffices: that, or the whole at once; or why that is refused.
pub(super) fn within_memory(
    level: Level,
    scene: &Scene,
    settings: &RenderSettings,
    threads: Option<usize>,
    limit: Option<f64>,
) -> Result<Level, String> {
    let whole = Session::estimate_memory(scene, settings, threads);
    if let Some(refusal) = whole.refusal(limit) {
        return Err(format!("{refusal}. Fewer samples/pixel or photons/pass need less"));
    }
    let Level::Samples(samples) = level else { return Ok(level) };
    let some = RenderSettings {
        samples_per_pixel: NonZeroU32::new(samples).unwrap_or(NonZeroU32::MIN),
        ..level.settings(settings)
    };
    // It is still looked at while the whole is collected.
    let both = whole.beside(&Session::estimate_memory(scene, &some, threads));
    Ok(if limit.is_some_and(|limit| both > limit) { Level::Whole } else { level })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_scene::discs;

    #[test]
    fn where_memory_is_short_the_whole_is_collected_at_once_or_refused() {
        let scene = discs(None);
        let samples_per_pixel = NonZeroU32::new(8).expect("not zero");
        let settings = RenderSettings { samples_per_pixel, ..RenderSettings::default() };
        let whole = Session::estimate_memory(&scene, &settings, Some(1)).peak_bytes();
        let within = |level, limit| within_memory(level, &scene, &settings, Some(1), limit);
        let some = Level::Samples(1);
        assert_eq!(within(some, None), Ok(some));
        assert_eq!(within(some, Some(4.0 * whole)), Ok(some));
        assert_eq!(within(some, Some(1.001 * whole)), Ok(Level::Whole));
        assert_eq!(within(Level::Whole, Some(1.001 * whole)), Ok(Level::Whole));
        assert!(within(some, Some(0.5 * whole)).is_err_and(|said| said.contains("Fewer samples/pixel")));
    }
}
