//! Viewers, and the viewer in control.

use std::collections::BTreeMap;

/// Maximum number of simultaneous viewers. Source: ours; measured: ten viewers do not disturb the robot.
const MAX_VIEWERS: usize = 24;
/// Longest name of a viewer \[characters\]. Source: ours.
const MAX_NAME_CHARS: usize = 24;

/// Number of a viewer.
pub type ViewerId = u64;

/// Viewers, and at most one viewer in control.
#[derive(Debug, Default)]
pub struct ViewerList {
    names: BTreeMap<ViewerId, String>,
    last: ViewerId,
    wheel: Option<ViewerId>,
}

impl ViewerList {
    /// Adds a viewer; returns its number. `None` if the number of viewers is at its limit. A viewer without a name is named by its number.
    pub fn enter(&mut self, name: &str) -> Option<ViewerId> {
        if self.names.len() >= MAX_VIEWERS {
            return None;
        }
        self.last += 1;
        let clean: String = name.chars().filter(|c| !c.is_control()).take(MAX_NAME_CHARS).collect();
        let clean = clean.trim();
        let name = if clean.is_empty() { format!("viewer {}", self.last) } else { clean.to_owned() };
        self.names.insert(self.last, name);
        Some(self.last)
    }

    /// Removes a viewer. Returns whether the viewer was in control.
    pub fn leave(&mut self, id: ViewerId) -> bool {
        self.names.remove(&id);
        self.release(id)
    }

    /// Gives control to a viewer, and takes it from the previous one.
    pub fn take(&mut self, id: ViewerId) {
        self.wheel = Some(id);
    }

    /// Releases control. Returns whether this viewer was in control.
    pub fn release(&mut self, id: ViewerId) -> bool {
        let held = self.wheel == Some(id);
        if held {
            self.wheel = None;
        }
        held
    }

    /// Gives a free wheel to a viewer.
    ///
    /// # Errors
    /// The name of another viewer in control.
    pub fn require(&mut self, id: ViewerId) -> Result<(), String> {
        match self.wheel {
            Some(holder) if holder != id => Err(self.name_of(holder)),
            _ => {
                self.wheel = Some(id);
                Ok(())
            }
        }
    }

    /// Number and name of the viewer at the wheel.
    pub fn holder(&self) -> Option<(ViewerId, String)> {
        self.wheel.map(|id| (id, self.name_of(id)))
    }

    /// Number of viewers.
    pub fn count(&self) -> usize {
        self.names.len()
    }

    fn name_of(&self, id: ViewerId) -> String {
        self.names.get(&id).cloned().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_holds_the_wheel_until_it_leaves_or_another_takes_it() {
        let mut viewer_list = ViewerList::default();
        let (anna, bert) = (viewer_list.enter(" Anna\u{7} ").unwrap(), viewer_list.enter(" ").unwrap());
        assert_eq!(viewer_list.require(anna), Ok(()));
        assert_eq!(viewer_list.require(bert), Err("Anna".to_owned()));
        viewer_list.take(bert);
        assert_eq!(viewer_list.holder(), Some((bert, "viewer 2".to_owned())));
        assert!(!viewer_list.leave(anna) && viewer_list.leave(bert));
        assert_eq!((viewer_list.holder(), viewer_list.count()), (None, 0));
    }

    #[test]
    fn viewers_are_limited() {
        let mut viewer_list = ViewerList::default();
        let entered = std::iter::from_fn(|| viewer_list.enter("guest")).take(1000).count();
        assert_eq!(entered, MAX_VIEWERS);
    }
}
