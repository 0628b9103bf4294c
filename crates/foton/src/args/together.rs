//! Options that contradict each other, or name one file twice: refused before anything is read.

use foton_integrator::Method;
use foton_session::snapshot::Format;

use super::options::ALL_SENSORS;
use super::values::Show;
use super::{Args, Command, Compare, Convert, ErrorWish, Info, Measure, RenderArgs};
use crate::roles::Roles;

fn clash(roles: &Roles) -> Option<String> {
    roles.clash().map(|clash| clash.message)
}

impl Args {
    /// What cannot be done as it was asked for, and what would help; with the name of the command that it was asked of.
    pub(crate) fn contradiction(&self) -> Option<(Option<&'static str>, String)> {
        let (command, message) = match &self.command {
            Some(Command::Render(render)) => (Some("render"), render.contradiction()),
            Some(Command::Compare(compare)) => (Some("compare"), clash(&compare.roles())),
            Some(Command::Convert(convert)) => (Some("convert"), clash(&convert.roles())),
            Some(Command::Measure(measure)) => (Some("measure"), clash(&measure.roles())),
            Some(Command::Info(info)) => (Some("info"), clash(&info.roles())),
            None => (None, clash(&self.roles())),
        };
        Some((command, message?))
    }

    fn roles(&self) -> Roles {
        let roles = Roles::default().writes("--frame-log", self.frame_log.as_deref());
        roles.reads("the scene", self.scene.as_deref())
    }
}

impl Compare {
    fn roles(&self) -> Roles {
        let output = self.output.as_ref().map(|(path, _)| &**path);
        let roles = Roles::default().prints(true).writes("-o", output);
        roles.reads("the image A", Some(&self.a.0)).reads("the reference B", Some(&self.b.0))
    }
}

impl Info {
    pub(crate) fn roles(&self) -> Roles {
        Roles::default().prints(true).reads("the scene", Some(&self.scene))
    }
}

impl Convert {
    /// What else is written is named so that it is none of the files that the scene reads.
    pub(crate) fn roles(&self) -> Roles {
        Roles::default().writes("the output", Some(&self.output)).reads("the scene", Some(&self.scene))
    }
}

impl Measure {
    pub(crate) fn roles(&self) -> Roles {
        let outputs = foton_measure::sweep::files_in(&self.output, self.reference.is_some());
        let roles = Roles::default().prints(self.json).writes("-o", Some(&self.output));
        let roles = outputs.iter().fold(roles, |roles, file| roles.writes("-o with its", Some(file)));
        roles.reads("--reference", self.reference.as_deref()).reads("the scene", Some(&self.scene))
    }
}

impl RenderArgs {
    /// What cannot be done as it was asked for, and what would help.
    fn contradiction(&self) -> Option<String> {
        self.layers_in_vain()
            .or_else(|| self.look_in_vain())
            .or_else(|| self.maps_in_vain())
            .or_else(|| self.method_in_vain())
            .or_else(|| self.sensors_in_vain())
            .or_else(|| self.show_in_vain())
            .or_else(|| clash(&self.roles()))
    }

    fn maps_in_vain(&self) -> Option<String> {
        let maps = &self.photon_map;
        let option =
            maps.maps.as_ref().map(|_| "--maps").or(maps.save_maps.as_ref().map(|_| "--save-maps"))?;
        (self.integrator.method() != Some(Method::PhotonMap)).then(|| {
            format!("{option}: only --integrator photon-map has photon maps; add that, or leave {option} out")
        })
    }

    fn method_in_vain(&self) -> Option<String> {
        if self.integrator.is_all() {
            let alone = [
                (self.checkpoint.is_some(), "--checkpoint"),
                (self.resume.is_some(), "--resume"),
                (self.every.is_some(), "--every"),
                (!self.layers.is_empty(), "--layers"),
            ];
            let (_, option) = alone.into_iter().find(|(is_there, _)| *is_there)?;
            return Some(format!(
                "{option} is of a render by one method, and --integrator all makes several"
            ));
        }
        if self.reference.is_some() {
            return Some("--reference is what --integrator all compares its images with".to_owned());
        }
        let method = self.integrator.method()?;
        let layer = self.layers.iter().find(|layer| layer.needs_photons() && !method.has_photons())?;
        Some(format!(
            "the layer {} tells of photons, which --integrator {} does not have",
            layer.name(),
            method.name()
        ))
    }

    /// What cannot be shown, or not together.
    fn show_in_vain(&self) -> Option<String> {
        let photons = self.show.contains(&Show::Photons);
        if photons && self.show.len() > 1 {
            return Some("--show photons stands alone: dots are no light to be added to".to_owned());
        }
        match self.integrator.method() {
            None if !self.show.is_empty() => {
                Some("--show is of a render by one method, and --integrator all makes several".to_owned())
            }
            Some(method) if photons && !method.has_photons() => {
                Some(format!("--show photons: --integrator {} has none", method.name()))
            }
            _ => None,
        }
    }

    /// What is of one camera.
    fn sensors_in_vain(&self) -> Option<String> {
        if self.scene_options.sensor.as_deref() != Some(ALL_SENSORS) {
            return None;
        }
        let alone = [
            (self.integrator.is_all(), "--integrator all"),
            (self.checkpoint.is_some(), "--checkpoint"),
            (self.resume.is_some(), "--resume"),
            (self.every.is_some(), "--every"),
            (self.region.is_some(), "--region"),
            (self.strict, "--strict"),
        ];
        let (_, option) = alone.into_iter().find(|(is_there, _)| *is_there)?;
        Some(format!(
            "{option} is of a render by one camera; render through each --sensor by its name instead"
        ))
    }

    fn look_in_vain(&self) -> Option<String> {
        let option = self.exposure.map(|_| "--exposure").or(self.tone_map.map(|_| "--tone-map"))?;
        let path = &self.output.0;
        (self.output.1 == Format::Exr).then(|| {
            format!(
                "{option}: {} is an EXR, which holds linear radiance; write to {} instead, or leave {option} out",
                path.display(),
                path.with_extension("png").display()
            )
        })
    }

    fn layers_in_vain(&self) -> Option<String> {
        let first = self.layers.first()?;
        if self.output.1 == Format::Png {
            let (path, exr) = (&self.output.0, self.output.0.with_extension("exr"));
            return Some(format!(
                "--layers {}: {} is a PNG, and only an EXR holds layers; write to {} instead, or leave --layers out",
                first.name(),
                path.display(),
                exr.display()
            ));
        }
        let twice = self.layers.iter().enumerate().find(|(i, layer)| self.layers[..*i].contains(layer));
        if let Some((_, layer)) = twice {
            return Some(format!("--layers names {} twice; an EXR holds each layer once", layer.name()));
        }
        let needs_error = self.layers.iter().find(|layer| layer.needs_error());
        needs_error.filter(|_| self.error == Some(ErrorWish::Off)).map(|layer| {
            format!("--layers {}: --error off leaves out what that shows; leave out either", layer.name())
        })
    }

    /// The files that are named; those that the scene names are known once it was read.
    pub(crate) fn roles(&self) -> Roles {
        let roles = Roles::default()
            .prints(self.json)
            .writes("-o", Some(&self.output.0))
            .keeps(self.checkpoint.as_deref())
            .writes_numbered(&self.output.0, self.every)
            .resumes(self.resume.as_deref())
            .writes("--save-maps", self.photon_map.save_maps.as_deref())
            .reads("--maps", self.photon_map.maps.as_deref())
            .reads("--reference", self.reference.as_deref())
            .reads("the scene", Some(&self.scene));
        let methods: &[Method] = if self.integrator.is_all() { &Method::ALL } else { &[] };
        methods.iter().fold(roles, |roles, method| roles.writes("-o with its", Some(&self.image_of(*method))))
    }
}
