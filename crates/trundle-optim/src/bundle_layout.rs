//! The observations of a bundle problem in the order of the solver.

use crate::bundle::{BundleObservation, BundleProblem};

/// The observations of a bundle problem in the solver's order: by point, within a point by row of the pose, those of fixed poses last.
#[derive(Debug, Clone, Default)]
pub(crate) struct Layout {
    /// The sorted observations.
    pub seen: Vec<Measurement>,
    /// Start of each point's observations; one more entry at the end.
    starts: Vec<u32>,
    /// Original index of each sorted observation.
    pub order: Vec<u32>,
}

/// An observation in the numbers of its residual.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measurement {
    /// Index of the pose.
    pub pose: u32,
    /// Offset from the principal point, px.
    pub pixel: [f64; 2],
    /// 1 / sigma, 1/px.
    pub per_px: f64,
    /// 1/m.
    pub inverse_depth: f64,
    /// 1 / sigma, m; 0 without a depth.
    pub per_depth: f64,
    /// Squared residual above which the loss is linear.
    pub bound: f64,
    /// Whether the observation counts for the certainty of the result.
    pub is_certain: bool,
}

impl Layout {
    /// Sorts a problem's observations; `row_of` is the row of each pose, with the highest number for fixed ones.
    pub fn fill(&mut self, problem: &BundleProblem, row_of: impl Fn(usize) -> u32) {
        let observations = &problem.observations;
        self.order.clear();
        self.order.extend(0..observations.len() as u32);
        let point = |i: &u32| observations[*i as usize].point;
        if !self.order.is_sorted_by_key(point) {
            self.order.sort_unstable_by_key(|i| (point(i), *i));
        }
        self.starts.clear();
        self.starts.resize(problem.points.len() + 1, 0);
        observations.iter().for_each(|seen| self.starts[seen.point + 1] += 1);
        for i in 1..self.starts.len() {
            self.starts[i] += self.starts[i - 1];
        }
        for bounds in self.starts.windows(2) {
            let own = &mut self.order[bounds[0] as usize..bounds[1] as usize];
            own.sort_unstable_by_key(|i| (row_of(observations[*i as usize].pose), *i));
        }
        let centre = [problem.camera.cx(), problem.camera.cy()];
        self.seen.clear();
        self.seen.extend(self.order.iter().map(|i| Measurement::of(&observations[*i as usize], centre)));
        if !problem.parts.is_empty() {
            self.doubt_links(&problem.parts);
        }
    }

    /// An observation of a point that a pose of another part observed first is uncertain.
    fn doubt_links(&mut self, parts: &[usize]) {
        for bounds in self.starts.windows(2) {
            let of_point = &mut self.seen[bounds[0] as usize..bounds[1] as usize];
            let part = of_point.iter().map(|seen| seen.pose).min().map(|first| parts[first as usize]);
            of_point.iter_mut().for_each(|seen| seen.is_certain = Some(parts[seen.pose as usize]) == part);
        }
    }

    /// Indices of a point's observations.
    #[inline(always)]
    pub fn of_point(&self, point: usize) -> std::ops::Range<usize> {
        self.starts[point] as usize..self.starts[point + 1] as usize
    }
}

impl Measurement {
    fn of(given: &BundleObservation, centre: [f64; 2]) -> Self {
        let seen = &given.seen;
        Self {
            pose: given.pose as u32,
            pixel: [seen.pixel.x - centre[0], seen.pixel.y - centre[1]],
            per_px: 1.0 / seen.pixel_sigma,
            inverse_depth: seen.depth.map_or(0.0, |d| d.value),
            per_depth: seen.depth.map_or(0.0, |d| 1.0 / d.sigma),
            bound: seen.chi2_bound(),
            is_certain: true,
        }
    }
}
