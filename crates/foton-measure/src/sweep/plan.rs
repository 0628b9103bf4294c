//! What a sweep renders: a star around one configuration, and the plane of α and photons a pass.

use std::fmt;
use std::num::NonZeroU32;

use foton_integrator::{
    Alpha, DirectLight, PpmSettings, RadiusFloor, RadiusRule, RadiusScale, RenderSettings,
};

use crate::plot::short;

/// Values of α.
const ALPHAS: [f64; 7] = [0.5, 0.6, 2.0 / 3.0, 0.7, 0.8, 0.9, 1.0];

/// Factors on first radii.
const SCALES: [f64; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];

/// Photons a pass, as powers of two.
const PHOTONS: std::ops::RangeInclusive<u32> = 14..=22;

/// What one run differs in from others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Configuration {
    /// Fraction of new photons retained.
    pub alpha: Alpha,
    /// Photons a pass, once passes have grown.
    pub photons: NonZeroU32,
    /// Factor on first radii.
    pub radius_scale: RadiusScale,
    /// How far radii shrink.
    pub radius_floor: RadiusFloor,
    /// How radii shrink.
    pub radius_rule: RadiusRule,
    /// How direct light is estimated.
    pub direct_light: DirectLight,
}

impl Configuration {
    /// That of a render's settings.
    #[must_use]
    pub const fn of(settings: &RenderSettings) -> Self {
        Self {
            alpha: settings.ppm.alpha,
            photons: settings.ppm.photons_per_pass,
            radius_scale: settings.ppm.radius_scale,
            radius_floor: settings.ppm.radius_floor,
            radius_rule: settings.ppm.radius_rule,
            direct_light: settings.ppm.direct_light,
        }
    }

    /// Render settings with this configuration.
    #[must_use]
    pub fn settings(&self, base: &RenderSettings) -> RenderSettings {
        RenderSettings {
            ppm: PpmSettings {
                alpha: self.alpha,
                photons_per_pass: self.photons,
                radius_scale: self.radius_scale,
                radius_floor: self.radius_floor,
                radius_rule: self.radius_rule,
                direct_light: self.direct_light,
                ..base.ppm
            },
            ..base.clone()
        }
    }

    /// The options of `foton render` that ask for it.
    #[must_use]
    pub fn options(&self) -> String {
        let mut options =
            format!("--alpha {} --photons {}", (self.alpha.get() * 1e4).round() / 1e4, self.photons);
        if self.radius_scale != RadiusScale::default() {
            options += &format!(" --radius x{}", self.radius_scale);
        }
        if self.radius_floor != RadiusFloor::default() {
            options += &format!(" --radius-floor {}", self.radius_floor);
        }
        if self.radius_rule != RadiusRule::default() {
            options += &format!(" --radius-rule {}", self.radius_rule.name());
        }
        if self.direct_light != DirectLight::default() {
            options += &format!(" --direct {}", self.direct_light.name());
        }
        options
    }
}

impl fmt::Display for Configuration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "α {}, {} photons, radius × {}",
            share(self.alpha),
            count(self.photons.get().into()),
            scale(self.radius_scale.get())
        )?;
        if self.radius_floor == RadiusFloor::NONE {
            write!(f, " with no smallest radius")?;
        } else if self.radius_floor != RadiusFloor::default() {
            write!(f, " down to {} spacings of the eye samples", self.radius_floor)?;
        }
        match self.radius_rule {
            RadiusRule::Local => write!(f, " shrinking each by its photons")?,
            RadiusRule::Global => write!(f, " shrinking together")?,
            RadiusRule::Adaptive => {}
        }
        match self.direct_light {
            DirectLight::Auto => {}
            DirectLight::Photons => write!(f, ", direct light by photons")?,
            DirectLight::ShadowRays => write!(f, ", shadow rays")?,
        }
        Ok(())
    }
}

/// α as a person writes it.
pub(crate) fn share(alpha: Alpha) -> String {
    if alpha == Alpha::default() { "⅔".to_owned() } else { short(alpha.get()) }
}

/// A factor as a person writes it.
pub(crate) fn scale(v: f64) -> String {
    match v {
        0.25 => "¼".to_owned(),
        0.5 => "½".to_owned(),
        v => short(v),
    }
}

/// A count in thousands or millions.
pub(crate) fn count(n: u64) -> String {
    match n {
        0..10_000 => n.to_string(),
        10_000..1_000_000 => format!("{:.0} k", n as f64 / 1e3),
        _ => format!("{} M", short((n as f64 / 1e5).round() / 10.0)),
    }
}

/// Runs that share their photons, and so run together.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Job {
    pub(crate) photons: NonZeroU32,
    /// How direct light is estimated, where that is not the centre's way.
    pub(crate) other_direct_light: Option<DirectLight>,
    pub(crate) configurations: Vec<Configuration>,
}

impl Job {
    /// A name that no other job of the sweep has.
    pub(crate) fn name(&self) -> String {
        let direct = self.other_direct_light.map_or_else(String::new, |way| format!("-{}", way.name()));
        format!("{:08}{direct}", self.photons)
    }

    /// Render settings of its runs; after those of its configurations, where the centre is among them, the centre's with layers.
    pub(crate) fn settings(&self, base: &RenderSettings) -> Vec<RenderSettings> {
        let centre = Configuration::of(base);
        let mut settings: Vec<RenderSettings> =
            self.configurations.iter().map(|c| c.settings(base)).collect();
        if self.configurations.contains(&centre) {
            settings.push(RenderSettings { layers: true, ..centre.settings(base) });
        }
        settings
    }
}

/// All jobs, the centre's first, then the others by how far from it they are.
pub(crate) fn jobs(centre: &Configuration) -> Vec<Job> {
    let mut alphas: Vec<Alpha> = ALPHAS.into_iter().filter_map(Alpha::new).collect();
    if !alphas.contains(&centre.alpha) {
        alphas.push(centre.alpha);
    }
    alphas.sort_by(|a, b| a.get().total_cmp(&b.get()));
    let mut photons: Vec<NonZeroU32> = PHOTONS.filter_map(|power| NonZeroU32::new(1 << power)).collect();
    if !photons.contains(&centre.photons) {
        photons.push(centre.photons);
    }
    let distance =
        |photons: &NonZeroU32| (f64::from(photons.get()) / f64::from(centre.photons.get())).log2().abs();
    photons.sort_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)));
    let plane = |photons: NonZeroU32| {
        alphas.iter().map(move |&alpha| Configuration { alpha, photons, ..*centre }).collect::<Vec<_>>()
    };
    let job = |photons| Job { photons, other_direct_light: None, configurations: plane(photons) };
    let mut jobs: Vec<Job> = photons.into_iter().map(job).collect();
    if let Some(first) = jobs.first_mut() {
        let (same, others): (Vec<_>, Vec<_>) =
            arms(centre).into_iter().partition(|arm| arm.direct_light == centre.direct_light);
        first.configurations.extend(same);
        // Guided photons depend on how direct light is estimated.
        let apart = others.into_iter().map(|arm| Job {
            photons: arm.photons,
            other_direct_light: Some(arm.direct_light),
            configurations: vec![arm],
        });
        jobs.splice(1..1, apart.collect::<Vec<_>>());
    }
    jobs
}

/// The star's arms beside α and photons.
fn arms(centre: &Configuration) -> Vec<Configuration> {
    let scales = SCALES.into_iter().filter_map(|s| RadiusScale::new(s * centre.radius_scale.get()));
    let mut arms: Vec<Configuration> =
        scales.map(|radius_scale| Configuration { radius_scale, ..*centre }).collect();
    // What is chosen for a scene is mostly shadow rays.
    arms.push(Configuration {
        direct_light: match centre.direct_light {
            DirectLight::Photons => DirectLight::ShadowRays,
            DirectLight::Auto | DirectLight::ShadowRays => DirectLight::Photons,
        },
        ..*centre
    });
    arms.extend(RadiusRule::ALL.map(|radius_rule| Configuration { radius_rule, ..*centre }));
    arms.retain(|arm| arm != centre);
    arms
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_centre_is_in_the_first_job_once_and_the_plane_is_whole() {
        let centre = Configuration::of(&RenderSettings::default());
        let jobs = jobs(&centre);
        assert_eq!(jobs.len(), 1 + 9);
        assert_eq!(jobs[0].configurations.len(), 7 + 4 + 2);
        assert_eq!(jobs[0].configurations.iter().filter(|c| **c == centre).count(), 1);
        assert!(
            jobs[1].configurations.len() == 1
                && jobs[1].configurations[0].direct_light != centre.direct_light
        );
        assert!(jobs[2..].iter().all(|job| job.configurations.len() == 7));
        let names: std::collections::BTreeSet<String> = jobs.iter().map(Job::name).collect();
        assert_eq!(names.len(), jobs.len(), "each has files of its own");
        let mut photons: Vec<u32> = jobs[1..].iter().map(|job| job.photons.get()).collect();
        assert_eq!(&photons[..3], [1 << 18, 1 << 17, 1 << 19]);
        photons.sort_unstable();
        assert_eq!(photons, (14..=22).map(|power| 1 << power).collect::<Vec<u32>>());
    }

    #[test]
    fn a_centre_of_its_own_joins_the_plane() {
        let alpha = Alpha::new(0.75).expect("in range");
        let photons = NonZeroU32::new(100_000).expect("above 0");
        let centre = Configuration { alpha, photons, ..Configuration::of(&RenderSettings::default()) };
        let jobs = jobs(&centre);
        assert_eq!((jobs.len(), jobs[0].photons), (1 + 10, photons));
        assert_eq!(jobs[0].configurations.iter().filter(|c| **c == centre).count(), 1);
        assert_eq!(centre.to_string(), "α 0.75, 100 k photons, radius × 1");
        let shadow = Configuration { direct_light: DirectLight::ShadowRays, ..centre };
        assert_eq!(shadow.options(), "--alpha 0.75 --photons 100000 --direct shadow-rays");
    }
}
