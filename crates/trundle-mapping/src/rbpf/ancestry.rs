//! Trajectories of all particles as a tree.

use trundle_core::{Pose2, Stamp};

/// The poses of all particles over time, with the parent of each.
#[derive(Debug, Clone, Default)]
pub(crate) struct Ancestry {
    /// Poses up to the last common ancestor of all particles.
    pub(crate) shared: Vec<(Stamp, Pose2)>,
    /// Poses since the last common ancestor.
    pub(crate) columns: Vec<Column>,
}

/// The poses at a time.
#[derive(Debug, Clone)]
pub(crate) struct Column {
    pub(crate) stamp: Stamp,
    pub(crate) poses: Vec<Pose2>,
    /// Parent of each particle in the previous column.
    pub(crate) parents: Vec<u16>,
}

/// Number of columns between two searches for a common ancestor. Source: ours.
const FOLD_INTERVAL_COLUMNS: usize = 64;

impl Ancestry {
    /// Appends the poses of all particles; `parents` are those of the last resampling.
    pub(crate) fn push(&mut self, stamp: Stamp, poses: impl Iterator<Item = Pose2>, parents: &[u16]) {
        self.columns.push(Column { stamp, poses: poses.collect(), parents: parents.to_vec() });
        if self.columns.len().is_multiple_of(FOLD_INTERVAL_COLUMNS) {
            self.settle();
        }
    }

    /// The trajectory of a particle of the last column.
    pub(crate) fn trajectory(&self, particle: usize) -> Vec<(Stamp, Pose2)> {
        let mut own = Vec::with_capacity(self.columns.len());
        let mut at = particle;
        for column in self.columns.iter().rev() {
            own.push((column.stamp, column.poses[at]));
            at = usize::from(column.parents[at]);
        }
        self.shared.iter().copied().chain(own.into_iter().rev()).collect()
    }

    /// Replaces all trajectories by one.
    pub(crate) fn replace(&mut self, trajectory: Vec<(Stamp, Pose2)>) {
        self.shared = trajectory;
        self.columns.clear();
    }

    /// Drops the poses of all particles at the times marked in `goes`, except the last.
    pub(crate) fn thin(&mut self, goes: &[bool]) {
        let first = self.shared.len();
        let mut k = 0;
        self.shared.retain(|_| {
            k += 1;
            !goes[k - 1]
        });
        let mut gone: Option<Vec<u16>> = None;
        let columns = std::mem::take(&mut self.columns).into_iter().enumerate();
        for (k, mut column) in columns {
            // A particle with a dropped parent descends from that parent's parent.
            if let Some(parents) = gone.take() {
                column.parents.iter_mut().for_each(|parent| *parent = parents[usize::from(*parent)]);
            }
            if goes[first + k] {
                gone = Some(column.parents);
            } else {
                self.columns.push(column);
            }
        }
    }

    /// Number of poses over time.
    pub(crate) fn len(&self) -> usize {
        self.shared.len() + self.columns.len()
    }

    /// Appends a saved column.
    pub(crate) fn push_column(&mut self, stamp: Stamp, poses: Vec<Pose2>, parents: Vec<u16>) {
        self.columns.push(Column { stamp, poses, parents });
    }

    /// Bytes in use.
    pub(crate) fn bytes(&self) -> usize {
        let column = |c: &Column| c.poses.capacity() * size_of::<Pose2>() + c.parents.capacity() * 2;
        self.shared.capacity() * size_of::<(Stamp, Pose2)>() + self.columns.iter().map(column).sum::<usize>()
    }

    /// Keeps one pose per column up to the last common ancestor.
    fn settle(&mut self) {
        let Some(last) = self.columns.last() else { return };
        let mut alive: Vec<usize> = (0..last.poses.len()).collect();
        let mut common = None;
        for (i, column) in self.columns.iter().enumerate().rev() {
            if alive.len() == 1 {
                common = Some((i, alive[0]));
                break;
            }
            for particle in &mut alive {
                *particle = usize::from(column.parents[*particle]);
            }
            alive.sort_unstable();
            alive.dedup();
        }
        let Some((end, mut at)) = common else { return };
        let mut settled = Vec::with_capacity(end + 1);
        for column in self.columns[..=end].iter().rev() {
            settled.push((column.stamp, column.poses[at]));
            at = usize::from(column.parents[at]);
        }
        self.shared.extend(settled.into_iter().rev());
        self.columns.drain(..=end);
        if let Some(first) = self.columns.first_mut() {
            first.parents.iter_mut().for_each(|parent| *parent = 0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loop_closing::scan_history::every_second;

    #[test]
    fn thinning_leaves_every_particle_its_way() {
        let mut ancestry = Ancestry::default();
        let at = |k: usize, i: usize| Pose2::new(k as f64, i as f64, 0.0);
        for k in 0..5 {
            ancestry.shared.push((Stamp::from_nanos(k as i64), at(k, 0)));
        }
        // Three particles whose trajectories cross at every step.
        for k in 5..20_usize {
            let parents = if k == 5 { vec![0; 3] } else { vec![1, 2, (k % 3) as u16] };
            ancestry.push_column(Stamp::from_nanos(k as i64), (0..3).map(|i| at(k, i)).collect(), parents);
        }
        let before: Vec<_> = (0..3).map(|i| ancestry.trajectory(i)).collect();
        ancestry.thin(&every_second(20, 12));
        assert_eq!(ancestry.len(), 20 - 5);
        for (i, before) in before.iter().enumerate() {
            let kept: Vec<_> =
                before.iter().filter(|(s, _)| s.nanos % 2 == 0 || s.nanos >= 11).copied().collect();
            assert_eq!(ancestry.trajectory(i), kept, "particle {i}");
        }
    }
}
