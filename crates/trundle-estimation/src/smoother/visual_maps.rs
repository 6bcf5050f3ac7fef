//! Slots of the anchors, and the visual maps that own them.

use super::state::ANCHOR_SLOTS;
use nalgebra::Matrix3;
use std::collections::BTreeMap;
use trundle_core::{Pose2, Pose3};

/// Visual maps with an anchor among the unknowns, and visual maps whose anchor was removed.
#[derive(Debug, Clone, Default)]
pub(crate) struct VisualMaps {
    slots: [Option<Slot>; ANCHOR_SLOTS],
    /// Anchors of maps without a slot.
    stored: BTreeMap<u32, StoredAnchor>,
    uses: u64,
}

/// A visual map that owns a slot.
#[derive(Debug, Clone, Copy)]
struct Slot {
    map: u32,
    /// Rotates and lifts the visual map's frame: its x-y plane becomes the floor.
    level_from_visual: Pose3,
    /// Number of the last use.
    used: u64,
}

/// The anchor of a visual map that is not in the window.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StoredAnchor {
    pub(crate) level_from_visual: Pose3,
    /// `map_from_level` in the plane.
    pub(crate) anchor: Pose2,
    /// Covariance as a right perturbation.
    pub(crate) covariance: Matrix3<f64>,
}

/// The slot for a visual map.
#[derive(Debug, Clone, Copy)]
pub(crate) enum SlotFor {
    /// The slot belongs to the map.
    Known(usize),
    /// The map had a slot earlier; its stored anchor must be set.
    Stored(usize, StoredAnchor),
    /// The map is new.
    New(usize),
}

impl VisualMaps {
    /// Maps with these anchors.
    pub(crate) fn with_anchors(stored: BTreeMap<u32, StoredAnchor>) -> Self {
        Self { stored, ..Self::default() }
    }

    /// The frame of the map in a slot.
    pub(crate) fn level(&self, slot: usize) -> Option<Pose3> {
        self.slots[slot].map(|slot| slot.level_from_visual)
    }

    /// The slot of a map; `None` if all slots are in use by the window (`is_used`).
    pub(crate) fn slot_for(&self, map: u32, is_used: impl Fn(usize) -> bool) -> Option<SlotFor> {
        let owns = |slot: &Option<Slot>| slot.is_some_and(|slot| slot.map == map);
        if let Some(known) = self.slots.iter().position(owns) {
            return Some(SlotFor::Known(known));
        }
        let free = (0..ANCHOR_SLOTS).filter(|&slot| self.slots[slot].is_none() || !is_used(slot));
        let oldest = free.min_by_key(|&slot| self.slots[slot].map_or(0, |slot| slot.used + 1))?;
        Some(self.stored.get(&map).map_or(SlotFor::New(oldest), |stored| SlotFor::Stored(oldest, *stored)))
    }

    /// Gives a slot to a map; the map that owned it is stored with `anchor`.
    pub(crate) fn take(
        &mut self,
        slot: usize,
        map: u32,
        level_from_visual: Pose3,
        anchor: (Pose2, Matrix3<f64>),
    ) {
        if let Some(old) = self.slots[slot] {
            let (anchor, covariance) = anchor;
            let stored = StoredAnchor { level_from_visual: old.level_from_visual, anchor, covariance };
            self.stored.insert(old.map, stored);
        }
        self.stored.remove(&map);
        self.slots[slot] = Some(Slot { map, level_from_visual, used: self.uses });
    }

    /// Notes a use of a slot.
    pub(crate) fn on_used(&mut self, slot: usize) {
        self.uses += 1;
        if let Some(slot) = &mut self.slots[slot] {
            slot.used = self.uses;
        }
    }

    /// Number and slot of the map used last.
    pub(crate) fn newest(&self) -> Option<(u32, usize)> {
        let owned = self.slots.iter().enumerate().filter_map(|(i, slot)| Some((slot.as_ref()?, i)));
        owned.max_by_key(|(slot, _)| slot.used).map(|(slot, i)| (slot.map, i))
    }
}
