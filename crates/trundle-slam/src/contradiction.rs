use trundle_core::Stamp;

/// Tracked poses that contradict the wheels, one after the other.
///
/// Few points that agree with each other may do so by chance, all in one corner of a bare wall, unless they say so again and again.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Contradiction {
    since: Option<Stamp>,
}

/// So many points that agree are not all wrong.
const CONVINCING: usize = 100;
/// So long fewer must contradict the wheels before they are believed, too, s.
const STUBBORN: f64 = 0.3;

impl Contradiction {
    /// Whether the pose of a frame at `now` is to be believed, when so many points say it against the wheels.
    pub fn believes(&mut self, now: Stamp, against_wheels: Option<usize>) -> bool {
        let Some(points) = against_wheels else {
            self.since = None;
            return true;
        };
        points >= CONVINCING || now - *self.since.get_or_insert(now) >= STUBBORN
    }

    /// Whether the newest tracked pose is in doubt.
    pub fn is_going_on(&self) -> bool {
        self.since.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_points_are_believed_against_the_wheels_when_they_insist() {
        let at = |seconds: f64| Stamp::default().after(seconds);
        let mut contradiction = Contradiction::default();
        assert!(contradiction.believes(at(0.0), None) && !contradiction.is_going_on());
        assert!(!contradiction.believes(at(1.0), Some(99)) && contradiction.is_going_on());
        assert!(contradiction.believes(at(1.1), Some(100)), "many are believed at once");
        assert!(!contradiction.believes(at(1.2), Some(30)));
        assert!(contradiction.believes(at(1.3), Some(30)), "after 0.3 s");
        assert!(contradiction.believes(at(1.4), None), "they agree again");
        assert!(!contradiction.believes(at(9.0), Some(30)), "and it begins anew");
    }
}
