//! How much to keep from obstacles, when all that was asked for is dear or not to be had.
//!
//! Problem: the manoeuvre that keeps a whole margin in a tight place may be absurdly long, or take long to find. Idea: one or
//! two legs are looked for with less and less margin first; more legs are looked for with the whole margin, and are taken
//! when they are not much slower than what less margin allows. Cost: counted, not timed, so that the answer is one everywhere.

use crate::manoeuvre::Manoeuvre;
use crate::optimal::{self, Certificate, Effort, Outcome, Task, Timed};
use crate::pace::Meter;
use crate::plan::{Impossible, Limit, Plan, Solution};
use crate::scene::{Blocker, Scene};
use crate::space::Space;
use std::sync::Arc;
use trundle_collision::RoundedHull;
use trundle_core::Footprint;

/// A manoeuvre of more than so many times the bound is compared with those of less margin.
const LONG: f64 = 3.0;
/// Boxes for that bound.
const BOXES: usize = 100;
/// Part of the work for many motions where less margin allows one or two legs.
const PART: u64 = 40;

/// A task, and the margins that may be kept, m.
#[derive(Debug)]
pub struct Margins<'a> {
    pub footprint: &'a Footprint,
    pub scene: &'a Scene,
    pub task: Task,
    pub most: f64,
    pub least: f64,
    pub effort: Effort,
    /// Less margin is taken where it saves this part of the time; 1 never takes less than it can.
    pub saving: f64,
    pub meter: &'a Arc<Meter>,
}

/// Legs among obstacles at a distance.
struct Found<'a> {
    space: Space<'a>,
    legs: Timed,
    margin: f64,
}

impl<'a> Margins<'a> {
    /// The manoeuvre, with the margin that is worth its time.
    pub async fn plan(&self) -> Plan {
        if let Some(found) = self.one_or_two(self.most).await {
            return self.solution(found).await;
        }
        if self.most <= self.least {
            return self.told(self.many(self.least, 1).await).await;
        }
        let mut quick = self.one_or_two(self.most / 3.0).await;
        if quick.is_none() {
            quick = self.one_or_two(self.least).await;
        }
        let Some(quick) = quick else {
            // What is shown for the least margin holds for all.
            let never = optimal::never(&self.task, &self.space(self.least), self.effort).await;
            return match never {
                Some(Outcome::Apart(certificate, by)) => {
                    self.told(Err(Apart { certificate, by, limit: None })).await
                }
                _ => self.told(self.of_many().await).await,
            };
        };
        match self.many(self.most, if self.saving < 1.0 { PART } else { 1 }).await {
            Ok(slow) if (1.0 - self.saving) * slow.legs.0 <= quick.legs.0 => self.solution(slow).await,
            _ => self.solution(quick).await,
        }
    }

    /// By many motions, with all the margin, the least, or what is between.
    async fn of_many(&self) -> Result<Found<'a>, Apart> {
        let whole = self.many(self.most, 1).await;
        if let Ok(found) = &whole
            && (self.saving >= 1.0 || !self.is_long(found).await)
        {
            return whole;
        }
        let least = match (whole, self.many(self.least, 1).await) {
            (Ok(whole), Ok(least)) if (1.0 - self.saving) * whole.legs.0 <= least.legs.0 => return Ok(whole),
            (Ok(whole), Err(_)) => return Ok(whole),
            (_, least) => least?,
        };
        match self.many(self.most / 3.0, 1).await {
            Ok(between) if (1.0 - self.saving) * between.legs.0 <= least.legs.0 => Ok(between),
            _ => Ok(least),
        }
    }

    async fn is_long(&self, found: &Found<'_>) -> bool {
        let (mut space, time) = (found.space.clone(), found.legs.0);
        time > LONG
            * optimal::bound(&self.task, &mut space, time, self.effort.gap, BOXES.min(self.effort.boxes))
                .await
    }

    fn space(&self, margin: f64) -> Space<'a> {
        Space::metered(RoundedHull::new(self.footprint, margin), self.scene, Arc::clone(self.meter))
    }

    async fn one_or_two(&self, margin: f64) -> Option<Found<'a>> {
        let mut space = self.space(margin);
        let legs = optimal::one_or_two(self.task, &mut space).await?;
        Some(Found { space, legs, margin })
    }

    /// With a `part`-th of the work.
    async fn many(&self, margin: f64, part: u64) -> Result<Found<'a>, Apart> {
        let mut space = self.space(margin);
        let effort = Effort { work: self.effort.work / part, ..self.effort };
        match optimal::many(self.task, &mut space, effort).await {
            Outcome::Found(legs) => Ok(Found { space, legs, margin }),
            Outcome::Apart(certificate, by) => Err(Apart { certificate, by, limit: None }),
            Outcome::Nothing(limit) => {
                Err(Apart { certificate: Certificate::None, by: None, limit: Some(limit) })
            }
        }
    }

    async fn told(&self, outcome: Result<Found<'a>, Apart>) -> Plan {
        match outcome {
            Ok(found) => self.solution(found).await,
            Err(Apart { certificate, by, limit }) => {
                let by = by.map(|by| self.scene.named(by));
                Plan::Impossible(Impossible { by, certificate, limit, within: self.task.reach })
            }
        }
    }

    async fn solution(&self, mut found: Found<'a>) -> Plan {
        let ((_, legs), bound) = optimal::better(self.task, &mut found.space, found.legs, self.effort).await;
        let (_, motions) =
            legs.motions(&self.task, &mut found.space).expect("invariant: found legs are free");
        let manoeuvre = Manoeuvre::new(self.task.start, &motions, self.task.limits);
        Plan::Found(Solution { manoeuvre, bound, margin: found.margin })
    }
}

/// Why there are no legs.
struct Apart {
    certificate: Certificate,
    by: Option<Blocker>,
    limit: Option<Limit>,
}
