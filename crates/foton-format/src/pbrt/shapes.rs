//! The directive `Shape`: what stands for a surface, and what it emits.

use std::f64::consts::TAU;
use std::rc::Rc;

use foton_input::quoted;
use foton_math::Rgb;
use foton_math::glam::DVec3;
use foton_scene::description::Wrap;

use super::parameters::Parameters;
use super::reader::Reader;
use super::round::{Profile, Round};
use super::texture::{ImageFile, Picture};
use super::waiting::{Body, Emission, Shape};
use crate::image::Curve;
use crate::spelling::did_you_mean;

/// Shapes of both versions.
const SHAPES: [&str; 16] = [
    "trianglemesh",
    "plymesh",
    "bilinearmesh",
    "loopsubdiv",
    "sphere",
    "disk",
    "cylinder",
    "cone",
    "paraboloid",
    "hyperboloid",
    "curve",
    "heightfield",
    "heightfield2",
    "nurbs",
    "cylinder",
    "bilinearPatch",
];

impl Reader<'_> {
    /// Reads a shape.
    pub(crate) fn shape(&mut self, p: &Parameters) {
        let opacity = self.opacity(p);
        let emission = self.emission();
        let body = self.body(p);
        p.finish(&mut self.report);
        self.say_media();
        let Some(body) = body else { return };
        let shape = Shape {
            body,
            transforms: self.state.transforms,
            reverses: self.state.reverses,
            material: Rc::clone(&self.state.material),
            opacity,
            emission,
            place: p.place,
        };
        match &mut self.object {
            Some(object) => {
                if shape.emission.is_some() {
                    let message =
                        "shapes of objects do not shine, as in pbrt: their area light is left out".to_owned();
                    self.report.warn_once(shape.place, message);
                }
                object.shapes.push(Shape { emission: None, ..shape });
            }
            None => {
                let name = format!("{}-{}", p.plugin, self.description.shapes.len() + 1);
                self.place_shape(&shape, None, name);
            }
        }
    }

    /// Share of light that meets a surface at all, where that is not all of it.
    fn opacity(&mut self, p: &Parameters) -> Option<Rc<Picture>> {
        let alpha = self.number_picture(p, "alpha");
        if p.has("shadowalpha") {
            p.ignore(&["shadowalpha"]);
            let place = p.place_of("shadowalpha");
            self.report.warn_once(
                place,
                "holes that shadows alone have are left out: \"shadowalpha\" has no effect".to_owned(),
            );
        }
        let alpha = alpha?;
        match alpha.constant() {
            Some(Rgb::WHITE) => None,
            // Coverage is all or nothing where it is one number.
            Some(share) => Some(Rc::new(Picture::Constant(share.map(|c| c.clamp(0.0, 1.0))))),
            None => Some(alpha),
        }
    }

    fn body(&mut self, p: &Parameters) -> Option<Body> {
        match p.plugin.as_str() {
            "trianglemesh" => self.triangle_mesh(p).map(Body::Mesh),
            "plymesh" => self.ply_mesh(p).map(Body::Mesh),
            "bilinearmesh" => self.bilinear_mesh(p).map(Body::Mesh),
            "loopsubdiv" => self.loop_subdivision(p).map(Body::Mesh),
            "heightfield" | "heightfield2" => self.height_field(p).map(Body::Mesh),
            "sphere" | "disk" | "cylinder" | "cone" | "paraboloid" | "hyperboloid" => {
                self.round(p).map(Body::Round)
            }
            "curve" | "nurbs" => {
                p.ignore_rest();
                let message = format!("the shape {} is not rendered", quoted(&p.plugin));
                if self.files.allows_missing() {
                    self.report.warn_once(p.place, format!("{message}: it is left out"));
                } else {
                    self.report.error(p.place, message);
                    self.report.help("--allow-missing opens the scene without it");
                }
                None
            }
            other => {
                p.ignore_rest();
                let hint = did_you_mean(other, SHAPES);
                self.report.error(p.place, format!("unknown shape {}{hint}", quoted(other)));
                None
            }
        }
    }

    /// A surface of revolution.
    fn round(&mut self, p: &Parameters) -> Option<Round> {
        let report = &mut self.report;
        let phi_max = p.number_or("phimax", 360.0, report);
        let radius = if p.plugin == "hyperboloid" { 1.0 } else { p.above_zero("radius", 1.0, report) };
        let profile = match p.plugin.as_str() {
            "sphere" | "cylinder" | "paraboloid" => {
                let defaults = match p.plugin.as_str() {
                    "sphere" => [-radius, radius],
                    "cylinder" => [-1.0, 1.0],
                    _ => [0.0, 1.0],
                };
                let ends =
                    [p.number_or("zmin", defaults[0], report), p.number_or("zmax", defaults[1], report)];
                let [from, to] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                if from >= to
                    || p.plugin == "sphere" && (from >= radius || to <= -radius)
                    || p.plugin == "paraboloid" && from < 0.0
                {
                    report.error(
                        p.place_of("zmin"),
                        "between \"zmin\" and \"zmax\" there is nothing of this shape",
                    );
                    return None;
                }
                match p.plugin.as_str() {
                    "sphere" => Profile::Sphere { radius, from: from.max(-radius), to: to.min(radius) },
                    "cylinder" => Profile::Cylinder { radius, from, to },
                    _ => Profile::Paraboloid { radius, from, to },
                }
            }
            "disk" => {
                let inner = p.number_or("innerradius", 0.0, report);
                if inner >= radius || inner < 0.0 {
                    report.error(
                        p.place_of("innerradius"),
                        "\"innerradius\" must lie between 0 and \"radius\"",
                    );
                    return None;
                }
                Profile::Disc { height: p.number_or("height", 0.0, report), radius, inner }
            }
            "cone" => Profile::Cone { radius, height: p.above_zero("height", 1.0, report) },
            _ => {
                let from = p.point("p1", report).map_or(DVec3::ZERO, |p| p.value);
                let to = p.point("p2", report).map_or(DVec3::ONE, |p| p.value);
                Profile::Hyperboloid { from, to }
            }
        };
        if !(phi_max > 0.0 && phi_max <= 360.0) {
            report.error(p.place_of("phimax"), "\"phimax\" must be above 0 and at most 360 degrees");
            return None;
        }
        Some(Round { profile, phi_max: phi_max / 360.0 * TAU })
    }

    /// What the area light that is set lets shapes emit.
    fn emission(&mut self) -> Option<Emission> {
        let p = Rc::clone(self.state.area_light.as_ref()?);
        if !matches!(p.plugin.as_str(), "diffuse" | "area") {
            let hint = did_you_mean(&p.plugin, ["diffuse"]);
            // Once for all shapes that have it.
            self.report.error(p.place, format!("unknown area light {}{hint}", quoted(&p.plugin)));
            p.ignore_rest();
            self.state.area_light = None;
            return None;
        }
        p.ignore(&["nsamples", "samples"]);
        let radiance = self.light(&p, "L") * self.light_scale(&p);
        let two_sided = p.boolean("twosided", &mut self.report).unwrap_or(false);
        let power = p.number("power", &mut self.report).map(|power| power.value).filter(|power| *power > 0.0);
        let picture = p.text("filename", &mut self.report).map(|filename| ImageFile {
            filename,
            curve: Curve::Srgb,
            scale: 1.0,
            invert: false,
            wrap: Wrap::Clamp,
            bilinear: true,
            to_st: foton_math::glam::DAffine2::IDENTITY,
        });
        p.finish(&mut self.report);
        Some(Emission { radiance, picture, power, two_sided })
    }
}
