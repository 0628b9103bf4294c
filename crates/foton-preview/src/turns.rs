//! Input that came together in a frame that took long, in turns. A key may open a question, or a click choose a field, and the keys
//! after it are meant for that; but panels look at all events of a frame at once.

use egui::{Event, Key};

/// Takes the first turn's events from those that wait: up to the first press after one that may change whom keys are for.
pub(crate) fn first_turn(waiting: &mut Vec<Event>) -> Vec<Event> {
    let end = waiting.iter().position(may_turn).map_or(waiting.len(), |turn| {
        let rest = &waiting[turn + 1..];
        // Clicks in a row are told apart by egui.
        let is_click = is_of_the_pointer(&waiting[turn]);
        let next = rest.iter().position(|e| is_press(e) && !(is_click && is_of_the_pointer(e)));
        next.map_or(waiting.len(), |next| turn + 1 + next)
    });
    let later = waiting.split_off(end);
    std::mem::replace(waiting, later)
}

/// Whether keys may be for something else after this.
fn may_turn(event: &Event) -> bool {
    match event {
        Event::PointerButton { .. } => true,
        Event::Key { key, pressed: true, modifiers, .. } => match key {
            Key::Escape | Key::Enter | Key::Tab | Key::F2 | Key::F6 => true,
            Key::O | Key::S | Key::Q => modifiers.command,
            _ => false,
        },
        _ => false,
    }
}

/// Whether this is for someone in particular.
const fn is_press(event: &Event) -> bool {
    matches!(
        event,
        Event::Key { pressed: true, .. }
            | Event::Text(_)
            | Event::Paste(_)
            | Event::Cut
            | Event::Copy
            | Event::PointerButton { .. }
    )
}

const fn is_of_the_pointer(event: &Event) -> bool {
    matches!(event, Event::PointerButton { .. })
}

#[cfg(test)]
mod tests {
    use egui::{Modifiers, PointerButton, Pos2};

    use super::*;

    fn key(key: Key, modifiers: Modifiers) -> Event {
        Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
    }

    fn button(pressed: bool) -> Event {
        let (pos, button, modifiers) = (Pos2::ZERO, PointerButton::Primary, Modifiers::NONE);
        Event::PointerButton { pos, button, pressed, modifiers }
    }

    fn turns(mut waiting: Vec<Event>) -> Vec<usize> {
        let mut turns = Vec::new();
        while !waiting.is_empty() {
            turns.push(first_turn(&mut waiting).len());
        }
        turns
    }

    #[test]
    fn a_key_that_opens_a_question_ends_a_turn_and_other_keys_do_not() {
        let (z, q) = (key(Key::Z, Modifiers::COMMAND), key(Key::Q, Modifiers::COMMAND));
        let escape = key(Key::Escape, Modifiers::NONE);
        assert_eq!(turns(vec![z.clone(), z.clone(), key(Key::Q, Modifiers::NONE)]), [3]);
        assert_eq!(turns(vec![z.clone(), q, escape, z.clone(), z]), [2, 1, 2]);
        // A letter belongs to the field that was clicked before it; what moves is part of the turn.
        let (text, moved) = (Event::Text("7".into()), Event::PointerMoved(Pos2::ZERO));
        assert_eq!(turns(vec![button(true), button(false), moved, text.clone(), text]), [3, 2]);
        assert!(turns(Vec::new()).is_empty());
    }
}
