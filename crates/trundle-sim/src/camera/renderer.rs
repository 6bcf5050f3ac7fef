use super::candidates::Candidates;
use super::lanes::{LANES, Lanes, NOTHING};
use super::seen::Seen;
use crate::world::{Stage, World};
use rayon::prelude::*;
use trundle_core::{Distortion, Invalid, PinholeCamera, Pose3};

/// Rows of a tile.
const TILE_ROWS: usize = 8;

/// An ideal RGB-D image: what a camera without noise would see.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Depth along the optical axis, m, row by row; 0 where nothing is.
    pub depth: Vec<f32>,
    /// sRGB, row by row.
    pub color: Vec<[u8; 3]>,
    /// Cosine of the angle between ray and surface normal, row by row; 0 where nothing is.
    pub cosine: Vec<f32>,
}

/// Draws a [`World`] as a rectified pinhole camera sees it: exact perspective depth, filtered textures, two lamps.
///
/// The image is cut into tiles of 16 x 8 pixels. For each, the hierarchy is walked once with the tile's pyramid; the
/// solids found are met nearest first, a row of rays at a time, until all rays end nearer than the next solid begins.
/// The pixels do not depend on the number of threads.
#[derive(Debug, Clone)]
pub struct Renderer {
    camera: PinholeCamera,
    /// Normalised image coordinate of every column and row.
    columns: Vec<f32>,
    rows: Vec<f32>,
}

impl Renderer {
    /// For a rectified camera.
    ///
    /// # Errors
    /// When the camera has lens distortion.
    pub fn new(camera: PinholeCamera) -> Result<Self, Invalid> {
        if camera.distortion() != Distortion::default() {
            return Err(Invalid::new(
                "distortion of the simulated camera",
                "not zero",
                "",
                "a rectified camera",
            ));
        }
        let normalized = |n: usize, center: f64, focal: f64| {
            (0..n).map(|i| ((i as f64 - center) / focal) as f32).collect::<Vec<_>>()
        };
        let columns = normalized(camera.width(), camera.cx(), camera.fx());
        let rows = normalized(camera.height(), camera.cy(), camera.fy());
        Ok(Self { camera, columns, rows })
    }

    /// The camera.
    pub fn camera(&self) -> &PinholeCamera {
        &self.camera
    }

    /// A black image of the camera's size, to draw into.
    pub fn blank(&self) -> View {
        let (width, height) = (self.camera.width(), self.camera.height());
        let n = width * height;
        View { width, height, depth: vec![0.0; n], color: vec![[0; 3]; n], cosine: vec![0.0; n] }
    }

    /// Draws the stage as seen from `world_from_camera` into `view`, an image of [`Renderer::blank`].
    pub fn render(&self, stage: &Stage<'_>, world_from_camera: &Pose3, view: &mut View) {
        let world = stage.world;
        let paintings = world.paintings();
        let look = |(solid, textures): (&crate::world::Solid, _)| {
            Seen::new(&solid.shape, textures, world_from_camera)
        };
        let seen: Vec<Seen> =
            world.solids().iter().zip(paintings.iter().map(Vec::as_slice)).map(look).collect();
        let scene = SeenWorld { world, renderer: self, world_from_camera, seen: &seen };
        let band = TILE_ROWS * view.width;
        view.depth
            .par_chunks_mut(band)
            .zip(view.color.par_chunks_mut(band))
            .zip(view.cosine.par_chunks_mut(band))
            .enumerate()
            .for_each_init(Candidates::default, |candidates, (i, ((depth, color), cosine))| {
                scene.draw_band(i * TILE_ROWS, candidates, &mut Band { depth, color, cosine });
            });
    }
}

/// Everything that drawing a tile needs.
struct SeenWorld<'a> {
    world: &'a World,
    renderer: &'a Renderer,
    world_from_camera: &'a Pose3,
    seen: &'a [Seen<'a>],
}

/// Some rows of a view.
struct Band<'a> {
    depth: &'a mut [f32],
    color: &'a mut [[u8; 3]],
    cosine: &'a mut [f32],
}

impl SeenWorld<'_> {
    fn draw_band(&self, top: usize, candidates: &mut Candidates, band: &mut Band) {
        let width = self.renderer.camera.width();
        let rows = band.depth.len() / width;
        for left in (0..width).step_by(LANES) {
            let right = (left + LANES).min(width) - 1;
            candidates.gather(
                self.world,
                &self.renderer.camera,
                self.world_from_camera,
                (left, top),
                (right, top + rows - 1),
            );
            let tile = self.meet_tile((left, top), rows, candidates.list());
            for (row, lanes) in tile.iter().enumerate().take(rows) {
                for x in left..=right {
                    self.shade((x, top + row), lanes, x - left, row * width + x, band);
                }
            }
        }
    }

    fn meet_tile(&self, (left, top): (usize, usize), rows: usize, list: &[(f32, u32)]) -> [Lanes; TILE_ROWS] {
        let mut tile = [Lanes::empty(); TILE_ROWS];
        let mut reach = f32::INFINITY;
        let step = (1.0 / self.renderer.camera.fx()) as f32;
        for &(least_depth, solid) in list {
            if least_depth > reach {
                break;
            }
            for (row, lanes) in tile.iter_mut().enumerate().take(rows) {
                self.seen[solid as usize].meet(self.normalized(left, top + row), step, solid, lanes);
            }
            reach = tile[..rows].iter().map(Lanes::reach).fold(0.0, f32::max);
        }
        tile
    }

    fn shade(&self, (x, y): (usize, usize), lanes: &Lanes, lane: usize, at: usize, band: &mut Band) {
        let (depth, part) = (lanes.depth[lane], lanes.part[lane]);
        if part == NOTHING {
            (band.depth[at], band.color[at], band.cosine[at]) = (0.0, [0; 3], 0.0);
            return;
        }
        let pixel = (1.0 / self.renderer.camera.fx()) as f32;
        let look = self.seen[part as usize / 4].look(part % 4, self.normalized(x, y), depth, pixel);
        (band.depth[at], band.color[at], band.cosine[at]) = (depth, look.color, look.cosine);
    }

    fn normalized(&self, x: usize, y: usize) -> (f32, f32) {
        (self.renderer.columns[x], self.renderer.rows[y])
    }
}
