//! Cases of the golden net: a list of cases, each with its commands and the quantities that are hashed.

use super::digest::Quantity;

/// A case: commands of `trundle` in order, and the compared parts of their outputs.
pub struct Case {
    /// The case's name, first part of each of its keys in the golden file.
    pub name: &'static str,
    /// Input outside the repository, relative to the workspace, without which the case is skipped by name.
    pub needs: Option<&'static str>,
    /// Command lines; `{out}` is the case's folder, `{data}` is `data/golden`, `{shared}` is `../shared/data`.
    pub commands: &'static [&'static str],
    /// Label, kind and file (relative to the case's folder) of each compared output.
    pub outputs: &'static [(&'static str, Quantity, &'static str)],
}

use Quantity::{File, Folder, Topic};

/// Twists, poses and grid of a robot's run in folder `run`.
const RUN: &[(&str, Quantity, &str)] = &[
    ("twists", Topic("/twist"), "run/recording.mcap"),
    ("estimates", Topic("/pose"), "run/recording.mcap"),
    ("trajectories", Topic("/trajectory"), "run/recording.mcap"),
    ("poses", File, "run/trajectory.txt"),
    ("grid", File, "run/map.pgm"),
];

/// All cases; the slowest come first, which lets two threads end at about the same time.
pub const CASES: &[Case] = &[
    Case { name: "demo-direct", needs: None, commands: &["demo --direct --out {out}/run"], outputs: RUN },
    Case {
        name: "demo-explore-60s",
        needs: None,
        commands: &["demo --config {data}/small_camera.toml --time-limit 60 --out {out}/run"],
        outputs: RUN,
    },
    Case {
        name: "house-60s",
        needs: None,
        commands: &["demo --scene house --config {data}/small_camera.toml --time-limit 60 --out {out}/run"],
        outputs: RUN,
    },
    Case {
        name: "demo-faults",
        needs: None,
        commands: &[
            "demo --direct --config {data}/small_camera.toml --faults {data}/faults.toml --time-limit 60 --out {out}/run",
        ],
        outputs: RUN,
    },
    Case {
        name: "demo-person",
        needs: None,
        commands: &[
            "demo --direct --scene {data}/person.toml --config {data}/small_camera.toml --time-limit 60 --out {out}/run",
        ],
        outputs: RUN,
    },
    Case {
        name: "demo-resumed",
        needs: None,
        commands: &[
            "demo --direct --config {data}/small_camera.toml --time-limit 14 --memory {out}/memory --out {out}/before",
            "demo --config {data}/small_camera.toml --memory {out}/memory --wake 1.6,1.4,30 --time-limit 30 --out {out}/run",
        ],
        outputs: RUN,
    },
    Case {
        name: "real-time-marks",
        needs: None,
        commands: &["replay {data}/real_time.mcap --out {out}/run"],
        outputs: RUN,
    },
    Case {
        name: "laser-robot",
        needs: Some("../shared/data/nav/barn"),
        commands: &["experiment barn --worlds 12-13 --data {shared}/nav/barn --out {out}/barn"],
        outputs: &[("runs", File, "barn/barn.csv")],
    },
    Case {
        name: "tum-folder",
        needs: None,
        commands: &[
            "sim room --drive {data}/twists.txt --duration 8 --rate 15 --record {out}/recorded",
            "slam {out}/recorded --height 0.45 --tilt 8 --out {out}/slam",
            "slam {out}/recorded --frames 40 --map {out}/slam/visual.map --localise --out {out}/located",
        ],
        outputs: &[
            ("images", Folder, "recorded/rgb"),
            ("depths", Folder, "recorded/depth"),
            ("odometry", File, "recorded/odometry.txt"),
            ("truth", File, "recorded/groundtruth.txt"),
            ("poses", File, "slam/trajectory.txt"),
            ("grid", File, "slam/map.pgm"),
            ("visual-map", File, "slam/visual.map"),
            ("located", File, "located/trajectory.txt"),
        ],
    },
    Case {
        name: "laser-log",
        needs: None,
        commands: &[
            "sim office --drive {data}/twists.txt --duration 16 --rate 1 --laser urg-04lx --record {out}/recorded",
            "map {out}/recorded/laser.log --out {out}/map",
        ],
        outputs: &[
            ("log", File, "recorded/laser.log"),
            ("poses", File, "map/trajectory.txt"),
            ("grid", File, "map/map.pgm"),
            ("saved-filter", File, "map/filter.map"),
        ],
    },
    Case {
        name: "laser-log-real",
        needs: Some("../shared/data/laser/sena.log"),
        commands: &["map {shared}/laser/sena.log --out {out}/map"],
        outputs: &[("poses", File, "map/trajectory.txt"), ("grid", File, "map/map.pgm")],
    },
    Case {
        name: "plans",
        needs: None,
        commands: &[
            "sim demo --map {out}/demo.yaml",
            "sim house --map {out}/house.yaml",
            "plan {out}/demo.yaml --from=1.2,1.1,20 --goal=7,4.7,0 --out {out}/demo",
            "plan {out}/demo.yaml --from=1.2,1.1,20 --goal=6,3,90 --near --out {out}/near",
            "plan {out}/house.yaml --from=0.7,4.4,0 --goal=7.4,6.4,90 --out {out}/house",
        ],
        outputs: &[
            ("true-grid", File, "demo.pgm"),
            ("way-points", File, "demo/waypoints.csv"),
            ("curve", File, "demo/curve.csv"),
            ("trajectory", File, "demo/trajectory.csv"),
            ("near-trajectory", File, "near/trajectory.csv"),
            ("house-curve", File, "house/curve.csv"),
            ("house-trajectory", File, "house/trajectory.csv"),
        ],
    },
    Case {
        name: "docks",
        needs: None,
        commands: &[
            "sim demo --map {out}/demo.yaml",
            "dock {out}/demo.yaml --from 1.2,1.1,20 --to 1.5,1.15,0 --out {out}/on-map",
            "dock hong24-b --out {out}/optimal",
            "dock hong24-b --method paper --out {out}/paper",
        ],
        outputs: &[
            ("on-map", File, "on-map/steps.csv"),
            ("optimal", File, "optimal/steps.csv"),
            ("paper", File, "paper/steps.csv"),
        ],
    },
    Case {
        name: "corridor",
        needs: None,
        commands: &["experiment corridor --out {out}/corridor"],
        outputs: &[
            ("a-optimal", File, "corridor/a-optimal.csv"),
            ("a-paper", File, "corridor/a-paper.csv"),
            ("b-optimal", File, "corridor/b-optimal.csv"),
            ("b-paper", File, "corridor/b-paper.csv"),
            ("c-optimal", File, "corridor/c-optimal.csv"),
            ("c-paper", File, "corridor/c-paper.csv"),
            ("d-optimal", File, "corridor/d-optimal.csv"),
            ("d-paper", File, "corridor/d-paper.csv"),
        ],
    },
];
