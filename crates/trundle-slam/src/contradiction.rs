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
    /// Whether the pose of a frame at `now`, by so many points that agree, is to be believed.
    pub fn believes(&mut self, now: Stamp, contradicts: bool, inliers: usize) -> bool {
        if !contradicts {
            self.since = None;
            return true;
        }
        inliers >= CONVINCING || now - *self.since.get_or_insert(now) >= STUBBORN
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
        assert!(contradiction.believes(at(0.0), false, 30) && !contradiction.is_going_on());
        assert!(!contradiction.believes(at(1.0), true, 99) && contradiction.is_going_on());
        assert!(contradiction.believes(at(1.1), true, 100), "many are believed at once");
        assert!(!contradiction.believes(at(1.2), true, 30));
        assert!(contradiction.believes(at(1.3), true, 30), "after 0.3 s");
        assert!(contradiction.believes(at(1.4), false, 30), "they agree again");
        assert!(!contradiction.believes(at(9.0), true, 30), "and it begins anew");
    }
}
