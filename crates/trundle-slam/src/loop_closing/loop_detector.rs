//! The queue of keyframes whose loops are to be searched.

use crate::ids::KeyframeId;
use crate::loop_closing::loop_closer::{LoopCloser, LoopSearch};
use crate::loop_closing::loop_closure::LoopClosure;
use crate::map::landmark_map::LandmarkMap;
use crate::optimisation::map_optimisation::MapOptimisation;
use crate::place_recognition::consistency_check::ConsistencyCheck;
use std::collections::VecDeque;

/// Searches loops, one step per frame.
#[derive(Debug, Default)]
pub(crate) struct LoopDetector {
    searches: VecDeque<LoopSearch>,
    /// An unexpected correction that waits for more keyframes to confirm it.
    pending_loop: Option<ConsistencyCheck<()>>,
}

/// Result of a step of the detector.
#[derive(Debug)]
pub(crate) enum LoopStep {
    /// No keyframe was in the queue.
    Idle,
    /// A step of a search that closed no loop.
    Searched,
    Closed(LoopClosure),
}

impl LoopDetector {
    pub fn push(&mut self, keyframe: KeyframeId) {
        self.searches.push_back(LoopSearch::of(keyframe));
    }

    pub fn is_idle(&self) -> bool {
        self.searches.is_empty()
    }

    /// Drops the queue, when its keyframes are of another map or far away.
    pub fn drop_searches(&mut self) {
        self.searches.clear();
    }

    /// Drops the pending correction, when it is of another map.
    pub fn drop_pending(&mut self) {
        self.pending_loop = None;
    }

    /// Continues the oldest search.
    pub fn advance(
        &mut self,
        loop_closer: &LoopCloser,
        map: &mut LandmarkMap,
        optimisation: &mut MapOptimisation,
    ) -> LoopStep {
        let Some(mut search) = self.searches.pop_front() else { return LoopStep::Idle };
        if !loop_closer.advance(map, &mut search) {
            self.searches.push_front(search);
            return LoopStep::Searched;
        }
        let closed = loop_closer.close((map, optimisation), search, &mut self.pending_loop);
        closed.map_or(LoopStep::Searched, LoopStep::Closed)
    }
}
