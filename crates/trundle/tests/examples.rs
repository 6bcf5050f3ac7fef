//! Every numbered example runs.

#![allow(clippy::print_stdout, reason = "the examples are programs with output")]

macro_rules! examples {
    ($($name:ident: $file:literal),* $(,)?) => {
        $(
            #[path = $file]
            mod $name;

            #[test]
            fn $name() {
                $name::main().unwrap();
            }
        )*
    };
}

examples! {
    slam_a_folder: "../examples/01_slam_a_folder.rs",
    map_a_laser_log: "../examples/02_map_a_laser_log.rs",
    plan_on_a_map: "../examples/03_plan_on_a_map.rs",
    dock_in_a_tight_place: "../examples/04_dock_in_a_tight_place.rs",
    drive_in_the_simulator: "../examples/05_drive_in_the_simulator.rs",
    explore: "../examples/06_explore.rs",
    replay_a_recording: "../examples/07_replay_a_recording.rs",
    your_own_robot: "../examples/08_your_own_robot.rs",
}
