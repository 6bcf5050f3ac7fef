//! The curve through waypoints: a quadratic program \[Li18\] inside a convex free corridor.
//!
//! Problem: a smooth curve near the waypoints, with given ends and headings, free of contact. Idea: one Bezier piece for each segment of
//! the path; least squares to the path plus the squared second and third derivatives. End points, headings and joints are equalities. An
//! inequality excludes the reversed tangent. Every control point is inside its segment's corridor, and therefore the whole curve is. Cost:
//! a sparse interior-point solve, O(pieces).
//!
//! | paper | here | unit |
//! |---|---|---|
//! | a_i, b_i | [`BezierPiece::control`], [`BezierPiece::monomials`] | m |
//! | s | chord length along the waypoints | m |
//! | theta_0, theta_f | [`Tangent::Heading`] | rad |
//! | eps of x' cos theta + y' sin theta >= eps | `min_tangent` | 1 |

use crate::curve::analytic_curve::{ActiveRow, Curve};
use crate::curve::bezier::BezierPiece;
use crate::curve::fit::config::CurveConfig;
use crate::curve::fit::curvature_bound::{CurvePoint, exceeding};
use crate::curve::fit::layout::Layout;
use crate::curve::fit::objective::objective;
use crate::curve::fit::rows::{Rows, Side};
use crate::curve::fit::segment::{PathSegment, Tangent};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use trundle_core::Vector2;

/// The curve along `segments` with these end tangents; `smoothing` is a length, m. `None` if the program has no solution.
///
/// Few sides of the corridors are active. The program is solved with the sides near the path first, then with those near the last curve,
/// until all sides hold (cutting planes). The result equals that of the whole program. If the curvature exceeds `config.max_curvature`, the
/// bound is added; without a solution the result is the curve without the bound.
pub(crate) fn fit(
    segments: &[PathSegment],
    tangents: (Tangent, Tangent),
    smoothing: f64,
    config: &CurveConfig,
) -> Option<Curve> {
    let layout = Layout { degree: config.degree, pieces: segments.len() };
    let (p, q) = objective(segments, layout, smoothing);
    let (mut sides, mut points): (Vec<Side>, Vec<CurvePoint>) =
        (sides_near_path(segments, config.degree), Vec::new());
    let (mut over_bound, mut linearisations) = (None, 0);
    for _ in 0..MAX_SOLVES {
        let mut rows = Rows::new(layout, segments);
        rows.ends(tangents.0, tangents.1);
        let equalities = rows.count();
        rows.forward(tangents.0, tangents.1, config.min_tangent);
        let before = rows.count();
        rows.sides(&sides);
        if let Some(over_bound) = &over_bound {
            rows.curvature_bounds(over_bound, &points, config.max_curvature);
        }
        let cones = [
            SupportedConeT::ZeroConeT(equalities),
            SupportedConeT::NonnegativeConeT(rows.count() - equalities),
        ];
        let (a, b) = rows.finish();
        let Some((mut x, multipliers)) = solve(&p, &q, &a, &b, &cones) else { return over_bound };
        snap_ends(&mut x, segments, layout, tangents);
        let curve = assemble(&x, segments, layout);
        let violated = violated(&curve, segments, &sides);
        if violated.is_empty() {
            let corridors = segments.iter().map(|segment| segment.planes.clone()).collect();
            let active = active(&curve, segments, &sides, &multipliers[before..]);
            let curve = curve.within(corridors, active);
            linearisations += 1;
            match exceeding(&curve, config.max_curvature) {
                Some(more) if !more.is_empty() && linearisations <= MAX_LINEARISATIONS => {
                    points
                        .extend(more.into_iter().filter(|point| !points.contains(point)).collect::<Vec<_>>());
                    over_bound = Some(curve);
                }
                _ => return Some(curve),
            }
        }
        sides.extend(violated);
    }
    over_bound
}

/// Sides near the path itself, at the control points towards that end: most active sides are among them.
fn sides_near_path(segments: &[PathSegment], degree: usize) -> Vec<Side> {
    let mut sides = Vec::new();
    let last = segments.len() - 1;
    for (piece, segment) in segments.iter().enumerate() {
        for (plane, half) in segment.planes.iter().enumerate() {
            let near = |point: Vector2| half.normal.dot(&point) > half.offset - NEAR_PATH_M;
            let mut add = |control| sides.push(Side { piece, control, plane });
            if near(segment.from) {
                (usize::from(piece == 0)..=degree / 2).for_each(&mut add);
            }
            if near(segment.to) {
                (degree / 2 + 1..=degree - usize::from(piece == last)).for_each(&mut add);
            }
        }
    }
    sides
}

/// Distance between side and path below which the side is part of the first program, m. Source: ours.
const NEAR_PATH_M: f64 = 0.03;
/// Largest number of solves, with added sides and curvature rows. Source: ours.
const MAX_SOLVES: usize = 16;
/// Largest number of linearisations of the curvature bound. Source: ours.
const MAX_LINEARISATIONS: usize = 5;
/// Violation of a side that counts as rounding, m. Source: ours.
const SIDE_TOLERANCE_M: f64 = 2e-5;
/// Distance of a side from a control point below which the side is added, m. Source: ours.
const NEAR_CONTROL_M: f64 = 0.01;
/// Multiplier below which a side is inactive, m^2. Source: ours.
const MIN_MULTIPLIER_M2: f64 = 1e-7;
/// Distance of a control point from a side above which the side is inactive, m. Source: ours.
const ACTIVE_DISTANCE_M: f64 = 1e-4;

/// The sides near control points that are not in `known`; empty if no side is violated. The two ends are inside.
fn violated(curve: &Curve, segments: &[PathSegment], known: &[Side]) -> Vec<Side> {
    let (mut near, mut is_violated) = (Vec::new(), false);
    let last = segments.len() - 1;
    for (piece, (bezier, segment)) in curve.pieces().iter().zip(segments).enumerate() {
        let controls = bezier.control();
        let inner = usize::from(piece == 0)..controls.len() - usize::from(piece == last);
        for control in inner {
            for (plane, half) in segment.planes.iter().enumerate() {
                let beyond = half.normal.dot(&controls[control]) - half.offset;
                let side = Side { piece, control, plane };
                if beyond > -NEAR_CONTROL_M && !known.contains(&side) {
                    is_violated |= beyond > SIDE_TOLERANCE_M;
                    near.push(side);
                }
            }
        }
    }
    if is_violated { near } else { Vec::new() }
}

/// The active sides. An interior-point solver leaves a small multiplier on every row, so the distance decides too.
fn active(curve: &Curve, segments: &[PathSegment], sides: &[Side], multipliers: &[f64]) -> Vec<ActiveRow> {
    let is_near = |Side { piece, control, plane }: &Side| {
        let half = segments[*piece].planes[*plane];
        half.offset - half.normal.dot(&curve.pieces()[*piece].control()[*control]) < ACTIVE_DISTANCE_M
    };
    let pairs = sides
        .iter()
        .zip(multipliers)
        .filter(|(side, multiplier)| **multiplier > MIN_MULTIPLIER_M2 && is_near(side));
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

/// The unknowns and the multipliers of the rows.
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
        // The basis is well conditioned: refinement to the last digit costs more than the factorisation.
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

/// Removes the solver's rounding at the ends: exact points, tangents exactly along their headings.
fn snap_ends(x: &mut [f64], segments: &[PathSegment], layout: Layout, (start, end): (Tangent, Tangent)) {
    let last = layout.pieces;
    let ends = [(0, segments[0].from, start), (last, segments[last - 1].to, end)];
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

fn assemble(x: &[f64], segments: &[PathSegment], layout: Layout) -> Curve {
    let vector = |i: usize| Vector2::new(x[i * 2], x[i * 2 + 1]);
    let pieces = segments.iter().enumerate().map(|(i, segment)| {
        let span = segment.length();
        let control = |k| {
            let (terms, count) = layout.control(i, k, span);
            terms[..count].iter().map(|(v, share)| vector(*v) * *share).sum()
        };
        BezierPiece::new((0..=layout.degree).map(control).collect(), span)
    });
    Curve::new(pieces.collect())
}
