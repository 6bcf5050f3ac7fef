//! Bumper contacts and edges.

/// The bumper and the cliff sensors, and the contacts on the path to the goal.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Contacts {
    /// Whether the bumper is pressed.
    pub(crate) touched: bool,
    /// Whether a cliff sensor reports an edge.
    pub(crate) over_edge: bool,
    /// Contacts since the goal was given.
    pub(crate) count: u32,
}

/// Number of bumper contacts after which the navigator gives up a goal. Source: ours.
pub(crate) const MAX_BUMPER_CONTACTS: u32 = 3;

impl Contacts {
    /// A change of the bumper. A bumper that stays pressed is one contact.
    pub(crate) fn touch(&mut self, pressed: bool) {
        self.count += u32::from(pressed && !self.touched);
        self.touched = pressed;
    }

    /// Resets the count for the next goal.
    pub(crate) fn restart(&mut self) {
        self.count = 0;
    }

    /// Whether the bumper or a cliff sensor reports at present.
    pub(crate) fn is_any(&self) -> bool {
        self.touched || self.over_edge
    }

    /// Whether the contacts show that the map lacks the obstacle, or has it at a wrong place.
    pub(crate) fn are_too_many(&self) -> bool {
        self.count >= MAX_BUMPER_CONTACTS
    }
}
