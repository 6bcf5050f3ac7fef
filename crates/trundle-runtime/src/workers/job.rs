//! Jobs and their results.

use crate::world_state::OwnedWorldState;
use crate::{
    behaviour::navigator::Decision,
    lazy_image::LazyImage,
    stage::{Stage, StageTimes},
    workers::decision_worker::DecisionWorker,
    workers::perception_worker::{PerceptionResult, PerceptionWorker},
};
use serde::{Deserialize, Serialize};
use trundle_core::Stamp;
use trundle_estimation::OdometryState;

/// The worker of a job. Each worker runs one job at a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Worker {
    /// Processes an image: camera pose and scan.
    #[serde(alias = "lookout")]
    Perception,
    /// Makes long decisions: plans, frontiers, turns and straight moves.
    #[serde(alias = "captain")]
    Decision,
}

impl Worker {
    /// All workers.
    pub const ALL: [Self; 2] = [Worker::Perception, Worker::Decision];
}

/// Work that may take longer than a control step. The job contains all its inputs. Run it on any thread, and pass the answer to
/// [`crate::Robot::apply_answer`].
#[derive(Debug)]
pub struct Job(pub(crate) Work);

#[derive(Debug)]
pub(crate) enum Work {
    Perceive { perception: Box<PerceptionWorker>, image: LazyImage, odometer: Box<OdometryState> },
    Decide { decision_worker: Box<DecisionWorker>, around: Box<OwnedWorldState> },
}

/// The result of a job.
#[derive(Debug)]
pub struct Answer {
    pub(crate) result: Outcome,
    pub(crate) times: Box<StageTimes>,
}

#[derive(Debug)]
pub(crate) enum Outcome {
    Perceived {
        perception: Box<PerceptionWorker>,
        /// Stamp of the image.
        stamp: Stamp,
        /// `None` for a frozen camera; an error for an image that cannot be decoded.
        perceived: Result<Option<Box<PerceptionResult>>, String>,
    },
    Decided {
        decision_worker: Box<DecisionWorker>,
        decision: Decision,
        asked: Stamp,
    },
}

impl Job {
    /// Worker of the job.
    pub fn worker(&self) -> Worker {
        match &self.0 {
            Work::Perceive { .. } => Worker::Perception,
            Work::Decide { .. } => Worker::Decision,
        }
    }

    /// Runs the job.
    pub fn run(self) -> Answer {
        let mut times = Box::<StageTimes>::default();
        let result = match self.0 {
            Work::Perceive { mut perception, image, odometer } => {
                let stamp = image.stamp();
                let image = times.measure(Stage::Decoding, || image.load());
                let perceived =
                    image.map(|image| perception.process(&image, *odometer, &mut times).map(Box::new));
                Outcome::Perceived { perception, stamp, perceived }
            }
            Work::Decide { mut decision_worker, around } => {
                let decision = decision_worker.step(&around.as_world_state(), &mut times);
                Outcome::Decided { decision_worker, decision, asked: around.now() }
            }
        };
        Answer { result, times }
    }
}

impl Answer {
    /// Worker of the result.
    pub fn worker(&self) -> Worker {
        match &self.result {
            Outcome::Perceived { .. } => Worker::Perception,
            Outcome::Decided { .. } => Worker::Decision,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_worker_has_a_name_in_files_and_old_names_are_read() {
        let read = |text: &str| serde_json::from_str::<Worker>(text).unwrap();
        for (worker, name, old) in [
            (Worker::Perception, r#""perception""#, r#""lookout""#),
            (Worker::Decision, r#""decision""#, r#""captain""#),
        ] {
            assert_eq!(serde_json::to_string(&worker).unwrap(), name);
            assert_eq!((read(name), read(old)), (worker, worker));
        }
        assert!(serde_json::from_str::<Worker>(r#""cook""#).is_err());
    }
}
