//! The curve through way-points: a quadratic programme \[Li18\], kept inside a convex free corridor.
//!
//! Problem: a smooth curve near the way-points, with given ends and headings, that touches nothing. Idea: one Bezier
//! piece for each stretch of way; least squares to the way plus the squared second and third derivatives; end points,
//! headings and joints are equalities, the reversed tangent is excluded by an inequality, and every control point stays
//! in its stretch's [`corridor`](crate::corridor), so the whole curve does. Cost: a sparse interior-point solve, O(pieces).
//!
//! | paper | here | unit |
//! |---|---|---|
//! | a_i, b_i | [`BezierPiece::control`], [`BezierPiece::monomials`] | m |
//! | s | chord length along the way-points | m |
//! | theta_0, theta_f | [`Tangent::Heading`] | rad |
//! | eps of x' cos theta + y' sin theta >= eps | `least_tangent` | 1 |

mod config;
mod objective;
mod rows;

pub use config::CurveConfig;

use crate::bezier::BezierPiece;
use crate::corridor::{HalfPlane, corridor};
use crate::space::Space;
use crate::{curve::Curve, fit::rows::Rows};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use trundle_core::Vector2;

/// How a curve must leave its start, or come to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Tangent {
    /// Somehow forward.
    Free,
    /// With this heading, rad, forward.
    Heading(f64),
    /// With this heading, rad, at unit parametric speed, and this curvature, 1/m: the continuation of a motion.
    Moving(f64, f64),
}

/// A straight stretch of way, its corridor, and the piece of curve that will stand for it.
pub(crate) struct Stretch {
    pub(crate) from: Vector2,
    pub(crate) to: Vector2,
    pub(crate) planes: Vec<HalfPlane>,
}

impl Stretch {
    pub(crate) fn length(&self) -> f64 {
        (self.to - self.from).norm()
    }
}

/// Cuts a way into stretches of at most `config.piece` m and finds their corridors.
pub(crate) fn stretches(space: &Space<'_>, way: &[Vector2], config: &CurveConfig) -> Vec<Stretch> {
    let want = space.radius + space.room.margin;
    let mut stretches = Vec::new();
    for pair in way.windows(2) {
        let count = ((pair[1] - pair[0]).norm() / config.piece).ceil().max(1.0);
        let at = |k: f64| pair[0] + (pair[1] - pair[0]) * (k / count);
        for k in 0..count as usize {
            let (from, to) = (at(k as f64), at(k as f64 + 1.0));
            let planes = corridor(space, from, to, config.reach, want);
            stretches.push(Stretch { from, to, planes });
        }
    }
    stretches
}

/// The curve along `stretches` with these end tangents; `smoothing` is a length, m. `None` when there is none.
pub(crate) fn fit(
    stretches: &[Stretch],
    (start, end): (Tangent, Tangent),
    smoothing: f64,
    config: &CurveConfig,
) -> Option<Curve> {
    let degree = config.degree;
    let (p, q) = objective::objective(stretches, degree, smoothing);
    let mut rows = Rows::new(degree, stretches);
    rows.joints();
    rows.start(start);
    rows.end(end);
    let equalities = rows.count();
    rows.forward(start, end, config.least_tangent);
    rows.corridors();
    let inequalities = rows.count() - equalities;
    let (a, b) = rows.finish();
    let cones = [SupportedConeT::ZeroConeT(equalities), SupportedConeT::NonnegativeConeT(inequalities)];
    let x = solve(&p, &q, &a, &b, &cones)?;
    Some(assemble(&x, stretches, degree))
}

fn solve(
    p: &CscMatrix<f64>,
    q: &[f64],
    a: &CscMatrix<f64>,
    b: &[f64],
    cones: &[SupportedConeT<f64>],
) -> Option<Vec<f64>> {
    let settings =
        DefaultSettings { verbose: false, max_iter: 60, max_threads: 1, ..DefaultSettings::default() };
    let mut solver = DefaultSolver::new(p, q, a, b, cones, settings).ok()?;
    solver.solve();
    let solved = solver.solution.status == SolverStatus::Solved;
    (solved && solver.solution.x.iter().all(|x| x.is_finite())).then_some(solver.solution.x)
}

/// Control points from the unknowns; ends exact, joints closed to the last bit.
fn assemble(x: &[f64], stretches: &[Stretch], degree: usize) -> Curve {
    let mut points: Vec<Vector2> = x.chunks_exact(2).map(|xy| Vector2::new(xy[0], xy[1])).collect();
    let last = points.len() - 1;
    points[0] = stretches[0].from;
    points[last] = stretches[stretches.len() - 1].to;
    for joint in 1..stretches.len() {
        let first = joint * (degree + 1);
        points[first - 1] = points[first];
    }
    let pieces = points.chunks_exact(degree + 1).zip(stretches);
    Curve::new(pieces.map(|(control, stretch)| BezierPiece::new(control.to_vec(), stretch.length())).collect())
}
