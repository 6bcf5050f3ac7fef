//! Choice of the margin if the full margin costs much time or allows no manoeuvre.
//!
//! Problem: the manoeuvre with the full margin in a narrow space may be very long, or take long to find. Idea: search one or two legs with
//! smaller and smaller margins first. Search more legs with the full margin, and take them if they are not much slower than a manoeuvre
//! with a smaller margin. The cost is counted, not timed, which gives the same answer on every machine.

use crate::certificate::{Certificate, SearchLimit};
use crate::contact_space::ContactSpace;
use crate::docking_plan::{DockingPlan, Impossible, Solution};
use crate::legs::query::DockingQuery;
use crate::motion::manoeuvre::Manoeuvre;
use crate::scene::blocker::Blocker;
use crate::scene::obstacle_scene::ObstacleScene;
use crate::search::min_time;
use crate::search::min_time::{Effort, LegOutcome, Timed};
use crate::work_budget::WorkBudget;
use std::sync::Arc;
use trundle_collision::RoundedHull;
use trundle_core::Footprint;

/// Ratio of a manoeuvre's time to the lower bound above which smaller margins are compared. Source: ours.
const MAX_TIME_RATIO: f64 = 3.0;
/// Number of boxes for that lower bound. Source: ours.
const RATIO_BOUND_BOXES: usize = 100;
/// Divisor of the work for many motions if a smaller margin allows one or two legs. Source: ours.
const REDUCED_WORK_DIVISOR: u64 = 40;

/// A docking query, and the candidate margins, m.
#[derive(Debug)]
pub struct MarginSelection<'a> {
    pub footprint: &'a Footprint,
    pub scene: &'a ObstacleScene,
    pub query: DockingQuery,
    pub max: f64,
    pub min: f64,
    pub effort: Effort,
    /// Part of the time that a smaller margin must save; 1 keeps the largest possible margin.
    pub saving: f64,
    pub budget: &'a Arc<WorkBudget>,
}

/// Legs found with a margin.
struct FoundLegs<'a> {
    space: ContactSpace<'a>,
    legs: Timed,
    margin: f64,
}

impl<'a> MarginSelection<'a> {
    /// The manoeuvre with the best compromise of margin and time.
    pub async fn plan(&self) -> DockingPlan {
        if let Some(found) = self.one_or_two(self.max).await {
            return self.solution(found).await;
        }
        if self.max <= self.min {
            return self.plan_of(self.many(self.min, 1).await).await;
        }
        let mut quick = self.one_or_two(self.max / 3.0).await;
        if quick.is_none() {
            quick = self.one_or_two(self.min).await;
        }
        let Some(quick) = quick else {
            // A proof for the smallest margin is valid for all.
            let never = min_time::never(&self.query, &self.space(self.min), self.effort).await;
            return match never {
                Some(LegOutcome::Disconnected(certificate, by)) => {
                    self.plan_of(Err(NoLegs { certificate, by, limit: None })).await
                }
                _ => self.plan_of(self.with_many_motions().await).await,
            };
        };
        match self.many(self.max, if self.saving < 1.0 { REDUCED_WORK_DIVISOR } else { 1 }).await {
            Ok(slow) if (1.0 - self.saving) * slow.legs.0 <= quick.legs.0 => self.solution(slow).await,
            _ => self.solution(quick).await,
        }
    }

    /// The manoeuvre of many motions, with the full margin, the smallest margin, or one between.
    async fn with_many_motions(&self) -> Result<FoundLegs<'a>, NoLegs> {
        let whole = self.many(self.max, 1).await;
        if let Ok(found) = &whole
            && (self.saving >= 1.0 || !self.is_long(found).await)
        {
            return whole;
        }
        let min = match (whole, self.many(self.min, 1).await) {
            (Ok(whole), Ok(min)) if (1.0 - self.saving) * whole.legs.0 <= min.legs.0 => return Ok(whole),
            (Ok(whole), Err(_)) => return Ok(whole),
            (_, min) => min?,
        };
        match self.many(self.max / 3.0, 1).await {
            Ok(between) if (1.0 - self.saving) * between.legs.0 <= min.legs.0 => Ok(between),
            _ => Ok(min),
        }
    }

    async fn is_long(&self, found: &FoundLegs<'_>) -> bool {
        let (mut space, time) = (found.space.clone(), found.legs.0);
        time > MAX_TIME_RATIO
            * min_time::bound(
                &self.query,
                &mut space,
                time,
                self.effort.gap,
                RATIO_BOUND_BOXES.min(self.effort.boxes),
            )
            .await
    }

    fn space(&self, margin: f64) -> ContactSpace<'a> {
        ContactSpace::metered(RoundedHull::new(self.footprint, margin), self.scene, Arc::clone(self.budget))
    }

    async fn one_or_two(&self, margin: f64) -> Option<FoundLegs<'a>> {
        let mut space = self.space(margin);
        let legs = min_time::one_or_two(self.query, &mut space).await?;
        Some(FoundLegs { space, legs, margin })
    }

    /// The search with the work divided by `part`.
    async fn many(&self, margin: f64, part: u64) -> Result<FoundLegs<'a>, NoLegs> {
        let mut space = self.space(margin);
        let effort = Effort { work: self.effort.work / part, ..self.effort };
        match min_time::many(self.query, &mut space, effort).await {
            LegOutcome::Found(legs) => Ok(FoundLegs { space, legs, margin }),
            LegOutcome::Disconnected(certificate, by) => Err(NoLegs { certificate, by, limit: None }),
            LegOutcome::Nothing(limit) => {
                Err(NoLegs { certificate: Certificate::None, by: None, limit: Some(limit) })
            }
        }
    }

    async fn plan_of(&self, outcome: Result<FoundLegs<'a>, NoLegs>) -> DockingPlan {
        match outcome {
            Ok(found) => self.solution(found).await,
            Err(NoLegs { certificate, by, limit }) => {
                let by = by.map(|by| self.scene.named(by));
                DockingPlan::Impossible(Impossible { by, certificate, limit, within: self.query.reach })
            }
        }
    }

    async fn solution(&self, mut found: FoundLegs<'a>) -> DockingPlan {
        let ((_, legs), bound) =
            min_time::improve_legs(self.query, &mut found.space, found.legs, self.effort).await;
        let (_, motions) =
            legs.motions(&self.query, &mut found.space).expect("invariant: found legs are free");
        let manoeuvre = Manoeuvre::new(self.query.start, &motions, self.query.limits);
        DockingPlan::Found(Solution { manoeuvre, bound, margin: found.margin })
    }
}

/// Reason for the absence of legs.
struct NoLegs {
    certificate: Certificate,
    by: Option<Blocker>,
    limit: Option<SearchLimit>,
}
