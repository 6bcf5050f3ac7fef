//! Why a list of poses covers none of some images.

use trundle_core::Stamp;

/// The reason why `poses` give none between the first and the last of some images: no pose, another clock, or gaps. `max_gap`: time
/// between two usable poses, s.
pub fn why_uncovered<T>(poses: &[(Stamp, T)], (first, last): (Stamp, Stamp), max_gap: f64) -> String {
    let Some(((from, _), (to, _))) = poses.first().zip(poses.last()) else {
        return "it holds no pose".to_owned();
    };
    let ranges = format!("the images are of {first} s to {last} s, the poses of {from} s to {to} s");
    if last < *from || *to < first {
        return format!("{ranges}, expected one clock for both");
    }
    format!("{ranges}, expected poses at most {max_gap} s apart, without jumps")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ranges_of_time_are_named() {
        let at = |seconds: i64| Stamp::from_nanos(seconds * 1_000_000_000);
        let poses = [(at(100), ()), (at(200), ())];
        let apart = why_uncovered(&poses, (at(1), at(2)), 1.0);
        assert!(apart.contains("of 1.000000000 s to 2.000000000 s"), "{apart}");
        assert!(apart.contains("poses of 100.000000000 s to 200.000000000 s"), "{apart}");
        assert!(apart.ends_with("expected one clock for both"), "{apart}");
        assert!(why_uncovered(&poses, (at(150), at(151)), 0.5).contains("at most 0.5 s apart"));
        assert_eq!(why_uncovered::<()>(&[], (at(1), at(2)), 1.0), "it holds no pose");
    }
}
