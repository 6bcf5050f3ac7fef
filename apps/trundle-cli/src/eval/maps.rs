//! `trundle eval map`: the occupied cells of a map against those of the true map.

use super::args::MapsArgs;
use super::named_error::named_error;
use crate::outcome::Outcome;
use crate::{console, logging};
use trundle::app::{AppError, read_two_maps};
use trundle::core::Pose2;
use trundle::eval::{EvalError, MapAgreement, MapAgreementConfig, align_maps, map_agreement};
use trundle::io::Summary;

/// `trundle eval map`.
pub fn run(args: &MapsArgs) -> Result<Outcome, AppError> {
    let [truth, map] = read_two_maps([&args.truth, &args.map])?;
    let config = MapAgreementConfig { within: args.within, ..MapAgreementConfig::default() };
    let config = config.validated()?;
    let wrong = |error: EvalError| named_error(&error, &args.truth, &args.map);
    let pose = if args.exact { args.at.0 } else { align_maps(&truth, &map, args.at.0).map_err(wrong)? };
    let found = map_agreement(&truth, &map, pose, &config).map_err(wrong)?;
    if let Some(out) = &args.out {
        let folder = logging::output_folder(out)?;
        folder.write("summary.json", summary(&found, pose, args.within).to_json().as_bytes())?;
        folder.commit()?;
    }
    if !args.common.quiet {
        console::print_table(&rows(&found, pose, args.within));
    }
    Ok(Outcome::Reached)
}

fn rows(found: &MapAgreement, pose: Pose2, within: f64) -> Vec<Vec<String>> {
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let percent = |part: f64| format!("{:.1} %", part * 100.0);
    let cm = |metres: f64| format!("{:.1} cm", metres * 100.0);
    vec![
        row(
            "the map lies at",
            format!("{:.3} m, {:.3} m, {:.2} deg", pose.x, pose.y, pose.theta.to_degrees()),
        ),
        row("occupied cells", found.to_truth.count.to_string()),
        row(&format!("of these within {} of a true one", cm(within)), percent(found.precision)),
        row(
            "their distance: mean, largest",
            format!("{}, {}", cm(found.to_truth.mean), cm(found.to_truth.max)),
        ),
        row(
            "true surface cells there to be seen",
            format!("{} of {}", found.from_truth.count, found.surface_cells),
        ),
        row(&format!("of these within {} of one of the map", cm(within)), percent(found.recall)),
        row("free cells inside what is truly occupied", percent(found.cleared)),
    ]
}

fn summary(found: &MapAgreement, pose: Pose2, within: f64) -> Summary {
    let mut summary = Summary::new("eval map");
    summary
        .set("success", true)
        .set("x_m", pose.x)
        .set("y_m", pose.y)
        .set("heading_deg", pose.theta.to_degrees())
        .set("within_m", within)
        .set("precision", found.precision)
        .set("recall", found.recall)
        .set("cleared", found.cleared)
        .set("to_truth_m", found.to_truth)
        .set("from_truth_m", found.from_truth)
        .set("surface_cells", found.surface_cells);
    summary
}
