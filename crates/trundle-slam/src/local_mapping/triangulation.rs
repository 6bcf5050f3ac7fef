//! Landmarks from two views of features without depth.

use crate::frame::depth::MAX_RELATIVE_SIGMA;
use crate::frame::observation_model::ObservationModel;
use crate::ids::{KeyframeId, LandmarkId};
use crate::map::keyframe::Keyframe;
use crate::map::landmark_map::LandmarkMap;
use crate::matching::projection_search::MatchThresholds;
use trundle_core::{Hypotenuse, Pose3, Vector3};
use trundle_optim::{CHI2_95_2, PointObservation};

/// Largest cosine of the angle between the two rays to a point: 0.9998 (1.15 deg). With a smaller angle the distance is too uncertain: at
/// 20 mrad, a pixel noise of 0.5 mrad gives a relative error of a twentieth. Source: \[MurArtal17\].
const MAX_RAY_COSINE: f64 = 0.9998;
/// Number of keyframes in which a second view of a feature is searched: 5. Source: ours.
const MAX_PARTNERS: usize = 5;
/// Factor by which the ratio of distances may differ from that of the octaves: 1.5. Beyond it the features are not of one point.
/// Source: \[MurArtal17\].
const SCALE_TOLERANCE: f64 = 1.5;

/// Triangulates landmarks from features without depth, beyond the camera's range or in a hole, in two keyframes with a large enough
/// baseline \[MurArtal17, sec. III-A\]. Returns the new landmarks.
pub(crate) fn triangulate_new(
    map: &mut LandmarkMap,
    id: KeyframeId,
    model: &ObservationModel,
    thresholds: MatchThresholds,
) -> Vec<LandmarkId> {
    let partners: Vec<KeyframeId> =
        map.covisible(id, 15).into_iter().map(|(other, _)| other).take(MAX_PARTNERS).collect();
    let mut made = Vec::new();
    for partner in partners {
        for (own, other, point) in pairs(map, id, partner, model, thresholds) {
            let landmark = map.add_landmark(point);
            map.observe(landmark, partner, other);
            map.observe(landmark, id, own);
            map.refresh(landmark, model);
            made.push(landmark);
        }
    }
    made
}

/// Similar features of two keyframes with the point that both see; each feature at most once.
fn pairs(
    map: &LandmarkMap,
    id: KeyframeId,
    partner: KeyframeId,
    model: &ObservationModel,
    thresholds: MatchThresholds,
) -> Vec<(usize, usize, Vector3)> {
    let (a, b) = (map.keyframe(id), map.keyframe(partner));
    let pair = Pair { a, b, b_from_a: b.visual_from_camera.inverse() * a.visual_from_camera, model };
    let theirs: Vec<Ray> = without_depth(b).map(|feature| pair.in_b(feature)).collect();
    let mut is_taken = vec![false; b.frame.len()];
    let mut found = Vec::new();
    for own in without_depth(a) {
        let Some(other) = pair.best_match(own, &theirs, thresholds).filter(|other| !is_taken[*other]) else {
            continue;
        };
        let Some(point) = pair.point(own, other) else { continue };
        is_taken[other] = true;
        found.push((own, other, a.visual_from_camera.transform(point)));
    }
    found
}

/// The features without a landmark and without a usable depth.
fn without_depth(keyframe: &Keyframe) -> impl Iterator<Item = usize> + '_ {
    let has_none = |i: usize| {
        keyframe.frame.depths[i].is_none_or(|depth| depth.sigma > MAX_RELATIVE_SIGMA * depth.value)
    };
    (0..keyframe.frame.len()).filter(move |i| keyframe.landmarks[*i].is_none() && has_none(*i))
}

/// Ray of a feature.
#[derive(Debug, Clone, Copy)]
struct Ray {
    feature: usize,
    /// Coordinate x at 1 m along the optical axis.
    x: f64,
    y: f64,
    /// Largest distance from the epipolar line, px.
    reach: f64,
}

/// Two keyframes that may see one point.
struct Pair<'a> {
    a: &'a Keyframe,
    b: &'a Keyframe,
    b_from_a: Pose3,
    model: &'a ObservationModel,
}

impl Pair<'_> {
    /// The ray of a feature of `b`, with its distance bound at 95 %.
    fn in_b(&self, feature: usize) -> Ray {
        let (ray, reach) = (self.ray(self.b, feature), 1.96 * self.seen(self.b, feature).pixel_sigma);
        Ray { feature, x: ray.x, y: ray.y, reach }
    }

    /// The feature of `b` near the epipolar line of feature `own` of `a` that is clearly the most similar one among `theirs`.
    fn best_match(&self, own: usize, theirs: &[Ray], thresholds: MatchThresholds) -> Option<usize> {
        // The plane through both cameras and the point cuts the image along this line.
        let normal = self.b_from_a.translation.cross(&self.b_from_a.rotate(self.ray(self.a, own)));
        let camera = &self.model.camera;
        let line = normal / (normal.x / camera.fx()).hypotenuse(normal.y / camera.fy());
        let (mut best, mut next) = ((u32::MAX, usize::MAX), u32::MAX);
        for other in theirs {
            let off = line.x * other.x + line.y * other.y + line.z;
            // Without a baseline `off` is not finite and therefore not near.
            let is_near = off.abs() <= other.reach;
            if !is_near {
                continue;
            }
            let distance = self.a.frame.descriptor(own).distance(self.b.frame.descriptor(other.feature));
            if distance < best.0 {
                (best, next) = ((distance, other.feature), best.0);
            } else {
                next = next.min(distance);
            }
        }
        let (distance, other) = best;
        let is_clear = distance as f32 <= thresholds.ratio * next as f32;
        (distance <= thresholds.max_distance && is_clear).then_some(other)
    }

    /// The point that both features see, in the frame of `a`, m.
    fn point(&self, own: usize, other: usize) -> Option<Vector3> {
        let (ray_a, ray_b) = (self.ray(self.a, own), self.b_from_a.inverse().rotate(self.ray(self.b, other)));
        let cosine = ray_a.dot(&ray_b) / (ray_a.norm() * ray_b.norm());
        if !(0.0..MAX_RAY_COSINE).contains(&cosine) {
            return None;
        }
        let point = midpoint(ray_a, self.b_from_a.inverse().translation, ray_b)?;
        let agrees = |keyframe: &Keyframe, feature: usize, p: Vector3| {
            self.seen(keyframe, feature).chi2(&self.model.camera, p) <= CHI2_95_2
        };
        let in_b = self.b_from_a.transform(point);
        let scale = |keyframe: &Keyframe, feature| self.model.scale(keyframe.frame.octave(feature));
        // A point at distance d in the octave of scale s appears in the octave of scale s' at distance d s / s'.
        let ratio = point.norm() * scale(self.a, own) / (in_b.norm() * scale(self.b, other));
        let fits = (1.0 / SCALE_TOLERANCE..=SCALE_TOLERANCE).contains(&ratio);
        (fits && agrees(self.a, own, point) && agrees(self.b, other, in_b)).then_some(point)
    }

    fn ray(&self, keyframe: &Keyframe, feature: usize) -> Vector3 {
        self.model.camera.unproject(keyframe.frame.pixels[feature], 1.0)
    }

    /// The observation without depth: a depth there belongs to another surface.
    fn seen(&self, keyframe: &Keyframe, feature: usize) -> PointObservation {
        PointObservation { depth: None, ..keyframe.frame.unaligned_observation(feature, self.model) }
    }
}

/// The point nearest to a ray from the origin and a ray from `from`, in front of both.
fn midpoint(a: Vector3, from: Vector3, b: Vector3) -> Option<Vector3> {
    let (aa, ab, bb) = (a.dot(&a), a.dot(&b), b.dot(&b));
    let determinant = aa * bb - ab * ab;
    let (along_a, along_b) = (a.dot(&from), b.dot(&from));
    let s = (bb * along_a - ab * along_b) / determinant;
    let t = (ab * along_a - aa * along_b) / determinant;
    (s > 0.0 && t > 0.0 && s.is_finite() && t.is_finite()).then(|| (a * s + from + b * t) / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::rgbd_frame::Frame;
    use crate::testing::model;
    use nalgebra::Vector6;
    use trundle_core::Stamp;
    use trundle_vision::{Descriptor, Features, Keypoint};

    fn points() -> Vec<Vector3> {
        (0..40)
            .map(|i| Vector3::new(f64::from(i % 8) - 3.5, f64::from(i / 8) - 2.0, 9.0 + f64::from(i % 3)))
            .collect()
    }

    /// View of far points without depth; `shift` moves every third point in the image, px.
    fn view(pose: Pose3, shift: f32) -> Frame {
        let (model, mut features) = (model(), Features::default());
        for (i, point) in points().iter().enumerate() {
            let pixel = model.camera.project(pose.inverse().transform(*point)).unwrap();
            let y = pixel.y as f32 + if i % 3 == 0 { shift } else { 0.0 };
            features.keypoints.push(Keypoint { x: pixel.x as f32, y, octave: 0, angle: 0.0, response: 1.0 });
            let word = |k: u64| (i as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(17 * k as u32);
            features.descriptors.push(Descriptor(std::array::from_fn(|k| word(k as u64))));
        }
        let depths = vec![None; features.keypoints.len()];
        Frame::of(Stamp::default(), features, depths, &model)
    }

    /// Two keyframes a baseline apart that share 15 landmarks, and what is triangulated of the other features.
    fn made(baseline: f64, shift: f32) -> Vec<Vector3> {
        let (mut map, model) = (LandmarkMap::default(), model());
        let pose = Pose3::exp(Vector6::new(baseline, 0.0, 0.0, 0.0, 0.0, 0.0));
        let (a, b) = (
            map.add_keyframe(view(Pose3::identity(), 0.0), Pose3::identity()),
            map.add_keyframe(view(pose, shift), pose),
        );
        for feature in 0..15 {
            let landmark = map.add_landmark(points()[feature]);
            assert!(map.observe(landmark, a, feature) && map.observe(landmark, b, feature));
        }
        let made = triangulate_new(&mut map, b, &model, MatchThresholds { max_distance: 30, ratio: 0.8 });
        crate::map::landmark_map::tests::assert_consistent(&map);
        made.into_iter().map(|id| map.landmark(id).unwrap().position).collect()
    }

    #[test]
    fn far_points_are_triangulated_and_wrong_pairs_are_not() {
        let found = made(0.5, 0.0);
        assert_eq!(found.len(), 25);
        for (point, truth) in found.iter().zip(&points()[15..]) {
            assert!((point - truth).norm() < 0.01, "{point} is not {truth}");
        }
        assert_eq!(made(0.05, 0.0).len(), 0, "too little parallax");
        assert_eq!(made(0.5, 9.0).len(), 16, "a third is not on its epipolar line");
    }
}
