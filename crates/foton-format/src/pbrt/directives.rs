//! The directives of a file, one after the other; what those of a kind mean is in the file of their kind.

use std::rc::Rc;

use foton_input::quoted;

use super::parameters::Parameters;
use super::reader::{Camera, Reader};
use super::state::Open;
use super::statements::said;
use super::tokens::{Fault, Token, Tokens};
use crate::diagnostic::Place;
use crate::mitsuba::read::properties::Located;
use crate::spelling::did_you_mean;

/// All directives that are read.
pub(crate) const DIRECTIVES: [&str; 46] = [
    "Accelerator",
    "ActiveTransform",
    "AreaLightSource",
    "Attribute",
    "AttributeBegin",
    "AttributeEnd",
    "Camera",
    "ColorSpace",
    "ConcatTransform",
    "CoordSysTransform",
    "CoordinateSystem",
    "Film",
    "Identity",
    "Import",
    "Include",
    "Integrator",
    "LightSource",
    "LookAt",
    "MakeNamedMaterial",
    "MakeNamedMedium",
    "Material",
    "MediumInterface",
    "NamedMaterial",
    "ObjectBegin",
    "ObjectEnd",
    "ObjectInstance",
    "Option",
    "PixelFilter",
    "Renderer",
    "ReverseOrientation",
    "Rotate",
    "Sampler",
    "Scale",
    "Shape",
    "SurfaceIntegrator",
    "Texture",
    "Transform",
    "TransformBegin",
    "TransformEnd",
    "TransformTimes",
    "Translate",
    "Volume",
    "VolumeIntegrator",
    "WorldBegin",
    "WorldEnd",
    "MediumInstance",
];

/// Whether a text begins as a file of pbrt does: others must not be quoted.
pub(crate) fn begins_as_scene(text: &str) -> bool {
    match Tokens::new(text, 0).next() {
        None => true,
        Some(Ok((Token::Word(word), _))) => DIRECTIVES.contains(&word),
        _ => false,
    }
}

impl Reader<'_> {
    /// Reads a text to its end, all that is wrong in it included.
    pub(crate) fn text(&mut self, text: &str, lines_before: u32) {
        let mut tokens = Tokens::new(text, lines_before).until(self.files.cancel());
        let is_main = self.including.is_empty();
        while let Some(token) = tokens.next() {
            if self.files.cancel().is_requested() || self.report.is_full() {
                return;
            }
            if is_main {
                self.files.begin_part((tokens.share() * 1000.0) as usize, 1001);
            }
            let read = match token {
                Ok((Token::Word(word), place)) => self.directive(word, place, &mut tokens),
                Ok((token, place)) => {
                    Err((place, format!("{} stands where a directive is needed", said(&token))))
                }
                Err(fault) => Err(fault),
            };
            if let Err((place, message)) = read {
                self.report.error(place, message);
                tokens.skip_statement();
            }
        }
    }

    fn directive(&mut self, word: &str, place: Place, tokens: &mut Tokens<'_>) -> Result<(), Fault> {
        match word {
            "Identity" | "Translate" | "Scale" | "Rotate" | "LookAt" | "Transform" | "ConcatTransform"
            | "CoordinateSystem" | "CoordSysTransform" | "ActiveTransform" | "TransformTimes"
            | "ReverseOrientation" => self.transform(word, place, tokens),
            "AttributeBegin" => {
                let state = Box::new(self.state.clone());
                self.open(Open::Attribute(state), place);
                Ok(())
            }
            "TransformBegin" => {
                self.open(Open::Transform(self.state.transforms, self.state.active), place);
                Ok(())
            }
            "AttributeEnd" | "TransformEnd" | "ObjectEnd" => {
                self.close(word, place);
                Ok(())
            }
            "ObjectBegin" => self.object_begin(place, tokens),
            "ObjectInstance" => self.object_instance(tokens),
            "WorldBegin" => {
                self.state.transforms = super::state::Transforms::IDENTITY;
                self.state.active = [true; 2];
                self.coordinate_systems.insert("world".to_owned(), super::state::Transforms::IDENTITY);
                Ok(())
            }
            "WorldEnd" => Ok(()),
            "Include" | "Import" => self.include(word, tokens),
            "Shape" => {
                let p = self.statement("shape", tokens)?;
                self.shape(&p);
                Ok(())
            }
            "LightSource" => {
                let p = self.statement("light", tokens)?;
                self.light_source(&p);
                Ok(())
            }
            "AreaLightSource" => {
                let p = self.statement("light", tokens)?;
                self.state.area_light = Some(Rc::new(p));
                Ok(())
            }
            "Material" | "MakeNamedMaterial" | "NamedMaterial" => self.material_directive(word, tokens),
            "Texture" => {
                let name = tokens.text("a name of a texture")?;
                let kind = tokens.text("\"float\" or \"spectrum\"")?;
                let p = self.statement("texture", tokens)?;
                self.define_texture(name, &kind, &p);
                Ok(())
            }
            "MakeNamedMedium" | "MediumInterface" => self.medium_directive(word, tokens),
            _ => self.option(word, place, tokens),
        }
    }

    /// Directives that are about all of the scene.
    fn option(&mut self, word: &str, place: Place, tokens: &mut Tokens<'_>) -> Result<(), Fault> {
        match word {
            "Camera" => {
                let parameters = self.statement("camera", tokens)?;
                let transforms = self.state.transforms;
                self.coordinate_systems.insert("camera".to_owned(), transforms.inverse());
                self.camera = Some(Camera { parameters, transforms });
            }
            "Film" => self.film = Some(self.statement("film", tokens)?),
            "PixelFilter" => {
                let p = self.statement("filter", tokens)?;
                self.pixel_filter(&p);
            }
            "Integrator" | "SurfaceIntegrator" => {
                let p = self.statement("integrator", tokens)?;
                self.integrator(&p);
            }
            "ColorSpace" => {
                let name = tokens.text("a name of a colour space")?;
                self.colour_space(&name);
            }
            "Option" => {
                let list = tokens.parameters(&mut self.report);
                let p = Parameters::new("Option".to_owned(), place, list);
                p.ignore(OPTIONS);
                p.finish(&mut self.report);
            }
            "Attribute" => self.attribute(tokens)?,
            // These do not change what an image converges to.
            "Sampler" | "Accelerator" | "Renderer" | "VolumeIntegrator" => {
                tokens.text("a name of a plugin")?;
                tokens.parameters(&mut self.report);
            }
            "Volume" => {
                tokens.text("a name of a plugin")?;
                tokens.parameters(&mut self.report);
                self.report.warn_once(place, "volumes are not rendered: the medium is left out".to_owned());
            }
            unknown => {
                let hint = did_you_mean(unknown, DIRECTIVES);
                return Err((place, format!("unknown directive {}{hint}", quoted(unknown))));
            }
        }
        Ok(())
    }

    /// A plugin with its parameters, and those that a directive `Attribute` has for its kind.
    pub(crate) fn statement(&mut self, kind: &str, tokens: &mut Tokens<'_>) -> Result<Parameters, Fault> {
        let plugin = tokens.text("a name of a plugin")?;
        let list = tokens.parameters(&mut self.report);
        let mut p = Parameters::new(plugin.value, plugin.place, list);
        self.finish_list(kind, &mut p);
        Ok(p)
    }

    /// Adds defaults to parameters, and looks up the textures that they name.
    pub(crate) fn finish_list(&mut self, kind: &str, p: &mut Parameters) {
        let defaults = Rc::clone(&self.state.defaults);
        for (_, default) in defaults.iter().filter(|(of, _)| of == kind) {
            if !p.has(&default.name) {
                p.list.push(default.clone());
            }
        }
        self.resolve_textures(p);
    }

    /// `Attribute`: defaults for parameters of what comes.
    fn attribute(&mut self, tokens: &mut Tokens<'_>) -> Result<(), Fault> {
        const KINDS: [&str; 5] = ["shape", "light", "material", "medium", "texture"];
        /// Each copy of the state has them.
        const MOST: usize = 100;
        let kind = tokens.text("what parameters are for")?;
        let list = tokens.parameters(&mut self.report);
        if !KINDS.contains(&kind.value.as_str()) {
            let hint = did_you_mean(&kind.value, KINDS);
            return Err((
                kind.place,
                format!("{} has no parameters: {}{hint}", quoted(&kind.value), KINDS.join(", ")),
            ));
        }
        let defaults = Rc::make_mut(&mut self.state.defaults);
        for parameter in list {
            parameter.used.set(true);
            defaults.retain(|(of, known)| *of != kind.value || known.name != parameter.name);
            if defaults.len() >= MOST {
                return Err((parameter.place, format!("there are more than {MOST} defaults of parameters")));
            }
            defaults.push((kind.value.clone(), parameter));
        }
        Ok(())
    }

    fn colour_space(&mut self, name: &Located<String>) {
        match super::colour_space::ColourSpace::of(&name.value) {
            Some(space) => self.state.colour_space = space,
            None => {
                let hint = did_you_mean(&name.value, super::colour_space::names());
                self.report.error(name.place, format!("unknown colour space {}{hint}", quoted(&name.value)));
            }
        }
    }
}

/// Options of version 4, which do not change what an image converges to.
const OPTIONS: &[&str] = &[
    "disablepixeljitter",
    "disabletexturefiltering",
    "disablewavelengthjitter",
    "displacementedgescale",
    "forcediffuse",
    "msereferenceimage",
    "msereferenceout",
    "pixelstats",
    "rendercoordsys",
    "seed",
    "wavefront",
];
