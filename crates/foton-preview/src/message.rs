//! Messages for a person: the same one again is counted, not piled up.

/// How long a message stays, in seconds; errors stay until they are closed.
pub(crate) const MESSAGE_SECONDS: f64 = 6.0;

/// How a message is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tone {
    Notice,
    Error,
}

/// Something to tell.
#[derive(Clone, Debug)]
pub(crate) struct Message {
    pub(crate) tone: Tone,
    pub(crate) text: String,
    /// How often it was told: the same again is no other message.
    pub(crate) times: u32,
    /// When it was first drawn since it was told last, in seconds of the window's clock.
    pub(crate) since: Option<f64>,
    /// Whether the frame log has it.
    pub(crate) is_logged: bool,
}

/// Tells something, as the newest of all.
pub(crate) fn tell(messages: &mut Vec<Message>, tone: Tone, text: String) {
    let same = messages.iter().position(|m| m.tone == tone && m.text == text);
    let times = same.map_or(0, |i| messages.remove(i).times);
    messages.push(Message { tone, text, times: times.saturating_add(1), since: None, is_logged: false });
}
