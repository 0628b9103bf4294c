//! Names of tools and handles.

/// What a person does to what is selected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Moves it.
    #[default]
    Move,
    /// Turns it.
    Rotate,
    /// Scales it.
    Scale,
}

impl Tool {
    /// All tools, in the order of the window.
    pub const ALL: [Self; 3] = [Self::Move, Self::Rotate, Self::Scale];

    /// Its name on a button.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Move => "Move",
            Self::Rotate => "Rotate",
            Self::Scale => "Scale",
        }
    }
}

/// A part of a gizmo that can be dragged. Axes are 0 to 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Handle {
    /// Moves along an axis of the world.
    MoveAxis(u8),
    /// Moves in the plane across an axis of the world.
    MovePlane(u8),
    /// Moves in the plane of the image.
    MoveView,
    /// Turns about an axis of the world.
    Turn(u8),
    /// Scales along an axis of the thing itself.
    ScaleAxis(u8),
    /// Scales evenly.
    ScaleAll,
}

impl Handle {
    /// The axis that it belongs to.
    #[must_use]
    pub const fn axis(self) -> Option<u8> {
        match self {
            Self::MoveAxis(axis) | Self::MovePlane(axis) | Self::Turn(axis) | Self::ScaleAxis(axis) => {
                Some(axis)
            }
            Self::MoveView | Self::ScaleAll => None,
        }
    }
}
