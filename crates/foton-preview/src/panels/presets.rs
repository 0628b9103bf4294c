//! Materials to choose from, each with a picture that foton has rendered (`cargo run --release -p foton-tests --example presets`).

use egui::{Sense, Ui, Vec2};
use foton_edit::{Make, Preset, presets};

use super::actions;
use crate::state::State;

/// Side of a picture in points.
const SIDE: f32 = 56.0;

/// Pictures in a row.
const COLUMNS: usize = 4;

/// The picture of a preset; nothing for one that has none.
fn png(name: &str) -> Option<&'static [u8]> {
    macro_rules! picture {
        ($name:literal) => {
            ($name, include_bytes!(concat!("../../presets/", $name, ".png")).as_slice())
        };
    }
    const ALL: [(&str, &[u8]); 12] = [
        picture!("water"),
        picture!("ice"),
        picture!("crown glass"),
        picture!("frosted glass"),
        picture!("sapphire"),
        picture!("diamond"),
        picture!("gold"),
        picture!("silver"),
        picture!("copper"),
        picture!("brass"),
        picture!("plastic"),
        picture!("white wax"),
    ];
    ALL.into_iter().find(|(known, _)| *known == name).map(|(_, png)| png)
}

/// The picture of a preset as a texture, made when it is first shown.
pub(super) fn texture_of(ctx: &egui::Context, name: &'static str) -> Option<egui::TextureHandle> {
    let id = egui::Id::unique(("preset", name));
    if let Some(known) = ctx.data(|d| d.get_temp::<egui::TextureHandle>(id)) {
        return Some(known);
    }
    let picture = foton_film::decode_png(png(name)?, name.as_ref(), None).ok()?;
    let pixels = picture.pixels.iter().map(|c| egui::Rgba::from_rgb(c.r, c.g, c.b).into()).collect();
    let image = egui::ColorImage::new([picture.width as usize, picture.height as usize], pixels);
    let texture = ctx.load_texture(name, image, egui::TextureOptions::LINEAR);
    ctx.data_mut(|d| d.insert_temp(id, texture.clone()));
    Some(texture)
}

/// A button that opens the presets.
pub(super) fn menu(ui: &mut Ui, state: &mut State) {
    let menu = ui.menu_button("Presets", |ui| {
        for (row, chunk) in presets().chunks(COLUMNS).enumerate() {
            ui.horizontal(|ui| {
                for (column, preset) in chunk.iter().enumerate() {
                    let tile = tile(ui, preset);
                    state.place(format!("preset {}", preset.name), &tile);
                    if tile.clicked() {
                        actions::remake(state, Make::Preset(row * COLUMNS + column), preset.name);
                        ui.close();
                    }
                }
            });
        }
    });
    state.place("presets", &menu.response);
    menu.response.on_hover_text("Water, glass, stones, metals, plastic and wax");
}

fn tile(ui: &mut Ui, preset: &Preset) -> egui::Response {
    let line = ui.text_style_height(&egui::TextStyle::Small);
    let (rect, response) = ui.allocate_exact_size(Vec2::new(SIDE + 14.0, SIDE + line + 8.0), Sense::click());
    let enabled = ui.is_enabled();
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, enabled, preset.name));
    let visuals = ui.style().interact(&response);
    let colour = visuals.text_color();
    if response.hovered() || response.has_focus() {
        ui.painter().rect(rect, 3.0, visuals.weak_bg_fill, visuals.bg_stroke, egui::StrokeKind::Inside);
    }
    let picture = egui::Rect::from_center_size(
        egui::pos2(rect.center().x, rect.top() + 3.0 + 0.5 * SIDE),
        Vec2::splat(SIDE),
    );
    if let Some(texture) = texture_of(ui.ctx(), preset.name) {
        let whole = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
        ui.painter().image(texture.id(), picture, whole, egui::Color32::WHITE);
    }
    let at = egui::pos2(rect.center().x, rect.bottom() - 3.0);
    let font = egui::TextStyle::Small.resolve(ui.style());
    ui.painter().text(at, egui::Align2::CENTER_BOTTOM, preset.name, font, colour);
    response.on_hover_text(preset.help)
}
