use crate::{
    captain::{Around, Captain},
    lazy_image::LazyImage,
    lookout::{Lookout, Sighting},
    navigator::Decision,
    stage::{Stage, StageTimes},
};
use serde::{Deserialize, Serialize};
use trundle_core::Stamp;
use trundle_localization::OdometryState;

/// Whose work it is. Each does one job at a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Helper {
    /// Looks at an image: camera pose and scan.
    Lookout,
    /// Decides what may take long: plans, frontiers, turns and straight moves.
    Captain,
}

impl Helper {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Lookout, Self::Captain];
}

/// Work that takes longer than a control step has time. It bears all that it needs: run it where you like, then give the
/// answer to [`crate::Robot::take_up`].
#[derive(Debug)]
pub struct Job(pub(crate) Work);

#[derive(Debug)]
pub(crate) enum Work {
    Look { lookout: Box<Lookout>, image: LazyImage, odometer: Box<OdometryState> },
    Decide { captain: Box<Captain>, around: Box<Around> },
}

/// What a job came to.
#[derive(Debug)]
pub struct Answer {
    pub(crate) result: Outcome,
    pub(crate) times: Box<StageTimes>,
}

#[derive(Debug)]
pub(crate) enum Outcome {
    Looked {
        lookout: Box<Lookout>,
        /// Of the image.
        stamp: Stamp,
        /// None: a frozen camera's; an error: no image.
        sighting: Result<Option<Box<Sighting>>, String>,
    },
    Decided {
        captain: Box<Captain>,
        decision: Decision,
        asked: Stamp,
    },
}

impl Job {
    /// Whose it is.
    pub fn helper(&self) -> Helper {
        match &self.0 {
            Work::Look { .. } => Helper::Lookout,
            Work::Decide { .. } => Helper::Captain,
        }
    }

    /// Does the work.
    pub fn run(self) -> Answer {
        let mut times = Box::<StageTimes>::default();
        let result = match self.0 {
            Work::Look { mut lookout, image, odometer } => {
                let stamp = image.stamp();
                let image = times.measure(Stage::Decoding, || image.load());
                let sighting = image.map(|image| lookout.look(&image, *odometer, &mut times).map(Box::new));
                Outcome::Looked { lookout, stamp, sighting }
            }
            Work::Decide { mut captain, around } => {
                let decision = captain.step(&around.surroundings(), &mut times);
                Outcome::Decided { captain, decision, asked: around.now() }
            }
        };
        Answer { result, times }
    }
}

impl Answer {
    /// Whose it is.
    pub fn helper(&self) -> Helper {
        match &self.result {
            Outcome::Looked { .. } => Helper::Lookout,
            Outcome::Decided { .. } => Helper::Captain,
        }
    }
}
