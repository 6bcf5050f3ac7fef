use super::eye::Eye;
use super::footprint::Footprints;
use super::lamps::Lamps;
use super::patch::Patch;
use super::tile::{COLUMNS, NOTHING, Row, Tile};
use trundle_core::PinholeCamera;

/// Cosines of incidence are not said to be less than this.
const LEAST_COSINE: f32 = 1e-3;

/// Everything that is drawn in one image.
pub(super) struct Picture<'a> {
    pub(super) camera: &'a PinholeCamera,
    /// What stands still, then what moves.
    pub(super) eyes: &'a [Eye<'a>],
    pub(super) lamps: &'a Lamps,
}

/// Up to [`ROWS`] rows of a view.
pub(super) struct Band<'a> {
    pub(super) depth: &'a mut [f32],
    pub(super) color: &'a mut [[u8; 3]],
    pub(super) cosine: &'a mut [f32],
}

impl Picture<'_> {
    /// Draws the band whose first row is `top`.
    pub(super) fn draw(&self, top: usize, band: &mut Band) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has the one feature that the function is compiled for.
            return unsafe { self.draw_by_avx2(top, band) };
        }
        self.draw_plainly(top, band);
    }

    /// The same as [`Picture::draw_plainly`], more numbers an instruction.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn draw_by_avx2(&self, top: usize, band: &mut Band) {
        self.draw_plainly(top, band);
    }

    #[inline(always)]
    pub(super) fn draw_plainly(&self, top: usize, band: &mut Band) {
        let width = self.camera.width();
        let rows = band.depth.len() / width;
        for left in (0..width).step_by(COLUMNS) {
            let columns = COLUMNS.min(width - left);
            let mut tile = Tile::empty(columns, rows);
            for eye in self.eyes.iter().rev() {
                eye.draw(self.camera, (left, top), &mut tile);
            }
            for row in 0..rows {
                let at = row * width + left;
                let mut line = Band {
                    depth: &mut band.depth[at..at + columns],
                    color: &mut band.color[at..at + columns],
                    cosine: &mut band.cosine[at..at + columns],
                };
                self.shade(&tile, (left, top), row, &mut line);
            }
        }
    }

    /// Fills in the row of a tile.
    #[inline(always)]
    fn shade(&self, tile: &Tile, (left, top): (usize, usize), row: usize, line: &mut Band) {
        let (inverse_depth, ids) = (&tile.inverse_depth[row], &tile.ids[row]);
        let length = self.lengths(left, top + row);
        let mut at = 0;
        while at < line.depth.len() {
            let id = ids[at];
            if id == NOTHING {
                (line.depth[at], line.color[at], line.cosine[at]) = (0.0, [0; 3], 0.0);
                at += 1;
                continue;
            }
            let eye = self.eye_of(id);
            let is_alone = eye.is_curved(id);
            let end =
                (at + 1..line.depth.len()).find(|&i| is_alone || ids[i] != id).unwrap_or(line.depth.len());
            let rays = eye.rays(self.camera, left, top);
            let patch = eye.patch(&rays, self.lamps, id, (row, at, 1.0 / inverse_depth[at]));
            let seen = Footprints::new(&patch, inverse_depth, row, &length);
            for i in at..end {
                line.depth[i] = 1.0 / inverse_depth[i];
                line.cosine[i] = seen.cosine[i].clamp(LEAST_COSINE, 1.0);
                line.color[i] = color(&patch, &seen, i);
            }
            at = end;
        }
    }

    /// Lengths of the rays of 16 pixels of an image row whose part along the axis is 1.
    #[inline(always)]
    fn lengths(&self, left: usize, y: usize) -> Row<f32> {
        let camera = self.camera;
        let y = ((y as f64 - camera.cy()) / camera.fy()) as f32;
        let (x, step) = (((left as f64 - camera.cx()) / camera.fx()) as f32, (1.0 / camera.fx()) as f32);
        let mut lengths = [0.0; COLUMNS];
        for (i, length) in lengths.iter_mut().enumerate() {
            let x = x + i as f32 * step;
            *length = (x * x + y * y + 1.0).sqrt();
        }
        lengths
    }

    #[inline(always)]
    fn eye_of(&self, id: u32) -> &Eye<'_> {
        if id < self.eyes[0].end_id() {
            return &self.eyes[0];
        }
        let next = self.eyes.partition_point(|eye| eye.first_id <= id);
        &self.eyes[next - 1]
    }
}

/// The mean colour of a pixel's footprint.
#[inline(always)]
fn color(patch: &Patch, seen: &Footprints, i: usize) -> [u8; 3] {
    let (x, y, dx, dy, level) = (seen.x[i], seen.y[i], seen.shift_x[i], seen.shift_y[i], seen.level[i]);
    if dx == 0.0 && dy == 0.0 {
        return patch.texture.sample([x, y], level).dimmed(patch.light);
    }
    let near = patch.texture.sample([x - dx, y - dy], level);
    near.blend(patch.texture.sample([x + dx, y + dy], level), 128).dimmed(patch.light)
}
