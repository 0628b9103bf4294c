//! A field for a number: the only one in the window. While it is edited it holds a text of its own; Enter or leaving the field
//! commits it once, Esc gives it up, and nothing is sent on the way, whatever values arrive meanwhile.
//!
//! It can also be dragged sideways, and stepped by the arrow keys while it is edited.

mod reading;
mod sent;

use std::ops::RangeInclusive;

use egui::{Align2, Id, Key, Modifiers, Rect, Response, Sense, Ui, Vec2, accesskit};

pub(super) use reading::Digits;
pub(super) use sent::Sent;

/// How long it is said what was wrong with a text that is gone, in seconds.
const SAID: f64 = 4.0;

/// What a person has done to a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Change {
    /// It is being dragged; more follows.
    Moving(f64),
    /// It was typed, stepped or let go.
    Done(f64),
}

impl Change {
    /// The value that is meant to stay.
    pub(super) const fn done(self) -> Option<f64> {
        match self {
            Self::Done(value) => Some(value),
            Self::Moving(_) => None,
        }
    }
}

/// A field, before it is shown.
pub(super) struct Number<'a> {
    /// What it is called, to screen readers too.
    name: &'a str,
    /// Tells fields of one name apart.
    salt: u64,
    range: RangeInclusive<f64>,
    unit: &'a str,
    pub(super) digits: Digits,
    /// Value for each point of a drag.
    speed: f64,
    pub(super) width: f32,
}

#[derive(Clone, Debug)]
struct Draft {
    text: String,
    /// Whether someone has changed it: one that was opened and left says nothing.
    is_touched: bool,
}

/// What a field remembers between frames.
#[derive(Clone, Debug, Default)]
struct Memo {
    /// The text under edit.
    draft: Option<Draft>,
    /// A committed value that frames do not have yet.
    sent: Option<Sent>,
    /// The value of a drag under way, before rounding.
    dragged: Option<f64>,
    /// The frame in which it was last shown.
    frame: u64,
    /// What was wrong, and until when it is said.
    trouble: Option<(String, f64)>,
}

impl<'a> Number<'a> {
    pub(super) fn new(name: &'a str, range: RangeInclusive<f64>) -> Self {
        let speed = (range.end() - range.start()) * 2e-3;
        Self { name, salt: 0, range, unit: "", digits: Digits::Significant, speed, width: 76.0 }
    }

    pub(super) const fn salt(self, salt: u64) -> Self {
        Self { salt, ..self }
    }

    pub(super) const fn unit(self, unit: &'a str) -> Self {
        Self { unit, ..self }
    }

    pub(super) const fn digits(self, digits: Digits) -> Self {
        Self { digits, ..self }
    }

    pub(super) const fn speed(self, speed: f64) -> Self {
        Self { speed, ..self }
    }

    /// At most so wide, and never wider than there is room.
    pub(super) const fn width(self, width: f32) -> Self {
        Self { width, ..self }
    }

    /// As wide as there is room.
    pub(super) const fn wide(self) -> Self {
        self.width(f32::INFINITY)
    }

    /// Shows the field over a value; what a person did to it in this frame.
    pub(super) fn show(self, ui: &mut Ui, value: f64) -> (Response, Option<Change>) {
        let id = ui.make_persistent_id(("number", self.name, self.salt));
        let mut memo: Memo = ui.data(|d| d.get_temp(id)).unwrap_or_default();
        let (now, frame) = (ui.input(|i| i.time), ui.ctx().cumulative_frame_nr());
        if frame > memo.frame + 1 {
            // It was away meanwhile, with what was under way.
            (memo.draft, memo.dragged) = (None, None);
        }
        memo.frame = frame;
        let waiting = memo.sent.and_then(|sent| sent.shown(value, now));
        memo.sent = memo.sent.filter(|_| waiting.is_some());
        memo.trouble = memo.trouble.filter(|(_, until)| now < *until);
        let shown = memo.dragged.or(waiting).unwrap_or(value);
        let width = self.width.min(ui.available_width());
        let (_, rect) = ui.allocate_space(Vec2::new(width, ui.spacing().interact_size.y));
        let is_edited = ui.is_enabled()
            && ui.memory_mut(|memory| {
                memory.interested_in_focus(id, ui.layer_id());
                memory.has_focus(id)
            });
        let mut change = self.by_screen_reader(ui, id, shown);
        let response = if is_edited {
            self.arrows(ui, &mut memo, shown);
            self.edit(ui, rect, id, &mut memo, shown)
        } else {
            let response = ui.interact(rect, id, Sense::click_and_drag());
            self.paint(ui, rect, &response, shown);
            change = change.or(self.drag(ui, &response, &mut memo, value));
            response
        };
        if !response.has_focus()
            && let Some(draft) = memo.draft.take()
            && draft.is_touched
            && !ui.input(|i| i.key_pressed(Key::Escape))
        {
            change = self.take(&mut memo, &draft.text, now);
        }
        let change = change.filter(|change| *change != Change::Done(shown) || memo.dragged.is_some());
        if let Some(Change::Done(done)) = change {
            memo.dragged = None;
            memo.sent = Some(Sent::new(value, done, now));
        }
        self.describe(ui, &response, shown, is_edited);
        say(ui, &response, memo.trouble.as_ref());
        ui.data_mut(|d| d.insert_temp(id, memo));
        (response, change)
    }

    /// Takes what was typed, if it is a number; one beyond the range becomes its end, which is said.
    fn take(&self, memo: &mut Memo, text: &str, now: f64) -> Option<Change> {
        let until = now + SAID;
        match reading::read(text, self.unit) {
            Ok(read) => {
                let value = self.fitted(read);
                let end = if value > read { "smallest" } else { "largest" };
                if (value - read).abs() > 0.5 || !self.range.contains(&read) {
                    let value = reading::editable(value, self.digits);
                    memo.trouble = Some((format!("The {end} value is {value}."), until));
                }
                Some(Change::Done(value))
            }
            Err(message) => {
                memo.trouble = Some((format!("{message} The value is as before."), until));
                None
            }
        }
    }

    /// A value within the range, whole where only whole ones are.
    fn fitted(&self, value: f64) -> f64 {
        let value = if self.digits == Digits::Whole { value.round() } else { value };
        value.clamp(*self.range.start(), *self.range.end())
    }

    /// What a screen reader asks for.
    fn by_screen_reader(&self, ui: &Ui, id: Id, shown: f64) -> Option<Change> {
        use accesskit::{Action, ActionData};
        let set = ui.input(|input| {
            let mut requests = input.accesskit_action_requests(id, Action::SetValue);
            requests.find_map(|request| match &request.data {
                Some(ActionData::NumericValue(value)) => Some(*value),
                Some(ActionData::Value(text)) => reading::read(text, self.unit).ok(),
                _ => None,
            })
        });
        let steps = ui.input(|input| {
            input.num_accesskit_action_requests(id, Action::Increment) as f64
                - input.num_accesskit_action_requests(id, Action::Decrement) as f64
        });
        let stepped = (steps != 0.0).then(|| shown + steps * self.step());
        set.or(stepped).filter(|v| ui.is_enabled() && v.is_finite()).map(|v| Change::Done(self.fitted(v)))
    }

    fn step(&self) -> f64 {
        if self.digits == Digits::Whole { self.speed.max(1.0).round() } else { self.speed }
    }

    /// Up and down step the text under edit; they send nothing.
    fn arrows(&self, ui: &Ui, memo: &mut Memo, shown: f64) {
        let count = |key| ui.input_mut(|i| i.count_and_consume_key(Modifiers::NONE, key)) as f64;
        let steps = count(Key::ArrowUp) - count(Key::ArrowDown);
        if steps != 0.0
            && let Some(draft) = &mut memo.draft
        {
            let from = reading::read(&draft.text, self.unit).unwrap_or(shown);
            draft.text = reading::editable(self.fitted(from + steps * self.step()), self.digits);
            draft.is_touched = true;
        }
    }

    fn edit(&self, ui: &mut Ui, rect: Rect, id: Id, memo: &mut Memo, shown: f64) -> Response {
        let is_new = memo.draft.is_none();
        let draft = memo
            .draft
            .get_or_insert_with(|| Draft { text: reading::editable(shown, self.digits), is_touched: false });
        let text = &mut draft.text;
        if is_new {
            memo.trouble = None;
            let mut state = egui::TextEdit::load_state(ui.ctx(), id).unwrap_or_default();
            let all = egui::text::CCursorRange::two(
                egui::text::CCursor::default(),
                egui::text::CCursor::new(text.chars().count()),
            );
            state.cursor.set_char_range(Some(all));
            egui::TextEdit::store_state(ui.ctx(), id, state);
        }
        let place =
            egui::UiBuilder::new().max_rect(rect).layout(egui::Layout::left_to_right(egui::Align::Center));
        let edit = egui::TextEdit::singleline(text).id(id).font(egui::TextStyle::Monospace);
        let edit =
            edit.margin(egui::Margin::symmetric(4, 2)).clip_text(true).desired_width(rect.width() - 8.0);
        let mut child = ui.new_child(place);
        let response = child.add(edit.align(Align2::RIGHT_CENTER).min_size(rect.size()));
        draft.is_touched |= response.changed();
        response
    }

    fn paint(&self, ui: &Ui, rect: Rect, response: &Response, shown: f64) {
        if !ui.is_rect_visible(rect) {
            return;
        }
        let visuals =
            if ui.is_enabled() { *ui.style().interact(response) } else { ui.visuals().widgets.inactive };
        let painter = ui.painter();
        painter.rect(
            rect,
            visuals.corner_radius,
            visuals.weak_bg_fill,
            visuals.bg_stroke,
            egui::StrokeKind::Inside,
        );
        let font = egui::TextStyle::Monospace.resolve(ui.style());
        let inside = rect.shrink2(Vec2::new(5.0, 1.0));
        let galley = |text: String| painter.layout_no_wrap(text, font.clone(), visuals.text_color());
        // Where there is no room for all, the unit goes first, then the last decimals.
        let mut texts = reading::shorter(shown, self.digits).into_iter();
        let mut laid_out = galley(reading::shown(shown, self.digits) + &separated(self.unit));
        while laid_out.size().x > inside.width()
            && let Some(text) = texts.next()
        {
            laid_out = galley(text);
        }
        let at = Align2::RIGHT_CENTER.anchor_size(inside.right_center(), laid_out.size()).min;
        let clip = painter.with_clip_rect(rect.shrink(1.0).intersect(ui.clip_rect()));
        clip.galley(at, laid_out, visuals.text_color());
    }

    /// Dragging sideways; a click begins to edit.
    fn drag(&self, ui: &Ui, response: &Response, memo: &mut Memo, value: f64) -> Option<Change> {
        if !ui.is_enabled() {
            // Whoever clicks here and types means this field, and no shortcut.
            let is_pressed = ui.input(|i| {
                i.pointer.any_pressed()
                    && i.pointer.interact_pos().is_some_and(|at| response.rect.contains(at))
            });
            if is_pressed {
                super::typing::rest_until_a_click(ui.ctx());
            }
            return None;
        }
        if response.clicked() {
            response.request_focus();
            return None;
        }
        if response.dragged() && response.drag_delta().x != 0.0 {
            let slow = if ui.input(|i| i.modifiers.shift) { 0.1 } else { 1.0 };
            let exact =
                memo.dragged.unwrap_or(value) + f64::from(response.drag_delta().x) * self.speed * slow;
            memo.dragged = Some(exact.clamp(*self.range.start(), *self.range.end()));
            return Some(Change::Moving(self.rounded(memo.dragged?)));
        }
        let released = if response.drag_stopped() { memo.dragged } else { None };
        released.map(|exact| Change::Done(self.rounded(exact)))
    }

    /// A dragged value, in no more digits than the field shows.
    fn rounded(&self, value: f64) -> f64 {
        let text = match self.digits {
            Digits::Decimals(n) => format!("{value:.n$}"),
            digits => reading::editable(value, digits),
        };
        self.fitted(text.parse().unwrap_or(value))
    }

    /// What screen readers are told.
    fn describe(&self, ui: &Ui, response: &Response, shown: f64, is_edited: bool) {
        let is_enabled = ui.is_enabled();
        response.widget_info(|| egui::WidgetInfo::drag_value(is_enabled, shown));
        ui.ctx().accesskit_node_builder(response.id, |node| {
            node.set_label(self.name.to_owned());
            if self.range.start().is_finite() && self.range.end().is_finite() {
                node.set_min_numeric_value(*self.range.start());
                node.set_max_numeric_value(*self.range.end());
            }
            node.set_numeric_value_step(self.step());
            if is_enabled {
                for action in
                    [accesskit::Action::SetValue, accesskit::Action::Increment, accesskit::Action::Decrement]
                {
                    node.add_action(action);
                }
            }
            if !is_edited {
                node.set_value(reading::shown(shown, self.digits) + &separated(self.unit));
            }
        });
    }
}

/// A unit as it stands after a number.
fn separated(unit: &str) -> String {
    match unit {
        "" | "°" => unit.to_owned(),
        _ => format!("\u{a0}{unit}"),
    }
}

/// Says what was wrong, over the panel; nothing moves for it.
fn say(ui: &Ui, response: &Response, trouble: Option<&(String, f64)>) {
    let Some((text, until)) = trouble else { return };
    let left = (until - ui.input(|i| i.time)).max(0.0);
    ui.ctx().request_repaint_after(std::time::Duration::from_secs_f64(left));
    let id = response.id.with("trouble");
    // Over the panels, under lists and menus.
    // Above the field: below it is what the pointer over it asks for.
    let area = egui::Area::new(id).order(egui::Order::Middle).interactable(false).pivot(Align2::LEFT_BOTTOM);
    area.fixed_pos(response.rect.left_top() - Vec2::new(0.0, 2.0)).show(ui.ctx(), |ui| {
        egui::Frame::popup(ui.style()).show(ui, |ui| {
            ui.set_max_width(220.0);
            ui.colored_label(ui.visuals().error_fg_color, text);
        });
    });
}
