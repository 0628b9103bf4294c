//! Where a gizmo is, and what can be done to the thing that it is of.

use foton_math::glam::{DAffine3, DVec2, DVec3};
use foton_scene::description::{EmitterKind, Filter, FovAxis, Geometry, SceneDescription, SensorDescription};

use crate::geometry;
use crate::pick::anchor;
use crate::target::Target;
use crate::view::View;

/// Handles of the selected thing as a camera sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gizmo {
    pub(super) view: View,
    /// Where its handles meet, in the world.
    pub(super) at: DVec3,
    /// The same on the film.
    pub(super) film: DVec2,
    /// What the thing turns about and scales from.
    pub(super) centre: DVec3,
    /// Axes of the thing itself, of unit length.
    pub(super) own: [DVec3; 3],
    pub(super) can_move: bool,
    pub(super) can_turn: bool,
    /// Along which of its own axes it can be scaled alone.
    pub(super) stretches: [bool; 3],
    pub(super) can_scale: bool,
}

impl Gizmo {
    /// The gizmo of a thing in a scene. Where its middle is not in the image, its handles are at `picked`, where a person clicked it;
    /// `None` if that is not in the image either.
    #[must_use]
    pub fn new(
        description: &SceneDescription,
        target: Target,
        sensor: usize,
        picked: Option<DVec3>,
    ) -> Option<Self> {
        let view = View::new(description.sensors.get(sensor)?);
        let ahead = view.origin + view.forward;
        let gizmo = Self {
            view,
            at: ahead,
            film: view.film * 0.5,
            centre: ahead,
            own: DVec3::AXES,
            can_move: false,
            can_turn: false,
            stretches: [false; 3],
            can_scale: false,
        };
        let gizmo = match target {
            Target::Shape(index) => gizmo.of_shape(description, index)?,
            Target::Emitter(index) => match &description.emitters.get(index)?.kind {
                EmitterKind::Point { .. } => Self { can_move: true, ..gizmo },
                EmitterKind::Spot { .. }
                | EmitterKind::Projector { .. }
                | EmitterKind::Goniometric { .. } => Self { can_move: true, can_turn: true, ..gizmo },
                // Light from infinity turns about the middle of the image.
                EmitterKind::Directional { .. } | EmitterKind::Environment { .. } => {
                    return Some(Self { can_turn: true, ..gizmo });
                }
                EmitterKind::Constant { .. } => return None,
            },
            Target::Sensor(_) => return None,
        };
        let centre = anchor(description, target)?;
        let places = [Some(centre), picked].into_iter().flatten();
        let (at, film) = places
            .filter_map(|at| Some((at, view.project(at)?)))
            .find(|(_, film)| film.cmpge(DVec2::ZERO).all() && film.cmple(view.film).all())?;
        Some(Self { at, film, centre, ..gizmo })
    }

    /// The gizmo of a mesh in the middle of an image of so many pixels, seen level from a little to the side: what panels are tried
    /// with that know no scene.
    #[must_use]
    pub fn sample(width: u32, height: u32) -> Self {
        let turn = DAffine3::from_rotation_y(0.6) * DAffine3::from_rotation_x(0.5);
        let origin = turn.transform_point3(DVec3::new(0.0, 0.0, -8.0));
        let view = View::new(&SensorDescription {
            name: String::new(),
            to_world: DAffine3::from_translation(origin) * turn,
            fov_degrees: 40.0,
            fov_axis: FovAxis::X,
            width,
            height,
            filter: Filter::Box { radius: 0.5 },
            ..SensorDescription::default()
        });
        Self {
            view,
            at: DVec3::ZERO,
            film: view.film * 0.5,
            centre: DVec3::ZERO,
            own: DVec3::AXES,
            can_move: true,
            can_turn: true,
            stretches: [true; 3],
            can_scale: true,
        }
    }

    fn of_shape(self, description: &SceneDescription, index: usize) -> Option<Self> {
        let shape = description.shapes.get(index)?;
        let m = shape.to_world.matrix3;
        let own = [m.x_axis, m.y_axis, m.z_axis];
        let stretches = match &shape.geometry {
            Geometry::Mesh(_) => {
                let extents = geometry::extents(shape);
                extents.map(|extent| extent > 1e-9 * geometry::size(shape))
            }
            // Stretched they would no longer be what they are.
            Geometry::Sphere { .. } | Geometry::Disc | Geometry::Cylinder { .. } => [false; 3],
        };
        Some(Self {
            own: [0, 1, 2].map(|i| own[i].normalize_or(DVec3::AXES[i])),
            can_move: true,
            can_turn: true,
            can_scale: geometry::size(shape) > 0.0,
            stretches,
            ..self
        })
    }

    /// Unit vector from the camera to where the handles meet.
    pub(super) fn sight(&self) -> DVec3 {
        self.view.sight(self.at)
    }

    /// World units that a pixel covers there.
    pub(super) fn pixel(&self) -> f64 {
        self.view.pixel_at(self.view.depth(self.at))
    }

    /// Where the handles meet on the film, in pixels.
    #[must_use]
    pub fn film(&self) -> [f64; 2] {
        self.film.to_array()
    }
}
