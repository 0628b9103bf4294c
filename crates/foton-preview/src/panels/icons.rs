//! The icons of the toolbar, drawn as lines and shapes, so that they are sharp at any scale and need no font.

use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Icon {
    Play,
    Pause,
    Step,
    Restart,
    Snapshot,
    View,
    LightPaths,
    Exposure,
    ToneMap,
    Pin,
    Photons,
}

/// The side of an icon in points.
pub(super) const SIDE: f32 = 16.0;

/// Draws an icon into the middle of a rectangle.
pub(super) fn draw(painter: &Painter, rect: Rect, icon: Icon, colour: Color32) {
    let place = Place { rect: Rect::from_center_size(rect.center(), Vec2::splat(SIDE)), painter, colour };
    match icon {
        Icon::Play | Icon::Pause | Icon::Step | Icon::Restart | Icon::Snapshot | Icon::Pin => {
            run(&place, icon);
        }
        _ => look(&place, icon),
    }
}

/// Icons of what is done.
fn run(place: &Place<'_>, icon: Icon) {
    match icon {
        Icon::Play => place.fill(&[[0.25, 0.15], [0.85, 0.5], [0.25, 0.85]]),
        Icon::Pause => {
            place.bar([0.22, 0.15], [0.42, 0.85]);
            place.bar([0.58, 0.15], [0.78, 0.85]);
        }
        Icon::Step => {
            place.fill(&[[0.18, 0.15], [0.66, 0.5], [0.18, 0.85]]);
            place.bar([0.70, 0.15], [0.84, 0.85]);
        }
        Icon::Restart => {
            place.arc([0.5, 0.52], 0.34, 0.45, 5.6);
            place.fill(&[[0.62, 0.02], [0.98, 0.2], [0.64, 0.42]]);
        }
        Icon::Snapshot => {
            let top = [[0.08, 0.28], [0.3, 0.28], [0.38, 0.14], [0.62, 0.14], [0.7, 0.28], [0.92, 0.28]];
            place.outline(&[&top[..], &[[0.92, 0.85], [0.08, 0.85]]].concat());
            place.circle([0.5, 0.56], 0.17);
        }
        _ => {
            place.fill(&[[0.34, 0.08], [0.66, 0.08], [0.62, 0.4], [0.78, 0.58], [0.22, 0.58], [0.38, 0.4]]);
            place.line(&[[0.5, 0.58], [0.5, 0.95]]);
        }
    }
}

/// Icons of what is looked at.
fn look(place: &Place<'_>, icon: Icon) {
    match icon {
        Icon::View => {
            let top = [[0.04, 0.5], [0.25, 0.28], [0.5, 0.2], [0.75, 0.28]];
            place.outline(&[&top[..], &top.map(|[x, y]| [1.0 - x, 1.0 - y])].concat());
            place.dot([0.5, 0.5], 0.14);
        }
        Icon::LightPaths => {
            place.dot([0.14, 0.16], 0.11);
            place.line(&[[0.14, 0.16], [0.45, 0.84], [0.66, 0.36], [0.92, 0.84]]);
        }
        Icon::Exposure => {
            place.dot([0.5, 0.5], 0.2);
            for i in 0..8 {
                let (sin, cos) = (std::f32::consts::FRAC_PI_4 * i as f32).sin_cos();
                place.line(&[0.31, 0.46].map(|r| [0.5 + r * cos, 0.5 + r * sin]));
            }
        }
        Icon::ToneMap => {
            place.line(&[[0.1, 0.08], [0.1, 0.9], [0.94, 0.9]]);
            place.line(&[[0.1, 0.9], [0.3, 0.5], [0.5, 0.3], [0.7, 0.21], [0.94, 0.17]]);
        }
        _ => {
            let dots = [[0.2, 0.3], [0.48, 0.18], [0.8, 0.34], [0.34, 0.58], [0.64, 0.56], [0.18, 0.84]];
            [&dots[..], &[[0.5, 0.88], [0.84, 0.78]]].concat().into_iter().for_each(|at| place.dot(at, 0.09));
        }
    }
}

/// Where an icon is drawn, from shares of its square.
struct Place<'a> {
    painter: &'a Painter,
    rect: Rect,
    colour: Color32,
}

impl Place<'_> {
    fn at(&self, [x, y]: [f32; 2]) -> Pos2 {
        pos2(self.rect.left() + x * self.rect.width(), self.rect.top() + y * self.rect.height())
    }

    const fn stroke(&self) -> Stroke {
        Stroke { width: 1.4, color: self.colour }
    }

    fn points(&self, shares: &[[f32; 2]]) -> Vec<Pos2> {
        shares.iter().map(|share| self.at(*share)).collect()
    }

    fn fill(&self, shares: &[[f32; 2]]) {
        self.painter.add(Shape::convex_polygon(self.points(shares), self.colour, Stroke::NONE));
    }

    fn outline(&self, shares: &[[f32; 2]]) {
        self.painter.add(Shape::closed_line(self.points(shares), self.stroke()));
    }

    fn line(&self, shares: &[[f32; 2]]) {
        self.painter.add(Shape::line(self.points(shares), self.stroke()));
    }

    fn bar(&self, min: [f32; 2], max: [f32; 2]) {
        self.painter.rect_filled(Rect::from_min_max(self.at(min), self.at(max)), 1.0, self.colour);
    }

    fn dot(&self, centre: [f32; 2], radius: f32) {
        self.painter.circle_filled(self.at(centre), radius * self.rect.width(), self.colour);
    }

    fn circle(&self, centre: [f32; 2], radius: f32) {
        self.painter.circle_stroke(self.at(centre), radius * self.rect.width(), self.stroke());
    }

    /// Part of a circle, between angles in radians clockwise from the right.
    fn arc(&self, centre: [f32; 2], radius: f32, from: f32, to: f32) {
        const STEPS: u32 = 24;
        let point = |i: u32| {
            let (sin, cos) = (from + (to - from) * i as f32 / STEPS as f32).sin_cos();
            [centre[0] + radius * cos, centre[1] + radius * sin]
        };
        self.line(&(0..=STEPS).map(point).collect::<Vec<_>>());
    }
}
