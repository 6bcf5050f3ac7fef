//! The robot drives onto its station, closed loop with noise.

use super::*;

/// The station of the tests at the east wall of the room: x out of its front.
const STATION: (f64, f64, f64) = (2.9, 0.4, PI);

fn station() -> Pose2 {
    Pose2::new(STATION.0, STATION.1, STATION.2)
}

fn room(start: Pose2) -> Scene {
    let scene = Scene::by_name("room", 1).unwrap();
    Scene { start, ..scene }.with_station(station()).unwrap()
}

fn plan(scene: Scene, seed: u64) -> DockPlan {
    let (robot, body) = robot_and_body(RangeSource::Laser).unwrap();
    DockPlan { scene, robot, body, mission: docking_alone().unwrap(), seed }
}

#[test]
fn it_docks_from_several_starts() {
    let starts = [(0.0, 0.0, 0.0), (-2.0, -2.0, 1.0), (1.5, 2.0, -2.0), (2.3, -1.5, 3.0)];
    for (seed, (x, y, theta)) in (1..).zip(starts) {
        let trial = dock(plan(room(Pose2::new(x, y, theta)), seed)).unwrap();
        let (lateral, heading) = (trial.lateral_error(), trial.heading_error().to_degrees());
        eprintln!(
            "start {seed}: {} after {:.0} s, {:.1} mm, {heading:.2} deg, x {:.3}, {} contacts",
            trial.state,
            trial.time,
            lateral * 1e3,
            trial.station_from_base.x,
            trial.contacts
        );
        if std::env::var_os("TRACE").is_some() {
            for m in trial.run.moments.iter().step_by(25) {
                let at = station().inverse() * m.pose;
                eprintln!(
                    "{:.1} {:.3} {:.3} {:.1} v {:.2} {:.2}",
                    m.time,
                    at.x,
                    at.y,
                    at.theta.to_degrees(),
                    m.twist.v,
                    m.twist.omega
                );
            }
            let e = trial.run.robot.station().map(|e| {
                (
                    Pose2::new(0.0, 0.0, 0.0),
                    e.lateral_sigma(0.18),
                    e.heading_sigma(),
                    (station().inverse() * Pose2::new(x, y, theta) * e.pose),
                )
            });
            eprintln!("{e:?}");
        }
    }
}
