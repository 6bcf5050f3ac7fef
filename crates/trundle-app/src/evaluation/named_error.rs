//! Errors of an evaluation with the name of the file that they concern.

use crate::AppError;
use std::path::Path;
use trundle_eval::{EvalError, Side};

/// The error with the name of the file that it concerns, or of both.
pub fn named_error(error: &EvalError, reference: &Path, estimate: &Path) -> AppError {
    let (reference, estimate) = (reference.display(), estimate.display());
    AppError::Input(match error.side() {
        Some(Side::Reference) => format!("{reference}: {error}"),
        Some(Side::Estimate) => format!("{estimate}: {error}"),
        None => format!("{estimate} against {reference}: {error}"),
    })
}
