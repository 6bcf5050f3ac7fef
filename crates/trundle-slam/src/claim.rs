use crate::relocalisation::is_same_place;
use trundle_core::Pose3;

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
    /// at another; how many times in a row now.
    pub fn note(noted: &mut Option<Self>, subject: T, found: Pose3, believed: Pose3) -> usize {
        let is_same = |claim: &Self| claim.subject == subject && is_same_place(claim.moved * believed, found);
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
        let mut say = |subject: u32, x: f64| Claim::note(&mut noted, subject, along(x), Pose3::identity());
        assert_eq!([say(1, 0.0), say(1, 0.1), say(1, 0.2), say(2, 0.2)], [1, 2, 3, 1]);
        assert_eq!([say(2, 0.3), say(2, 2.0), say(2, 2.0)], [2, 1, 2]);
    }

    #[test]
    fn what_is_said_is_compared_where_the_camera_is() {
        let pose = |x: f64, turned: f64| {
            Pose3::new(nalgebra::UnitQuaternion::from_scaled_axis(Vector3::z() * turned), Vector3::x() * x)
        };
        let mut noted = None;
        // Far from the origin, a turn that nobody told of moves it by metres there, and not here.
        assert_eq!(Claim::note(&mut noted, (), pose(20.0, 0.0), pose(21.0, 0.0)), 1);
        assert_eq!(Claim::note(&mut noted, (), pose(20.0, 0.1), pose(21.0, 0.0)), 2);
        // Told of, the camera goes on with what it is off by.
        assert_eq!(Claim::note(&mut noted, (), pose(22.0, 0.1), pose(23.0, 0.0)), 3);
        assert_eq!(Claim::note(&mut noted, (), pose(22.0, 0.1), pose(24.0, 0.0)), 1);
    }
}
