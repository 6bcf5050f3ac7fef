use crate::world::World;
use trundle_core::{PinholeCamera, Pose3, Vector2, Vector3};

/// The solids that a tile of the image may see, nearest first.
#[derive(Debug, Default)]
pub(super) struct Candidates {
    /// (least depth, m; index of the solid).
    list: Vec<(f32, u32)>,
}

/// A pyramid from the camera through a rectangle of pixels, world frame.
struct Pyramid {
    apex: Vector3,
    axis: Vector3,
    /// Inward normals of its four sides.
    sides: [Vector3; 4],
}

impl Candidates {
    /// Those of the tile whose pixels are `low` to `high`, both included.
    pub(super) fn gather(
        &mut self,
        world: &World,
        camera: &PinholeCamera,
        world_from_camera: &Pose3,
        low: (usize, usize),
        high: (usize, usize),
    ) {
        let pyramid = Pyramid::new(camera, world_from_camera, low, high);
        self.list.clear();
        let boxes = world.boxes();
        world.bvh().walk(
            &mut self.list,
            |_, bounds| pyramid.least_depth(bounds.center(), bounds.half()).is_some(),
            |list, solid| {
                if let Some(depth) = pyramid.least_depth(boxes[solid].center(), boxes[solid].half()) {
                    list.push((depth as f32, solid as u32));
                }
            },
        );
        self.list.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }

    /// (least depth, m; index of the solid), by rising depth.
    pub(super) fn list(&self) -> &[(f32, u32)] {
        &self.list
    }
}

impl Pyramid {
    fn new(
        camera: &PinholeCamera,
        world_from_camera: &Pose3,
        low: (usize, usize),
        high: (usize, usize),
    ) -> Self {
        let (x0, y0) = (low.0 as f64 - 0.5, low.1 as f64 - 0.5);
        let (x1, y1) = (high.0 as f64 + 0.5, high.1 as f64 + 0.5);
        // Clockwise in the image: each side's normal, edge x next edge, points inward.
        let edges = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
            .map(|(x, y)| world_from_camera.rotate(camera.unproject(Vector2::new(x, y), 1.0)));
        let sides = [0, 1, 2, 3].map(|i| edges[i].cross(&edges[(i + 1) % 4]));
        Self { apex: world_from_camera.translation, axis: world_from_camera.rotate(Vector3::z()), sides }
    }

    /// A lower bound of the depth of a box in the pyramid; `None` when the box lies outside a side or behind.
    fn least_depth(&self, center: Vector3, half: Vector3) -> Option<f64> {
        let from_apex = center - self.apex;
        let reach = |normal: &Vector3| normal.abs().dot(&half);
        if self.sides.iter().any(|side| side.dot(&from_apex) + reach(side) < 0.0) {
            return None;
        }
        let (depth, spread) = (self.axis.dot(&from_apex), reach(&self.axis));
        (depth + spread > 0.0).then(|| (depth - spread).max(0.0))
    }
}
