//! Photons of the last pass as a camera sees them.

use foton_integrator::{PathClass, Render, StoredPhoton};
use foton_math::Ray;
use foton_math::glam::Vec2;
use foton_scene::description::Crop;
use rayon::prelude::*;

/// Photons drawn at most.
const DOTS: usize = 20_000;

/// A photon counts as seen if nothing is nearer than this share of its distance.
const SEEN: f32 = 1e-3;

/// A photon of the last pass, seen from the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dot {
    /// Where, in pixels of the image.
    pub film: [f32; 2],
    /// How it came there.
    pub class: PathClass,
}

/// The photons of the last pass that the camera sees directly.
pub(crate) fn dots(render: &Render) -> Vec<Dot> {
    render.stored_photons(DOTS).par_iter().filter_map(|photon| dot(render, photon, true)).collect()
}

/// A photon as the camera sees it, or would if nothing stood before it.
pub(crate) fn dot(render: &Render, photon: &StoredPhoton, only_seen: bool) -> Option<Dot> {
    let scene = render.scene();
    let sensor = &scene.sensors()[render.settings().sensor];
    let point = scene.normalisation().point(photon.position);
    let (film, _) = sensor.project_on_whole(point)?;
    pixel_in(&sensor.window(), film)?;
    if only_seen {
        let eye = sensor.eye_of(point);
        let way = point - eye;
        let ray = Ray { t_max: way.length() * (1.0 - SEEN), ..Ray::new(eye, way.normalize()) };
        if scene.occluded(ray) {
            return None;
        }
    }
    Some(Dot { film: film.to_array(), class: photon.class })
}

/// The column and row in what is rendered of a position in the whole image; `None` outside.
pub(crate) fn pixel_in(window: &Crop, film: Vec2) -> Option<[u32; 2]> {
    let within = |at: f32, first: u32, count: u32| {
        let at = at - first as f32;
        (at >= 0.0 && at < count as f32).then_some(at as u32)
    };
    Some([within(film.x, window.x, window.width)?, within(film.y, window.y, window.height)?])
}
