//! Trajectories of the ancestry against plain copies of lists.

use crate::rbpf::ancestry::Ancestry;
use proptest::prelude::*;
use trundle_core::{Pose2, Stamp};

type Trajectory = Vec<(Stamp, Pose2)>;

/// An ancestry and the plain trajectory of each particle after the same steps; each step gives the parents of the particles.
fn run(steps: &[Vec<u16>]) -> (Ancestry, Vec<Trajectory>) {
    let count = steps[0].len();
    let (mut ancestry, mut plain) = (Ancestry::default(), vec![Trajectory::new(); count]);
    for (k, parents) in steps.iter().enumerate() {
        let stamp = Stamp::from_nanos(k as i64);
        let pose = |i: usize| Pose2::new(k as f64, i as f64, 0.01 * (k + i) as f64);
        ancestry.push(stamp, (0..count).map(pose), parents);
        let next = |(i, parent): (usize, &u16)| {
            let mut trajectory = if k == 0 { Vec::new() } else { plain[usize::from(*parent)].clone() };
            trajectory.push((stamp, pose(i)));
            trajectory
        };
        plain = parents.iter().enumerate().map(next).collect();
    }
    (ancestry, plain)
}

/// Parents of four particles over many steps; most steps resample nothing.
fn any_steps() -> impl Strategy<Value = Vec<Vec<u16>>> {
    let step = prop_oneof![
        4 => Just(vec![0, 1, 2, 3]),
        1 => prop::collection::vec(0..4_u16, 4),
        1 => (0..4_u16).prop_map(|parent| vec![parent; 4]),
    ];
    prop::collection::vec(step, 1..200)
}

proptest! {
    #[test]
    fn every_particle_has_the_trajectory_of_its_ancestors(steps in any_steps()) {
        let (ancestry, plain) = run(&steps);
        prop_assert_eq!(ancestry.len(), steps.len());
        for (i, trajectory) in plain.iter().enumerate() {
            prop_assert_eq!(&ancestry.trajectory(i), trajectory);
        }
    }

    #[test]
    fn thinning_drops_every_second_pose_of_the_first_ones_of_all_particles(
        steps in any_steps(), part in 0.0..1.0_f64,
    ) {
        let (mut ancestry, plain) = run(&steps);
        let count = (part * steps.len() as f64) as usize;
        ancestry.thin(&crate::loop_closing::scan_history::every_second(ancestry.len(), count));
        for (i, trajectory) in plain.iter().enumerate() {
            let stays = |(k, _): &(usize, &(Stamp, Pose2))| k % 2 == 0 || k + 1 >= count;
            let expected: Trajectory =
                trajectory.iter().enumerate().filter(stays).map(|(_, pose)| *pose).collect();
            prop_assert_eq!(&ancestry.trajectory(i), &expected);
            prop_assert_eq!(ancestry.len(), expected.len());
        }
    }

    #[test]
    fn a_replaced_trajectory_is_that_of_all_particles(steps in any_steps(), particle in 0..4_usize) {
        let (mut ancestry, plain) = run(&steps);
        ancestry.replace(plain[particle].clone());
        ancestry.push(Stamp::from_nanos(1_000), (0..4).map(|i| Pose2::new(9.0, f64::from(i), 0.0)), &[0; 4]);
        for i in 0..4 {
            let mut expected = plain[particle].clone();
            expected.push((Stamp::from_nanos(1_000), Pose2::new(9.0, i as f64, 0.0)));
            prop_assert_eq!(ancestry.trajectory(i), expected);
        }
    }
}

#[test]
fn memory_of_a_common_past_does_not_grow_with_the_particles() {
    let steps = |particles: u16| -> Vec<Vec<u16>> {
        (0..1_000_u16)
            .map(|k| if k % 10 == 9 { vec![0; usize::from(particles)] } else { (0..particles).collect() })
            .collect()
    };
    let (few, many) = (run(&steps(2)).0.bytes(), run(&steps(40)).0.bytes());
    assert!(many < few + 64 * 2 * 40 * 40, "{many} bytes of 40 particles, {few} bytes of 2");
}
