//! Best pose of a scan in a map or a part of it: correlative search by branch and bound (\[Hess16\], \[Olson09\]).

mod lookup_budget;
mod pyramid;
mod search;

pub(crate) use lookup_budget::LookupBudget;
pub(crate) use pyramid::Pyramid;
pub(crate) use search::{FoundPose, Query};
