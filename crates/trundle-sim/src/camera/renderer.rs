//! The renderer: an ideal RGB-D image of a scene.

use super::band::{Band, Picture};
use super::lamps::Lamps;
use super::tile::ROWS;
use super::world_view::WorldView;
use crate::world::SceneSnapshot;
use rayon::prelude::*;
use trundle_core::{Distortion, Invalid, PinholeCamera, Pose2, Pose3};

/// An ideal RGB-D image: that of a camera without noise.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Depth along the optical axis, m, row by row; 0 without a surface.
    pub depth: Vec<f32>,
    /// sRGB, row by row.
    pub color: Vec<[u8; 3]>,
    /// Cosine of the angle between ray and surface normal, row by row; 0 without a surface.
    pub cosine: Vec<f32>,
}

/// Draws a [`SceneSnapshot`] in a rectified pinhole camera: exact perspective depth, filtered textures, Lambert's law.
///
/// The image is cut into tiles of 16 x 8 pixels. For each tile, the hierarchies are searched with the tile's pyramid, nearest boxes first,
/// until every pixel has a surface nearer than the next box. The pixels do not depend on the number of threads.
#[derive(Debug, Clone)]
pub struct Renderer {
    camera: PinholeCamera,
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
        Ok(Self { camera })
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

    /// Draws the scene as seen from `world_from_camera` into `view`, an image of [`Renderer::blank`].
    pub fn render(&self, snapshot: &SceneSnapshot<'_>, world_from_camera: &Pose3, view: &mut View) {
        let view_of =
            |world, pose, first_id| WorldView::new(world, pose, &self.camera, world_from_camera, first_id);
        let mut views = Vec::with_capacity(1 + snapshot.movers.len());
        views.push(view_of(snapshot.world, Pose2::IDENTITY, 0));
        for mover in snapshot.movers {
            let first_id = views.last().map_or(0, WorldView::end_id);
            views.push(view_of(mover.body, mover.pose, first_id));
        }
        let picture = Picture { camera: &self.camera, views: &views, lamps: &Lamps::new(snapshot.lights) };
        let band = ROWS * view.width;
        view.depth
            .par_chunks_mut(band)
            .zip(view.color.par_chunks_mut(band))
            .zip(view.cosine.par_chunks_mut(band))
            .enumerate()
            .for_each(|(i, ((depth, color), cosine))| {
                picture.draw(i * ROWS, &mut Band { depth, color, cosine });
            });
    }
}
