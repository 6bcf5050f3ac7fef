//! The perspective three-point problem: the camera pose from three known points in three known directions.
//!
//! The distances l_i to the points satisfy three quadrics, l_i^2 + l_j^2 - 2 c_ij l_i l_j = a_ij (law of cosines). Two linear combinations
//! have no constant term: they are cones, that is conics in the ratios of the distances. One member of the pencil of both is a pair of
//! lines, given by the real root that a cubic always has. The lines intersect the conics in at most four points \[Persson18, sec. 3\],
//! \[Ding23\]. A few Newton steps on the three quadrics remove the rounding error. Cost: about 2 us, mainly for the motion of each
//! solution.
//!
//! | paper | here | unit |
//! |---|---|---|
//! | lambda_i | `distances` | m |
//! | a_ij, b_ij | `squares`, `cosines` | m^2 |
//! | D_1, D_2 | `first`, `second` | m^2 |
//! | gamma | `root` | |

use super::rigid::rigid_motion;
use nalgebra::Matrix3;
use trundle_core::{Pose3, Vector3};

/// The poses (none to four, in any order) that move `points` (frame a, m) to the directions `bearings` (unit length, camera frame b), in
/// front of the camera. `None` if the points are collinear.
pub(crate) fn poses_of_three(points: [Vector3; 3], bearings: [Vector3; 3]) -> [Option<Pose3>; 4] {
    let triangle = Triangle::new(points, bearings);
    let pose = |distances: Vector3| {
        let seen = [0, 1, 2].map(|i| (points[i], bearings[i] * distances[i]));
        rigid_motion(&seen)
    };
    triangle.distances().map(|distances| distances.and_then(pose))
}

/// Sides, by corners (0, 1), (0, 2), (1, 2).
const SIDES: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];
/// Newton steps on the distances: 5. Source: ours.
const NEWTON_STEPS: usize = 5;
/// Largest error of a side's square in a solution, as a fraction of the longest: 1e-7. With a larger error, the solution is rejected.
/// Source: ours.
const MAX_SIDE_ERROR: f64 = 1e-7;

/// A triangle, and under which angles its sides are seen.
struct Triangle {
    /// Squared lengths of the sides.
    squares: [f64; 3],
    /// Cosines of the angles.
    cosines: [f64; 3],
}

impl Triangle {
    fn new(points: [Vector3; 3], bearings: [Vector3; 3]) -> Self {
        Self {
            squares: SIDES.map(|(i, j)| (points[i] - points[j]).norm_squared()),
            cosines: SIDES.map(|(i, j)| bearings[i].dot(&bearings[j])),
        }
    }

    /// The distances to the corners, all positive, of each solution.
    fn distances(&self) -> [Option<Vector3>; 4] {
        let mut cones =
            [0, 1].map(|side| self.quadric(side) * self.squares[2] - self.quadric(2) * self.squares[side]);
        cones.sort_by(|a, b| a.determinant().abs().total_cmp(&b.determinant().abs()));
        let [first, second] = cones;
        let Some((root, lines)) = line_pair(&first, &second) else { return [None; 4] };
        // If one is the other times -root, the larger decides.
        let conic = if root.abs() > 1.0 { first } else { second };
        let [a, b] = lines.map(|line| line_conic_intersections(&line, &conic));
        [a[0], a[1], b[0], b[1]].map(|ratios| self.polished(self.sized(ratios?)?))
    }

    /// The quadric whose value at the distances is the square of a side.
    fn quadric(&self, side: usize) -> Matrix3<f64> {
        let (i, j) = SIDES[side];
        let mut quadric = Matrix3::zeros();
        (quadric[(i, i)], quadric[(j, j)]) = (1.0, 1.0);
        (quadric[(i, j)], quadric[(j, i)]) = (-self.cosines[side], -self.cosines[side]);
        quadric
    }

    /// The distances for these ratios, in the size of the triangle; `None` if one is not in front of the camera.
    fn sized(&self, ratios: Vector3) -> Option<Vector3> {
        let size: f64 = (0..3).map(|side| ratios.dot(&(self.quadric(side) * ratios))).sum();
        let distances = ratios * ((self.squares.iter().sum::<f64>() / size).sqrt() * ratios.sum().signum());
        distances.iter().all(|d| *d > 0.0 && d.is_finite()).then_some(distances)
    }

    /// The distances that fit the sides, by Newton's method; `None` if none near by do.
    fn polished(&self, mut distances: Vector3) -> Option<Vector3> {
        for _ in 0..NEWTON_STEPS {
            let jacobian = Matrix3::from_fn(|side, k| 2.0 * (self.quadric(side) * distances)[k]);
            distances -= jacobian.try_inverse()? * self.misfit(&distances);
        }
        let longest = self.squares.iter().fold(0.0, |a: f64, b| a.max(*b));
        let fits = self.misfit(&distances).amax() <= MAX_SIDE_ERROR * longest;
        (fits && distances.min() > 0.0).then_some(distances)
    }

    fn misfit(&self, distances: &Vector3) -> Vector3 {
        Vector3::from_fn(|side, _| {
            let (i, j) = SIDES[side];
            let (a, b) = (distances[i], distances[j]);
            a * a + b * b - 2.0 * self.cosines[side] * a * b - self.squares[side]
        })
    }
}

/// A root of det(`first` + root * `second`) = 0, and the two lines of this conic. Among several roots, the one with the most distinct
/// lines. `None` without real lines. `second` has the larger determinant.
fn line_pair(first: &Matrix3<f64>, second: &Matrix3<f64>) -> Option<(f64, [Vector3; 2])> {
    let (adjoint_1, adjoint_2) = (adjoint(first), adjoint(second));
    let cubic = [
        second.determinant(),
        adjoint_2.component_mul(first).sum(),
        adjoint_1.component_mul(second).sum(),
        first.determinant(),
    ];
    let mut best: Option<(f64, f64, Matrix3<f64>)> = None;
    for root in roots(cubic).into_iter().flatten() {
        let conic = first + second * root;
        let apart = -adjoint(&conic).diagonal().min() / conic.norm_squared();
        if apart > best.map_or(0.0, |(max, ..)| max) {
            best = Some((apart, root, conic));
        }
    }
    best.map(|(_, root, conic)| (root, lines_of(&conic)))
}

/// The adjugate of a symmetric matrix.
fn adjoint(m: &Matrix3<f64>) -> Matrix3<f64> {
    let [a, b, c] = [0, 1, 2].map(|i| m.column(i).into_owned());
    Matrix3::from_columns(&[b.cross(&c), c.cross(&a), a.cross(&b)])
}

/// The two lines of a degenerate conic whose adjugate has a negative number on its diagonal. The sum with the cross product matrix of their
/// common point is the outer product of the lines (Richter-Gebert, Perspectives on Projective Geometry, 11.1).
fn lines_of(conic: &Matrix3<f64>) -> [Vector3; 2] {
    let adjoint = adjoint(conic);
    let column = adjoint.diagonal().imin();
    let point = adjoint.column(column) / (-adjoint[(column, column)]).sqrt();
    let product = conic + point.cross_matrix();
    let (row, column) = product.iamax_full();
    [product.row(row).transpose(), product.column(column).into_owned()]
}

/// Intersections of a line with a conic, as points of length one.
fn line_conic_intersections(line: &Vector3, conic: &Matrix3<f64>) -> [Option<Vector3>; 2] {
    let mut axis = Vector3::zeros();
    axis[line.iamin()] = 1.0;
    let u = line.cross(&axis).normalize();
    let v = line.cross(&u).normalize();
    let (uu, uv, vv) = (u.dot(&(conic * u)), u.dot(&(conic * v)), v.dot(&(conic * v)));
    // A double root may come out a little below zero.
    let discriminant = uv * uv - uu * vv;
    if discriminant < -1e-9 * uv * uv {
        return [None; 2];
    }
    let q = -(uv + discriminant.max(0.0).sqrt().copysign(uv));
    [u * q + v * uu, u * vv + v * q].map(|point| point.try_normalize(0.0))
}

/// The real roots of a x^3 + b x^2 + c x + d; of those one, when a and d are both 0.
fn roots([a, b, c, d]: [f64; 4]) -> [Option<f64>; 3] {
    if a == 0.0 && d == 0.0 {
        return [Some(0.0), None, None];
    }
    let (b, c, d) = (b / a, c / a, d / a);
    let Some(first) = one_root(b, c, d) else { return [None; 3] };
    // The others: x^2 + (b + first) x + (c + first (b + first)).
    let half = -0.5 * (b + first);
    let discriminant = half * half - (c - 2.0 * first * half);
    if discriminant < 0.0 {
        return [Some(first), None, None];
    }
    let spread = discriminant.sqrt();
    [Some(first), Some(half - spread), Some(half + spread)]
}

/// A real root of x^3 + b x^2 + c x + d by Newton's method, from a start outside the turning points, where the method converges
/// \[Persson18, sec. 3.3\].
fn one_root(b: f64, c: f64, d: f64) -> Option<f64> {
    let value = |x: f64| ((x + b) * x + c) * x + d;
    let spread = (b * b - 3.0 * c).max(0.0).sqrt();
    let (maximum, minimum) = ((-b - spread) / 3.0, (-b + spread) / 3.0);
    let mut x = if spread == 0.0 {
        -b / 3.0
    } else if value(maximum) > 0.0 {
        maximum - (value(maximum) / spread).sqrt()
    } else {
        minimum + (-value(minimum) / spread).sqrt()
    };
    for _ in 0..50 {
        let step = value(x) / ((3.0 * x + 2.0 * b) * x + c);
        if !step.is_finite() {
            break;
        }
        x -= step;
        if step.abs() <= 1e-15 * x.abs() {
            break;
        }
    }
    x.is_finite().then_some(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;
    use proptest::prelude::*;

    fn any_bearing() -> impl Strategy<Value = Vector3> {
        (-0.7..0.7, -0.6..0.6).prop_map(|(x, y)| Vector3::new(x, y, 1.0).normalize())
    }

    /// The distance of the nearest of the solutions from the truth, m and rad.
    fn error(points: [Vector3; 3], bearings: [Vector3; 3], truth: Pose3) -> f64 {
        let found = poses_of_three(points, bearings);
        let errors = found.iter().flatten().map(|pose| (pose.inverse() * truth).log().norm());
        errors.fold(f64::INFINITY, f64::min)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1000))]

        #[test]
        fn the_true_pose_is_among_the_solutions(
            bearings in prop::array::uniform3(any_bearing()),
            depths in prop::array::uniform3(0.3..8.0_f64),
            tangent in prop::array::uniform6(-1.5..1.5).prop_map(Vector6::from),
        ) {
            let truth = Pose3::exp(tangent);
            let seen = [0, 1, 2].map(|i| bearings[i] * depths[i]);
            let points = seen.map(|p| truth.inverse().transform(p));
            // Two solutions that nearly coincide, or a plane through the points near the camera: the directions hardly determine the pose.
            let triangle = Triangle::new(points, bearings);
            let depths = Vector3::from(depths);
            let jacobian = Matrix3::from_fn(|side, k| (triangle.quadric(side) * depths)[k]);
            let squares: f64 = triangle.squares.iter().product::<f64>().sqrt();
            let volume = Matrix3::from_columns(&bearings).determinant().abs();
            prop_assume!(jacobian.determinant().abs() > 1e-3 * squares && squares > 1e-4 && volume > 1e-3);
            prop_assert!(error(points, bearings, truth) < 1e-5, "{}", error(points, bearings, truth));
        }

        #[test]
        fn every_solution_shows_the_points_in_their_directions(
            points in prop::array::uniform3(prop::array::uniform3(-2.0..2.0).prop_map(Vector3::from)),
            bearings in prop::array::uniform3(any_bearing()),
        ) {
            for pose in poses_of_three(points, bearings).iter().flatten() {
                for (point, bearing) in points.iter().zip(&bearings) {
                    let seen = pose.transform(*point);
                    prop_assert!((seen.normalize() - bearing).norm() < 1e-5, "{seen} {bearing}");
                }
            }
        }

        #[test]
        fn the_roots_are_roots(roots_of in prop::array::uniform3(-5.0..5.0_f64), lead in 0.1..3.0_f64) {
            let [r, s, t] = roots_of;
            let cubic = [lead, -lead * (r + s + t), lead * (r * s + s * t + t * r), -lead * r * s * t];
            let found = roots(cubic);
            prop_assert!(found[0].is_some());
            for x in found.iter().flatten() {
                let nearest = roots_of.iter().map(|y| (x - y).abs()).fold(f64::INFINITY, f64::min);
                prop_assert!(nearest < 1e-3, "{x} of {roots_of:?}");
            }
        }
    }

    #[test]
    fn a_camera_right_above_an_equilateral_triangle_is_found() {
        let corner = |turn: f64| Vector3::new(turn.to_radians().cos(), turn.to_radians().sin(), 0.0);
        let points = [0.0, 120.0, 240.0].map(corner);
        let truth = Pose3::exp(Vector6::new(0.0, 0.0, 2.0, 0.0, 0.0, 0.0));
        let bearings = points.map(|p| truth.transform(p).normalize());
        assert!(error(points, bearings, truth) < 1e-9);
    }

    #[test]
    fn points_without_a_pose_give_none() {
        let bearings =
            [Vector3::z(), Vector3::new(0.1, 0.0, 1.0).normalize(), Vector3::new(0.2, 0.0, 1.0).normalize()];
        let line = [0.0, 1.0, 2.0].map(|x| Vector3::new(x, 0.0, 3.0));
        assert_eq!(poses_of_three(line, bearings), [None; 4]);
        assert_eq!(poses_of_three([line[0]; 3], bearings), [None; 4]);
        let triangle = [Vector3::x(), Vector3::y(), Vector3::z()];
        assert_eq!(poses_of_three(triangle, [Vector3::z(); 3]), [None; 4]);
        assert_eq!(poses_of_three(triangle.map(|p| p * f64::NAN), bearings), [None; 4]);
    }
}
