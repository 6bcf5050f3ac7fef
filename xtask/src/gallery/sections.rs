//! Sections of the gallery: texts, pictures and tables.

use crate::results::model::{Figure, Measurement};
use crate::results::page::{peer_cells, row, value_text};
use std::fmt::Write;

/// A section of the page.
pub struct Section {
    pub title: &'static str,
    pub text: &'static str,
    /// File below `docs/pictures`, and its caption.
    pub pictures: &'static [(&'static str, &'static str)],
    /// Names of the measurements that it shows.
    pub measurements: &'static [&'static str],
    /// The table of a measurement.
    pub table: fn(&Measurement) -> String,
}

/// The page, in order.
pub const SECTIONS: &[Section] = &[
    Section {
        title: "Point stabilisation of [Li18]",
        text: "The robot drives from each of eight start poses onto one goal pose, from an empty map and without ground truth. The paper's
figures are those of a real robot; trundle's come from the simulated Kobuki with a Kinect V2 and their noise.",
        pictures: &[
            ("poses.png", "Paths of seed 1 from the eight start poses: planned and driven, as figure 5 of the paper"),
            ("gallery/li18.svg", "Errors at the goal, beside the paper's"),
        ],
        measurements: &["poses"],
        table: figures,
    },
    Section {
        title: "Room with obstacles, as in [Li18]",
        text: "The robot crosses a room that it does not know, and maps it during the drive. The paper shows a smooth crossing without
contact and gives no figure.",
        pictures: &[("gallery/obstacles.png", "The crossing of seed 1: the robot's map and the driven path")],
        measurements: &["obstacles"],
        table: figures,
    },
    Section {
        title: "Fine positioning of [Hong24]",
        text: "The paper gives the motions of four corridor scenarios and no times. The peer is the paper's method as implemented here, with
the same speeds; its motions are those of the paper in all four. Scenario c has the time of scenario a: its box is out of reach.
The 5,000 and 500 random corridors are those of [the corridor benchmark](corridor-benchmark.md).",
        pictures: &[
            ("docking-scenarios.png", "The four scenarios: the paper's method above, the optimal one below"),
            ("gallery/hong24.svg", "Time of the manoeuvre in each scenario"),
        ],
        measurements: &["corridor", "docking", "docking-closed-loop"],
        table: figures,
    },
    Section {
        title: "BARN",
        text: "The robot crosses 250 worlds of cylinders [Perille20] at up to 2 m/s with a 2-D laser, from an empty map. The score of a run is
OT / clip(AT, 2 OT, 8 OT), or 0 without arrival or with a contact: AT is the time taken, OT the time of the shortest path at full speed.
The best possible score is 0.5.

The published scores are those of the simulation leaderboard of the BARN Challenge 2024 [Xiao24]. **They are not of the same run:** the
challenge uses 50 other worlds, ten trials each, and the Gazebo simulator with a Jackal. trundle's runs use its own simulator and the 250
published worlds.",
        pictures: &[
            ("gallery/barn.png", "World 150 of the 250: cylinders, the robot's map and the driven path; a run ends within 1 m of the goal, as in the challenge"),
            ("gallery/barn.svg", "Mean scores: trundle in its own simulator, the others as published"),
        ],
        measurements: &["barn"],
        table: figures,
    },
    Section {
        title: "MRPB 1.0",
        text: "The benchmark [Wen21] has courses with and without people for local planners with a 2-D laser. No published figure was found for
goals reached or contacts. trundle's runs use its own simulator, with the benchmark's maps where it has them.",
        pictures: &[("gallery/mrpb.png", "Second course of room02: the robot's map and the driven path")],
        measurements: &["mrpb"],
        table: figures,
    },
    Section {
        title: "Enter another planner",
        text: "A planner enters [the corridor benchmark](corridor-benchmark.md#other-programs) as a program that reads a problem on standard
input and writes its motions on standard output. One command runs and evaluates it:

```sh tested in=clone
cargo run --release -p trundle-docking --example corridor_bench -- --problems 10 --planner bench/docking/entry_example.py
```

That entry is an example of 20 lines. `--problems 5000` are the problems of the figures above.",
        pictures: &[],
        measurements: &[],
        table: figures,
    },
    Section {
        title: "SLAM on degraded images",
        text: "Both programs track the same degraded copies of freiburg1_rpy [Sturm12], on one core. The error is the ATE RMSE of the located
images. A case counts as lost, with the error \"none\", if the compared trajectory has fewer than 0.9 of the images; the curves leave it
out. 0 % located means that a program wrote no trajectory. ORB-SLAM3 [Campos21] is not deterministic: its figures are the median of three
runs. `bench/slam/degradation.py` describes the degradations.",
        pictures: &[
            ("gallery/slam-rate.svg", "Error over the rate of the images"),
            ("gallery/slam-blur.svg", "Error over blur"),
            ("gallery/slam-depth.svg", "Error over the share of missing depth"),
            ("gallery/slam-photo.svg", "Error over the share of the image that a moving photo covers, logarithmic"),
        ],
        measurements: &["slam-degradation"],
        table: cases,
    },
    Section {
        title: "Cost of each stage of the robot",
        text: "The demo explores a room, drives to a goal and returns, with images at 15 Hz and wheels at 50 Hz. The share of a core is the wall
time of all runs of a stage over the simulated time of the drive. The simulator's own time is not included.",
        pictures: &[("gallery/stages.svg", "Share of a core of each stage")],
        measurements: &["robot-stages"],
        table: stages,
    },
];

/// A row for each figure, and one for each further peer.
fn figures(measurement: &Measurement) -> String {
    let mut table =
        format!("\n| {} | trundle | goal | peer | ratio |\n|---|---|---|---|---|\n", measurement.title);
    for figure in &measurement.figures {
        table.push_str(&row(&figure.name, figure));
        for (peer, ratio) in figure.more_peers.iter().map(|peer| peer_cells(figure, peer)) {
            let _ = writeln!(table, "|  |  |  | {peer} | {ratio} |");
        }
    }
    table
}

/// Figures of several quantities of one thing, named `THING: QUANTITY`, one row a thing.
fn by_thing(measurement: &Measurement) -> Vec<(&str, Vec<&Figure>)> {
    let mut things: Vec<(&str, Vec<&Figure>)> = Vec::new();
    for figure in &measurement.figures {
        let Some((thing, _)) = figure.name.rsplit_once(": ") else { continue };
        match things.last_mut() {
            Some((last, figures)) if *last == thing => figures.push(figure),
            _ => things.push((thing, vec![figure])),
        }
    }
    things
}

/// The degradations: error and located images of both programs; then the figures of the whole.
fn cases(measurement: &Measurement) -> String {
    let mut table =
        "\n| case | error | ORB-SLAM3 | ratio | located | ORB-SLAM3 |\n|---|---|---|---|---|---|\n"
            .to_owned();
    for (case, figures) in by_thing(measurement) {
        let peer = |f: &Figure| f.peer.as_ref().map_or(String::new(), |peer| value_text(peer.value, &f.unit));
        let ratio = figures[0].ratio().map_or(String::new(), |ratio| format!("{ratio:.1}"));
        let pair = |f: &&Figure| (value_text(f.value, &f.unit), peer(f));
        let cells: Vec<(String, String)> = figures.iter().map(pair).collect();
        let located = cells.get(1).cloned().unwrap_or_default();
        let _ = writeln!(
            table,
            "| {case} | {} | {} | {ratio} | {} | {} |",
            cells[0].0, cells[0].1, located.0, located.1
        );
    }
    let whole = Measurement {
        figures: measurement.figures.iter().filter(|figure| !figure.name.contains(": ")).cloned().collect(),
        ..measurement.clone()
    };
    table + &figures(&whole)
}

/// The stages with all their figures, and the sum of their shares.
fn stages(measurement: &Measurement) -> String {
    let mut table = "\n| stage | share of a core | median | p99 |\n|---|---|---|---|\n".to_owned();
    let mut sum = 0.0;
    for (stage, figures) in by_thing(measurement) {
        let cells: Vec<String> = figures.iter().map(|f| value_text(f.value, &f.unit)).collect();
        let _ = writeln!(table, "| {stage} | {} |", cells.join(" | "));
        sum += figures[0].value;
    }
    let _ = writeln!(table, "| all | {sum:.1} % |  |  |");
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measurement(figures: &str) -> Measurement {
        let text = format!(
            r#"{{"subject": "S", "title": "T", "command": "c", "commit": "a", "machine": "m", "date": "d", "figures": [{figures}]}}"#
        );
        serde_json::from_str(&text).unwrap()
    }

    #[test]
    fn further_peers_have_rows_of_their_own() {
        let figure = r#"{"name": "score", "value": 0.5, "unit": "", "goal": {"at_least": 0.45}, "peer": {"name": "A", "value": 0.4},
            "more_peers": [{"name": "B", "value": 0.25}]}"#;
        let table = figures(&measurement(figure));
        assert!(
            table.contains("| score | 0.5 | at least 0.45 | 0.4 A * | 1.2 |\n|  |  |  | 0.25 B * | 2.0 |\n"),
            "{table}"
        );
    }

    #[test]
    fn a_case_has_one_row_and_a_lost_one_no_error() {
        let figures = r#"{"name": "a: b: error", "value": null, "detail": true, "unit": "cm", "better": "less",
              "peer": {"name": "P", "value": 2, "same_run": true}},
            {"name": "a: b: located", "value": 60, "detail": true, "unit": "%", "peer": {"name": "P", "value": 100, "same_run": true}},
            {"name": "lost", "value": 1, "unit": ""}"#;
        let table = cases(&measurement(figures));
        assert!(
            table.contains("| a: b | none | 2 cm |  | 60 % | 100 % |\n") && table.contains("| lost | 1 |"),
            "{table}"
        );
    }

    #[test]
    fn the_shares_of_the_stages_add_up() {
        let share = |name: &str, value: f64| {
            format!(r#"{{"name": "{name}: share of a core", "value": {value}, "detail": true, "unit": "%"}}"#)
        };
        let table = stages(&measurement(&[share("slam", 50.0), share("scan", 6.5)].join(",")));
        assert!(table.contains("| slam | 50 % |\n") && table.contains("| all | 56.5 % |"), "{table}");
    }
}
