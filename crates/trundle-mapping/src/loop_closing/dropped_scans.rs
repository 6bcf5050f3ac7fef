//! Poses at the scans that were dropped, relative to scans before them.

use trundle_core::{Pose2, Stamp};

/// Numbers of all scans of a run in their order, and the poses at the dropped ones. A dropped scan takes 24 bytes. Cost of dropping a scan
/// does not depend on the number of those dropped before.
#[derive(Debug, Clone, Default)]
pub(crate) struct DroppedScans {
    /// By the number of the scan; without meaning for a stored scan.
    links: Vec<Link>,
    /// Numbers of the stored scans.
    stored: Vec<u32>,
}

/// Pose at a dropped scan relative to that at an earlier one, which was stored when this one was dropped.
#[derive(Debug, Clone, Copy, Default)]
struct Link {
    stamp: Stamp,
    /// Number of the earlier scan.
    earlier: u32,
    /// x and y \[m\], theta \[rad\]. Steps are within the map, so that the error is below 0.01 mm.
    earlier_from_base: [f32; 3],
}

impl Link {
    fn pose(&self) -> Pose2 {
        let [x, y, theta] = self.earlier_from_base.map(f64::from);
        Pose2::new(x, y, theta)
    }
}

impl DroppedScans {
    /// Adds the next scan, which is stored.
    pub(crate) fn push(&mut self) {
        self.stored.push(self.links.len() as u32);
        self.links.push(Link::default());
    }

    /// Notes that the stored scan `scan` is dropped, with its pose relative to the earlier stored scan `earlier`.
    pub(crate) fn note(&mut self, stamp: Stamp, scan: usize, earlier: usize, earlier_from_base: Pose2) {
        let Pose2 { x, y, theta } = earlier_from_base;
        let earlier = self.stored[earlier];
        let earlier_from_base = [x as f32, y as f32, theta as f32];
        self.links[self.stored[scan] as usize] = Link { stamp, earlier, earlier_from_base };
    }

    /// Drops the stored scans marked in `goes`, all of them noted.
    pub(crate) fn thin(&mut self, goes: &[bool]) {
        keep(&mut self.stored, goes);
    }

    /// Forgets all scans from the stored scan `count` on.
    pub(crate) fn truncate(&mut self, count: usize) {
        if let Some(number) = self.stored.get(count) {
            self.links.truncate(*number as usize);
            self.stored.truncate(count);
        }
    }

    /// The poses at stored and dropped scans from the stored scan `first` on, in their order, from those at the stored scans.
    pub(crate) fn whole(&self, trajectory: &[(Stamp, Pose2)], first: usize) -> Vec<(Stamp, Pose2)> {
        let Some(&start) = self.stored.get(first) else { return Vec::new() };
        let start = start as usize;
        let mut stored = self.stored[first..].iter().zip(&trajectory[first..]).peekable();
        let mut all = Vec::with_capacity(self.links.len() - start);
        for (number, link) in self.links.iter().enumerate().skip(start) {
            let pose = stored.next_if(|(stored, _)| **stored as usize == number).map(|(_, pose)| *pose);
            let dropped =
                |all: &[(Stamp, Pose2)]| (link.stamp, all[link.earlier as usize - start].1 * link.pose());
            let pose = pose.unwrap_or_else(|| dropped(&all));
            all.push(pose);
        }
        all
    }

    /// Bytes in use.
    pub(crate) fn bytes(&self) -> usize {
        self.links.capacity() * size_of::<Link>() + self.stored.capacity() * size_of::<u32>()
    }
}

/// Drops the elements marked in `goes`.
pub(crate) fn keep<T>(all: &mut Vec<T>, goes: &[bool]) {
    let mut k = 0;
    all.retain(|_| {
        k += 1;
        !goes[k - 1]
    });
}
