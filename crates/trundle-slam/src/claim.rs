use crate::motion::{FASTEST_CAMERA, is_within};
use trundle_core::Pose3;

/// What is said twice may differ by so much: m, and rad.
const APART: f64 = 0.3;

/// Something that must be said several times in a row before it is believed \[MurArtal17\]: that poses are off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Claim<T> {
    /// About what.
    subject: T,
    /// What believed poses would have to be moved by, on the left.
    moved: Pose3,
    /// How many times in a row.
    times: usize,
}

impl<T: PartialEq> Claim<T> {
    /// Takes note that it is said again, or something else for the first time, of a camera that was found at one pose and believed
    /// at another, and that nobody has told about for so long, s, since it was said; how many times in a row now.
    pub fn note(
        noted: &mut Option<Self>,
        subject: T,
        (found, believed): (Pose3, Pose3),
        untold: f64,
    ) -> usize {
        let is_near = |expected: Pose3| is_within(expected.inverse() * found, APART, FASTEST_CAMERA, untold);
        let is_same = |claim: &Self| claim.subject == subject && is_near(claim.moved * believed);
        let times = 1 + noted.take().filter(is_same).map_or(0, |claim| claim.times);
        *noted = Some(Self { subject, moved: found * believed.inverse(), times });
        times
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector3;

    #[test]
    fn only_the_same_said_in_a_row_counts() {
        let mut noted = None;
        let along = |x: f64| Pose3::new(nalgebra::UnitQuaternion::identity(), Vector3::x() * x);
        let mut say =
            |subject: u32, x: f64| Claim::note(&mut noted, subject, (along(x), Pose3::identity()), 0.0);
        assert_eq!([say(1, 0.0), say(1, 0.1), say(1, 0.2), say(2, 0.2)], [1, 2, 3, 1]);
        assert_eq!([say(2, 0.3), say(2, 2.0), say(2, 2.0)], [2, 1, 2]);
    }

    #[test]
    fn nobody_knows_how_far_a_camera_went_that_nobody_told_about() {
        let at = |x: f64| Pose3::new(nalgebra::UnitQuaternion::identity(), Vector3::x() * x);
        let again = |x: f64, untold: f64| {
            let mut noted = None;
            Claim::note(&mut noted, (), (at(0.0), at(5.0)), 0.0);
            Claim::note(&mut noted, (), (at(x), at(5.0)), untold)
        };
        assert_eq!([again(0.6, 0.0), again(0.6, 0.2), again(2.4, 0.2), again(2.2, 1.0)], [1, 2, 1, 2]);
    }

    #[test]
    fn what_is_said_is_compared_where_the_camera_is() {
        let pose = |x: f64, turned: f64| {
            Pose3::new(nalgebra::UnitQuaternion::from_scaled_axis(Vector3::z() * turned), Vector3::x() * x)
        };
        let mut noted = None;
        let mut say = |found: Pose3, believed: Pose3| Claim::note(&mut noted, (), (found, believed), 0.0);
        // Far from the origin, a turn that nobody told of moves it by metres there, and not here.
        assert_eq!(say(pose(20.0, 0.0), pose(21.0, 0.0)), 1);
        assert_eq!(say(pose(20.0, 0.1), pose(21.0, 0.0)), 2);
        // Told of, the camera goes on with what it is off by.
        assert_eq!(say(pose(22.0, 0.1), pose(23.0, 0.0)), 3);
        assert_eq!(say(pose(22.0, 0.1), pose(24.0, 0.0)), 1);
    }
}
