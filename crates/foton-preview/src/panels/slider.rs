//! A slider beside a field. What is dragged is committed when it is let go; until then the caller may follow it, or not.

use std::ops::RangeInclusive;

use egui::{Response, Ui};

use super::number::{Change, Digits, Number, Sent};

/// A slider and a field for one value.
pub(super) struct Slider<'a> {
    name: &'a str,
    salt: u64,
    range: RangeInclusive<f64>,
    is_logarithmic: bool,
    /// At most; it is shorter where there is less room.
    width: f32,
}

#[derive(Clone, Copy, Debug, Default)]
struct Memo {
    dragged: Option<f64>,
    /// The frame in which it was last shown.
    frame: u64,
    sent: Option<Sent>,
}

impl<'a> Slider<'a> {
    pub(super) const fn new(name: &'a str, range: RangeInclusive<f64>) -> Self {
        Self { name, salt: 0, range, is_logarithmic: false, width: f32::INFINITY }
    }

    pub(super) const fn salt(self, salt: u64) -> Self {
        Self { salt, ..self }
    }

    pub(super) const fn logarithmic(self, is_logarithmic: bool) -> Self {
        Self { is_logarithmic, ..self }
    }

    pub(super) const fn width(self, width: f32) -> Self {
        Self { width, ..self }
    }

    /// The slider, then the field; both, and what a person did to one of them.
    pub(super) fn show(self, ui: &mut Ui, number: Number<'_>, value: f64) -> ([Response; 2], Option<Change>) {
        let room = ui.available_width() - number.width - ui.spacing().item_spacing.x;
        ui.spacing_mut().slider_width = self.width.min(room).max(20.0);
        let (slider, shown, moved) = self.slide(ui, value, number.digits == Digits::Whole);
        let (field, typed) = number.show(ui, shown);
        ([slider, field], typed.or(moved))
    }

    /// The slider alone: what it shows, and what a person did to it.
    fn slide(&self, ui: &mut Ui, value: f64, is_whole: bool) -> (Response, f64, Option<Change>) {
        let id = ui.make_persistent_id(("slider", self.name, self.salt));
        let mut memo: Memo = ui.data(|d| d.get_temp(id)).unwrap_or_default();
        let (now, frame) = (ui.input(|i| i.time), ui.ctx().cumulative_frame_nr());
        if frame > memo.frame + 1 {
            // It was away meanwhile, with what was under way.
            memo.dragged = None;
        }
        memo.frame = frame;
        let waiting = memo.sent.and_then(|sent| sent.shown(value, now));
        let before = memo.dragged.or(waiting).unwrap_or(value);
        let mut shown = before;
        // It leaves a value alone until someone moves it: one that clamps what it shows would steer by itself.
        let track = egui::Slider::new(&mut shown, self.range.clone()).logarithmic(self.is_logarithmic);
        let response = ui.add(track.show_value(false).smart_aim(false).clamping(egui::SliderClamping::Edits));
        let whole = |v: f64| if is_whole { v.round() } else { v };
        let mut change = None;
        if response.dragged() {
            if response.changed() {
                change = Some(Change::Moving(whole(shown)));
            }
            memo.dragged = Some(shown);
        } else if let Some(dragged) = memo.dragged.take() {
            let end = if response.changed() { shown } else { dragged };
            change = Some(Change::Done(whole(end)));
        } else if response.changed() {
            change = Some(Change::Done(whole(shown)));
        }
        if let Some(Change::Done(done)) = change {
            memo.sent = Some(Sent::new(value, done, now));
        } else if waiting.is_none() {
            memo.sent = None;
        }
        let (name, is_enabled) = (self.name.to_owned(), ui.is_enabled());
        response.widget_info(|| egui::WidgetInfo::slider(is_enabled, shown, name.clone()));
        ui.data_mut(|d| d.insert_temp(id, memo));
        (response, whole(shown), change)
    }
}
