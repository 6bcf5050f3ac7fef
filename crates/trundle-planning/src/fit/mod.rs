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

mod bend;
mod config;
mod layout;
mod objective;
mod rows;

pub use config::CurveConfig;

use crate::bezier::BezierPiece;
use crate::corridor::{HalfPlane, corridor};
use crate::curve::{ActiveRow, Curve};
use crate::fit::{bend::Place, layout::Layout, rows::Rows, rows::Side};
use crate::space::Space;
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
///
/// Few of the corridors' sides matter: the programme is solved with those near the way first, then again with those that the
/// last curve comes near, until it keeps all (cutting planes). The result is that of the whole programme. Where it bends more
/// than `config.max_curvature`, the bound joins in; where that has no solution, the curve that bends is given.
pub(crate) fn fit(
    stretches: &[Stretch],
    tangents: (Tangent, Tangent),
    smoothing: f64,
    config: &CurveConfig,
) -> Option<Curve> {
    let layout = Layout { degree: config.degree, pieces: stretches.len() };
    let (p, q) = objective::objective(stretches, layout, smoothing);
    let (mut sides, mut places): (Vec<Side>, Vec<Place>) = (nearby(stretches, config.degree), Vec::new());
    let (mut bent, mut bends) = (None, 0);
    for _ in 0..ROUNDS {
        let mut rows = Rows::new(layout, stretches);
        rows.ends(tangents.0, tangents.1);
        let equalities = rows.count();
        rows.forward(tangents.0, tangents.1, config.least_tangent);
        let before = rows.count();
        rows.sides(&sides);
        if let Some(bent) = &bent {
            rows.bends(bent, &places, config.max_curvature);
        }
        let cones = [
            SupportedConeT::ZeroConeT(equalities),
            SupportedConeT::NonnegativeConeT(rows.count() - equalities),
        ];
        let (a, b) = rows.finish();
        let Some((mut x, multipliers)) = solve(&p, &q, &a, &b, &cones) else { return bent };
        settle(&mut x, stretches, layout, tangents);
        let curve = assemble(&x, stretches, layout);
        let crossed = crossed(&curve, stretches, &sides);
        if crossed.is_empty() {
            let corridors = stretches.iter().map(|stretch| stretch.planes.clone()).collect();
            let active = active(&curve, stretches, &sides, &multipliers[before..]);
            let curve = curve.within(corridors, active);
            bends += 1;
            match bend::bent(&curve, config.max_curvature) {
                Some(more) if !more.is_empty() && bends <= BENDS => {
                    places
                        .extend(more.into_iter().filter(|place| !places.contains(place)).collect::<Vec<_>>());
                    bent = Some(curve);
                }
                _ => return Some(curve),
            }
        }
        sides.extend(crossed);
    }
    bent
}

/// Sides that the way itself comes near, at the control points towards that end: most of those that will matter.
fn nearby(stretches: &[Stretch], degree: usize) -> Vec<Side> {
    let mut sides = Vec::new();
    let last = stretches.len() - 1;
    for (piece, stretch) in stretches.iter().enumerate() {
        for (plane, half) in stretch.planes.iter().enumerate() {
            let near = |point: Vector2| half.normal.dot(&point) > half.offset - NEAR_WAY;
            let mut add = |control| sides.push(Side { piece, control, plane });
            if near(stretch.from) {
                (usize::from(piece == 0)..=degree / 2).for_each(&mut add);
            }
            if near(stretch.to) {
                (degree / 2 + 1..=degree - usize::from(piece == last)).for_each(&mut add);
            }
        }
    }
    sides
}

/// Sides nearer than this to the way are in the first programme, m.
const NEAR_WAY: f64 = 0.03;
/// Rounds of adding sides and bends.
const ROUNDS: usize = 16;
/// Times that the curvature's bound is linearised.
const BENDS: usize = 5;
/// A control point so far beyond a side is rounding, m.
const BEYOND: f64 = 2e-5;
/// Sides nearer than this to a control point may be crossed next, m.
const NEAR: f64 = 0.01;
/// A multiplier below this is none, m^2.
const NO_MULTIPLIER: f64 = 1e-7;
/// A control point further than this from a side does not lean on it, m.
const LEANS: f64 = 1e-4;

/// The sides near control points, where any side is crossed, that are not in `known`. The two ends are inside.
fn crossed(curve: &Curve, stretches: &[Stretch], known: &[Side]) -> Vec<Side> {
    let (mut near, mut is_crossed) = (Vec::new(), false);
    let last = stretches.len() - 1;
    for (piece, (bezier, stretch)) in curve.pieces().iter().zip(stretches).enumerate() {
        let controls = bezier.control();
        let inner = usize::from(piece == 0)..controls.len() - usize::from(piece == last);
        for control in inner {
            for (plane, half) in stretch.planes.iter().enumerate() {
                let beyond = half.normal.dot(&controls[control]) - half.offset;
                let side = Side { piece, control, plane };
                if beyond > -NEAR && !known.contains(&side) {
                    is_crossed |= beyond > BEYOND;
                    near.push(side);
                }
            }
        }
    }
    if is_crossed { near } else { Vec::new() }
}

/// The sides that control points lean on. An inner-point solver leaves every row a little multiplier, so that alone says nothing.
fn active(curve: &Curve, stretches: &[Stretch], sides: &[Side], multipliers: &[f64]) -> Vec<ActiveRow> {
    let leans = |Side { piece, control, plane }: &Side| {
        let half = stretches[*piece].planes[*plane];
        half.offset - half.normal.dot(&curve.pieces()[*piece].control()[*control]) < LEANS
    };
    let pairs = sides
        .iter()
        .zip(multipliers)
        .filter(|(side, multiplier)| **multiplier > NO_MULTIPLIER && leans(side));
    let mut rows: Vec<_> = pairs
        .map(|(side, multiplier)| ActiveRow {
            piece: side.piece,
            control: side.control,
            plane: side.plane,
            multiplier: *multiplier,
        })
        .collect();
    rows.sort_by_key(|row| (row.piece, row.control, row.plane));
    rows
}

/// The unknowns and the rows' multipliers.
fn solve(
    p: &CscMatrix<f64>,
    q: &[f64],
    a: &CscMatrix<f64>,
    b: &[f64],
    cones: &[SupportedConeT<f64>],
) -> Option<(Vec<f64>, Vec<f64>)> {
    let settings = DefaultSettings {
        verbose: false,
        max_iter: 50,
        max_threads: 1,
        tol_gap_abs: 1e-7,
        tol_gap_rel: 1e-5,
        presolve_enable: false,
        // The basis is well conditioned: refining to the last digit costs more than factoring.
        iterative_refinement_reltol: 1e-8,
        iterative_refinement_abstol: 1e-9,
        ..DefaultSettings::default()
    };
    let mut solver = DefaultSolver::new(p, q, a, b, cones, settings).ok()?;
    solver.solve();
    let solution = solver.solution;
    let solved = matches!(solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved);
    (solved && solution.x.iter().all(|x| x.is_finite())).then_some((solution.x, solution.z))
}

/// Takes the solver's rounding out of the ends: points exact, tangents exactly along their headings.
fn settle(x: &mut [f64], stretches: &[Stretch], layout: Layout, (start, end): (Tangent, Tangent)) {
    let last = layout.pieces;
    let ends = [(0, stretches[0].from, start), (last, stretches[last - 1].to, end)];
    for (knot, point, tangent) in ends {
        let at = layout.knot(knot, 0) * 2;
        x[at..at + 2].copy_from_slice(point.as_slice());
        let along = match tangent {
            Tangent::Free => continue,
            Tangent::Heading(theta) | Tangent::Moving(theta, _) => Vector2::new(theta.cos(), theta.sin()),
        };
        let speed = along.dot(&Vector2::new(x[at + 2], x[at + 3]));
        x[at + 2..at + 4].copy_from_slice((along * speed).as_slice());
    }
}

fn assemble(x: &[f64], stretches: &[Stretch], layout: Layout) -> Curve {
    let vector = |i: usize| Vector2::new(x[i * 2], x[i * 2 + 1]);
    let pieces = stretches.iter().enumerate().map(|(i, stretch)| {
        let span = stretch.length();
        let control = |k| {
            let (terms, count) = layout.control(i, k, span);
            terms[..count].iter().map(|(v, share)| vector(*v) * *share).sum()
        };
        BezierPiece::new((0..=layout.degree).map(control).collect(), span)
    });
    Curve::new(pieces.collect())
}
