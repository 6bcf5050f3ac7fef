//! `trundle eval trajectory`: absolute and relative errors of a trajectory.

use super::args::{AlignArg, DeltaUnit, TrajectoryArgs};
use super::named_error::named_error;
use crate::outcome::Outcome;
use crate::{console, logging};
use trundle::app::AppError;
use trundle::app::evaluation::{TrajectoryEvaluation, unrounded_trajectory, write_evaluation};
use trundle::eval::{AbsoluteConfig, Alignment, Delta, RelativeConfig};

/// `trundle eval trajectory`.
pub fn run(args: &TrajectoryArgs) -> Result<Outcome, AppError> {
    let (reference, estimate) =
        (unrounded_trajectory(&args.reference)?, unrounded_trajectory(&args.estimate)?);
    let found = TrajectoryEvaluation::of(&reference, &estimate, &args.absolute(), &args.relative()?)
        .map_err(|error| named_error(&error, &args.reference, &args.estimate))?;
    let place = match &args.out {
        Some(out) => {
            let subtitle = format!("{} against {}.", args.estimate.display(), args.reference.display());
            Some(write_evaluation(&found, &subtitle, logging::output_folder(out)?)?.join("report.html"))
        }
        None => None,
    };
    if !args.common.quiet {
        console::print_table(&found.rows());
        place.iter().for_each(|place| console::print(&format!("See {}", place.display())));
    }
    Ok(Outcome::Reached)
}

impl TrajectoryArgs {
    fn absolute(&self) -> AbsoluteConfig {
        let alignment = match self.align {
            AlignArg::Se3 => Alignment::Rigid,
            AlignArg::Sim3 => Alignment::Similarity,
            AlignArg::None => Alignment::None,
        };
        AbsoluteConfig { max_difference: self.max_difference, alignment }
    }

    fn relative(&self) -> Result<RelativeConfig, AppError> {
        let delta = match self.unit {
            DeltaUnit::Frames if self.delta.fract() == 0.0 && (1.0..1e9).contains(&self.delta) => {
                Delta::Frames(self.delta as usize)
            }
            DeltaUnit::Frames => {
                let problem = format!("--delta is {} frames, expected a whole number from 1 on", self.delta);
                return Err(AppError::Input(problem));
            }
            DeltaUnit::S => Delta::Seconds(self.delta),
            DeltaUnit::M => Delta::Metres(self.delta),
        };
        Ok(RelativeConfig { max_difference: self.max_difference, delta, all_pairs: self.all_pairs }
            .validated()?)
    }
}
