//! Findings in a render under way: starved emitters, power that was lost, bias that stays.

use foton_input::quoted;
use foton_integrator::{Render, RenderSettings, lobe_use};
use foton_scene::Scene;

use super::{Finding, FindingKind, SettingNames};

/// Power that is cut off beyond this share of what is emitted is worth a warning.
pub const MIN_CUT_OFF: f64 = 1e-3;

/// Names that a finding lists at most.
const MAX_NAMES: usize = 20;

/// Passes after which bias at the smallest radii is known.
const MIN_PASSES: f64 = 16.0;

/// Share of the bias below which noise is small beside it.
const SMALL_NOISE: f64 = 0.3;

/// All findings in a render as it stands.
#[must_use]
pub fn of_render(render: &Render, names: &SettingNames) -> Vec<Finding> {
    let mut findings = of_settings(render.scene(), render.settings(), names);
    findings.extend(of_ledger(render, names));
    findings.extend(of_emitters(render));
    findings
}

/// Settings that do not fit the scene.
#[must_use]
pub fn of_settings(scene: &Scene, settings: &RenderSettings, names: &SettingNames) -> Vec<Finding> {
    let largest = scene.normalisation().world_length(2.0 * f64::from(scene.bounds().radius()));
    let too_large = settings.ppm.radius.filter(|radius| *radius > largest);
    let finding = too_large.map(|_| {
        let text =
            format!("{} is larger than the whole scene and is cut to that, {largest:.4}", names.radius);
        Finding::new(FindingKind::RadiusBeyondScene, None, text)
    });
    let finding = finding.filter(|_| settings.method.has_photons());
    finding.into_iter().chain(of_method(scene, settings, names)).collect()
}

/// What a method cannot do with a scene, or does in a way of its own.
fn of_method(scene: &Scene, settings: &RenderSettings, names: &SettingNames) -> Vec<Finding> {
    let (census, lobes, method) = (scene.census(), lobe_use(scene), settings.method);
    let mut findings = Vec::new();
    if method.misses_caustics_of_points() && census.delta_emitters && census.bends_light() {
        let text = format!(
            "{} finds no light of points, spots and suns that mirrors or smooth glass throw on other surfaces: these caustics are \
             missing",
            method.title()
        );
        findings.push(Finding::new(FindingKind::LightMissed, None, text));
    }
    if let Some(why) = method.error_is_unknown(scene).filter(|_| settings.error) {
        let text = format!("the error of the image is not estimated by {}: {why}", method.name());
        findings.push(Finding::new(FindingKind::ErrorUnknown, None, text));
    }
    if scene.blurs(settings.sensor) && !method.blurs_motion() {
        let text =
            "what moves is seen as it is when the shutter opens: this method follows its eye samples once";
        findings.push(Finding::new(FindingKind::MotionFrozen, None, text));
    }
    if !method.renews_eye_samples() && lobes.specular_gloss {
        let text = format!(
            "gloss of roughness up to 0.1 is followed in directions chosen once: its noise stays; {} lowers it",
            names.eye_samples
        );
        findings.push(Finding::new(FindingKind::NarrowGloss, None, text));
    }
    if method.has_photons() && lobes.highlights_by_photons {
        let text = "light of points, spots and suns that mirrors or glass throw on such gloss comes as photons: the narrower, \
                    the noisier";
        findings.push(Finding::new(FindingKind::NarrowCaustics, None, text));
    }
    findings
}

/// Emitters that most photons leave in vain.
#[must_use]
pub fn of_emitters(render: &Render) -> Vec<Finding> {
    // With shadow rays the photons of an emitter need not reach anything that it lights directly.
    if render.has_shadow_rays() {
        return Vec::new();
    }
    let photons = render.photons_emitted();
    let emitters = render.scene().emitters().iter().zip(render.light_use());
    let starved = emitters.filter(|(_, light)| light.is_starved(photons));
    let findings = starved.map(|(emitter, light)| {
        let text = format!(
            "{} takes {:.0} % of the photons, and {:.2} % of those come near anything that is seen: what it lights converges \
             slowly",
            quoted(&emitter.name),
            100.0 * light.emitted as f64 / photons as f64,
            100.0 * light.hit_rate()
        );
        Finding::new(FindingKind::StarvedEmitter, Some(&emitter.name), text)
    });
    findings.collect()
}

/// Light that went missing, and where.
#[must_use]
pub fn of_ledger(render: &Render, names: &SettingNames) -> Vec<Finding> {
    let mut findings: Vec<Finding> = power_cut_off(render, names).into_iter().collect();
    let eye_paths = render.start_report().dropped;
    if eye_paths > 0 {
        let text = format!("{eye_paths} eye paths were dropped because their weight was not finite");
        findings.push(Finding::new(FindingKind::EyePathsDropped, None, text));
    }
    findings.extend(photons_dropped(render));
    findings
}

fn power_cut_off(render: &Render, names: &SettingNames) -> Option<Finding> {
    let ledger = render.ledger();
    let share = ledger.truncated / ledger.emitted.max(f64::MIN_POSITIVE);
    if share <= MIN_CUT_OFF {
        return None;
    }
    let materials = render.scene().materials().iter().zip(render.material_losses());
    let most = materials.max_by(|a, b| a.1.truncated.total_cmp(&b.1.truncated));
    let place = most.map_or_else(String::new, |(material, loss)| {
        format!(", {:.0} % of that at {}", 100.0 * loss.truncated / ledger.truncated, quoted(&material.name))
    });
    let text = format!(
        "{:.1} % of the emitted power was cut off at the longest path{place}; {} sets it",
        share * 100.0,
        names.max_depth
    );
    Some(Finding::new(FindingKind::PowerCutOff, most.map(|(material, _)| &*material.name), text))
}

fn photons_dropped(render: &Render) -> Option<Finding> {
    let dropped = render.ledger().dropped;
    if dropped == 0 {
        return None;
    }
    let scene = render.scene();
    let emitters = scene.emitters().iter().zip(render.light_use());
    let materials = scene.materials().iter().zip(render.material_losses());
    let by_emitter = emitters.map(|(emitter, light)| (emitter.name.as_str(), light.dropped));
    let by_material = materials.map(|(material, loss)| (material.name.as_str(), loss.dropped));
    let all: Vec<_> = by_emitter.chain(by_material).filter(|(_, n)| *n > 0).collect();
    let gathered = dropped - all.iter().map(|(_, n)| n).sum::<u64>().min(dropped);
    let named = all.iter().map(|(name, n)| format!("{n} at {}", quoted(name)));
    let gathered = (gathered > 0).then(|| format!("{gathered} where light was gathered"));
    let places: Vec<String> = named.take(MAX_NAMES).chain(gathered).collect();
    let text = format!(
        "{dropped} photons or sums of them were dropped because they were not finite: {}",
        places.join(", ")
    );
    let place = if let [(name, _)] = all[..] { Some(name) } else { None };
    Some(Finding::new(FindingKind::PhotonsDropped, place, text))
}

/// Why the error will not fall to a goal however long the render goes on, if that is so: the bias of the radius floor, at which
/// some radii were in the last pass.
#[must_use]
pub fn above_goal(render: &Render, goal: f64, radii_at_floor: u64, names: &SettingNames) -> Option<Finding> {
    let error = render.error()?;
    let is_floor = error.bias > goal && error.noise < SMALL_NOISE * error.bias && radii_at_floor > 0;
    (is_floor && error.effective_passes >= MIN_PASSES).then(|| {
        let text = format!(
            "the error will not fall to {:.3} %: the smallest radii leave a bias of about {:.1} %; more eye samples ({} {}) or \
             {} 0 lower it",
            100.0 * goal,
            100.0 * error.bias,
            names.eye_samples,
            4 * render.settings().samples_per_pixel.get(),
            names.radius_floor
        );
        Finding::new(FindingKind::RadiusFloorAboveGoal, None, text)
    })
}
