//! Clusters of hits.

use trundle_core::Vector2;

/// Hits that belong to one object.
#[derive(Debug, Clone)]
pub(super) struct Cluster {
    pub(super) hits: Vec<Vector2>,
    pub(super) middle: Vector2,
    pub(super) radius: f64,
}

/// Groups hits (in the order of their bearings) with gaps of at most `gap` m.
pub(super) fn clusters(hits: &[Vector2], sensor: Vector2, gap: f64) -> Vec<Cluster> {
    let mut groups: Vec<Vec<Vector2>> = Vec::new();
    for hit in hits {
        match groups.last_mut().filter(|group| (group[group.len() - 1] - hit).norm() <= gap) {
            Some(group) => group.push(*hit),
            None => groups.push(vec![*hit]),
        }
    }
    // Legs, and objects behind a thin occluder, are joined.
    let mut whole: Vec<Cluster> = Vec::new();
    for group in groups {
        let mut found = disc(group, sensor);
        while let Some(at) = whole.iter().position(|other| are_one(other, &found, gap)) {
            let mut hits = whole.swap_remove(at).hits;
            hits.append(&mut found.hits);
            found = disc(hits, sensor);
        }
        whole.push(found);
    }
    whole
}

fn are_one(a: &Cluster, b: &Cluster, gap: f64) -> bool {
    (a.middle - b.middle).norm() <= a.radius + b.radius + gap
        && a.hits.iter().any(|p| b.hits.iter().any(|q| (p - q).norm() <= gap))
}

/// The disc whose near side is formed by the hits; its depth equals its width.
fn disc(hits: Vec<Vector2>, sensor: Vector2) -> Cluster {
    let mean = hits.iter().sum::<Vector2>() / hits.len() as f64;
    let away = (mean - sensor).try_normalize(1e-9).unwrap_or_else(Vector2::x);
    let across = Vector2::new(-away.y, away.x);
    let (mut left, mut right, mut near) = (f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY);
    for hit in &hits {
        let off = hit - sensor;
        left = left.max(off.dot(&across));
        right = right.min(off.dot(&across));
        near = near.min(off.dot(&away));
    }
    let half = (left - right) / 2.0;
    let middle = sensor + away * (near + half) + across * (left + right) / 2.0;
    let radius = hits.iter().map(|hit| (hit - middle).norm()).fold(half, f64::max);
    Cluster { hits, middle, radius }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_near_side_of_a_disc_gives_the_disc() {
        let (sensor, centre, radius) = (Vector2::new(1.0, 2.0), Vector2::new(3.0, 1.0), 0.3);
        let towards = (sensor - centre).y.atan2((sensor - centre).x);
        let hits: Vec<_> = (-30..=30)
            .map(|k| towards + f64::from(k) * 0.05)
            .map(|angle| centre + Vector2::new(angle.cos(), angle.sin()) * radius)
            .collect();
        let found = clusters(&hits, sensor, 0.1);
        assert_eq!(found.len(), 1);
        assert!((found[0].middle - centre).norm() < 0.02 && (found[0].radius - radius).abs() < 0.02);
    }

    #[test]
    fn two_legs_are_one_cluster_and_two_people_are_two() {
        let at = |x: f64, y: f64| Vector2::new(x, y);
        let hits = [at(2.0, 0.0), at(2.0, 0.05), at(2.1, 0.2), at(2.0, 1.0), at(2.0, 1.05), at(2.05, 0.1)];
        let mut sizes: Vec<usize> =
            clusters(&hits, Vector2::zeros(), 0.2).iter().map(|cluster| cluster.hits.len()).collect();
        sizes.sort_unstable();
        assert_eq!(sizes, [2, 4]);
    }
}
