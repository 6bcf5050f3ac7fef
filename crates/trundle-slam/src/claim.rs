use crate::relocalisation::is_same_place;
use trundle_core::Pose3;

/// Something that must be said several times in a row before it is believed \[MurArtal17\]: that poses are off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Claim<T> {
    /// About what.
    subject: T,
    /// What the poses would have to be moved by, on the left.
    moved: Pose3,
    /// How many times in a row.
    times: usize,
}

impl<T: PartialEq> Claim<T> {
    /// Takes note that it is said again, or something else for the first time; how many times in a row now.
    pub fn note(noted: &mut Option<Self>, subject: T, moved: Pose3) -> usize {
        let is_same = |claim: &Self| claim.subject == subject && is_same_place(claim.moved, moved);
        let times = 1 + noted.take().filter(is_same).map_or(0, |claim| claim.times);
        *noted = Some(Self { subject, moved, times });
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
        let mut say = |subject: u32, x: f64| Claim::note(&mut noted, subject, along(x));
        assert_eq!([say(1, 0.0), say(1, 0.1), say(1, 0.2), say(2, 0.2)], [1, 2, 3, 1]);
        assert_eq!([say(2, 0.3), say(2, 2.0), say(2, 2.0)], [2, 1, 2]);
    }
}
