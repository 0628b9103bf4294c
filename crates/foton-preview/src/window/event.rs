//! What wakes the event loop.

/// What wakes the event loop.
#[derive(Debug)]
pub(super) enum UserEvent {
    /// The engine has a frame or an event.
    Wake,
    /// egui wants to be drawn again after a while.
    Repaint(std::time::Duration),
    /// The adapter of a number is gone.
    DeviceLost(u64),
    /// The window is to close.
    Close,
    /// A screen reader asks.
    AccessKit(egui_winit::accesskit_winit::Event),
}

impl From<egui_winit::accesskit_winit::Event> for UserEvent {
    fn from(event: egui_winit::accesskit_winit::Event) -> Self {
        Self::AccessKit(event)
    }
}
