//! Trajectory, map and goal errors: pure functions from data to numbers.
//!
//! The definitions are those of the TUM RGB-D benchmark \[Sturm12\] in the PyPI tool `evo`, and agree with it to 1e-6 (proof in `tests/it`,
//! numbers in `data/evo`). They are absolute trajectory error after alignment \[Horn87, Umeyama91\], relative pose error over frames,
//! seconds or metres, and the error at the goal.
//!
//! For laser logs, whose reference is often known only in pieces: the relations metric of \[Kuemmerle09\] ([`relation_error`],
//! [`RelationSets`]). For maps: distances of occupied cells from the true ones, precision and recall ([`map_agreement`]).
//!
//! A trajectory is a slice of `(Stamp, Pose3)` whose stamps do not go back, each pose `world_from_body`.
//!
//! ```
//! use trundle_core::{Pose3, Stamp, Vector3};
//! use trundle_eval::{AbsoluteConfig, absolute_trajectory_error};
//!
//! let pose = |i: i64, x: f64| {
//!     let p = Vector3::new(x, (i * i) as f64, 0.0);
//!     (Stamp::from_nanos(i * 100_000_000), Pose3::new(Default::default(), p))
//! };
//! let truth: Vec<_> = (0..5).map(|i| pose(i, i as f64)).collect();
//! let moved: Vec<_> = (0..5).map(|i| pose(i, i as f64 + 7.0)).collect();
//! let error = absolute_trajectory_error(&truth, &moved, &AbsoluteConfig::default())?;
//! assert!(error.statistics.rmse < 1e-12); // an offset is not an error: the trajectories are aligned first
//! # Ok::<(), trundle_eval::EvalError>(())
//! ```

mod absolute;
mod align;
mod associate;
mod error;
mod goal;
mod map_agreement;
mod map_alignment;
mod occupied_cells;
mod pairs;
mod relation_sets;
mod relation_text;
mod relations;
mod relative;
mod statistics;

pub use absolute::{AbsoluteConfig, AbsoluteError, absolute_trajectory_error};
pub use align::{Alignment, Similarity, align};
pub use associate::associate;
pub use error::{EvalError, Side};
pub use goal::{GoalError, goal_error};
pub use map_agreement::{MapAgreement, MapAgreementConfig, map_agreement};
pub use map_alignment::align_maps;
pub use pairs::{Delta, DeltaUnit};
pub use relation_sets::{RelationSets, RelationSetsConfig};
pub use relation_text::{RelationTextError, relations_from_text, relations_text};
pub use relations::{Relation, RelationConfig, RelationError, relation_error};
pub use relative::{RelativeConfig, RelativeError, relative_pose_error};
pub use statistics::ErrorStatistics;
