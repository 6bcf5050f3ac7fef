use super::lanes::{self, LID, Lanes};
use crate::paint::{Light, Texture};
use crate::world::Shape;
use trundle_core::{Pose3, Vector3};

/// Directions of the two lamps, world frame, and their strengths; the rest is ambient.
const LAMPS: [([f32; 3], f32); 2] = [([0.31, 0.45, 0.84], 0.24), ([-0.62, -0.52, 0.59], 0.12)];
const AMBIENT: f32 = 0.64;

/// Below this cosine of incidence a pixel gets two samples along its long footprint.
const SLANT: f32 = 0.5;

/// A solid as the camera sees it in one image: everything in the solid's own frame, f32.
#[derive(Debug)]
pub(super) struct Seen<'w> {
    form: Form,
    /// The camera's centre, solid frame, m.
    origin: [f32; 3],
    /// `solid_from_camera`, rotation, by rows.
    turn: [[f32; 3]; 3],
    /// Light on each face of a box, of 256.
    light: [u32; 6],
    paintings: &'w [Texture],
}

#[derive(Debug, Clone, Copy)]
enum Form {
    /// Half sides, origin in the middle.
    Cuboid([f32; 3]),
    /// Radius and height, origin in the middle of the lower disc.
    Cylinder(f32, f32),
}

/// What a pixel sees.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look {
    /// 0 to 255, before the sensor's noise.
    pub(super) color: [u8; 3],
    /// Cosine of the angle between the ray and the surface's normal.
    pub(super) cosine: f32,
}

/// A point of a painted face: which face, where (m), the normal, and how the ray runs along it.
struct Spot {
    face: usize,
    uv: [f32; 2],
    normal: [f32; 3],
    along: [f32; 2],
}

impl<'w> Seen<'w> {
    pub(super) fn new(shape: &Shape, paintings: &'w [Texture], world_from_camera: &Pose3) -> Self {
        let (form, place, yaw) = match shape {
            Shape::Cuboid(c) => (Form::Cuboid((c.size / 2.0).map(|x| x as f32).into()), c.center, c.yaw),
            Shape::Cylinder(c) => (Form::Cylinder(c.radius as f32, c.height as f32), c.base, 0.0),
        };
        let solid_from_world = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), -yaw).into_inner();
        let turn = (solid_from_world * world_from_camera.rotation_matrix()).map(|x| x as f32);
        let origin = (solid_from_world * (world_from_camera.translation - place)).map(|x| x as f32);
        let rows = [0, 1, 2].map(|i| [turn[(i, 0)], turn[(i, 1)], turn[(i, 2)]]);
        Self { form, origin: origin.into(), turn: rows, light: light_on_faces(yaw as f32), paintings }
    }

    /// The ray through normalised image coordinates (x, y), solid frame; its part along the optical axis is 1.
    fn direction(&self, x: f32, y: f32) -> [f32; 3] {
        self.turn.map(|row| row[0] * x + row[1] * y + row[2])
    }

    /// Meets a row of rays that start at (x, y) and step by `step` in x; keeps what is nearer than `lanes` has.
    pub(super) fn meet(&self, (x, y): (f32, f32), step: f32, index: u32, lanes: &mut Lanes) {
        let start = self.direction(x, y);
        let step = self.turn.map(|row| row[0] * step);
        match self.form {
            Form::Cuboid(half) => lanes::meet_cuboid(self.origin, half, start, step, index, lanes),
            Form::Cylinder(radius, height) => {
                lanes::meet_cylinder(self.origin, (radius, height), start, step, index, lanes);
            }
        }
    }

    /// What the ray through (x, y) sees at `depth` m on the solid's `part` (see [`Lanes`]); `pixel` is a pixel's size at 1 m.
    pub(super) fn look(&self, part: u32, (x, y): (f32, f32), depth: f32, pixel: f32) -> Look {
        let d = self.direction(x, y);
        let p = [0, 1, 2].map(|k| self.origin[k] + depth * d[k]);
        let spot = match self.form {
            Form::Cuboid(half) => self.spot_on_cuboid(part, half, p, d),
            Form::Cylinder(radius, height) => spot_on_cylinder(part, radius, height, p, d),
        };
        let length = (x * x + y * y + 1.0).sqrt();
        let cosine = (dot(spot.normal, d).abs() / length).clamp(1e-3, 1.0);
        let light = match self.form {
            Form::Cuboid(_) => self.light[spot.face],
            Form::Cylinder(..) => light_on(spot.normal),
        };
        Look { color: self.filtered(&spot, depth * pixel, cosine).dimmed(light), cosine }
    }

    fn spot_on_cuboid(&self, axis: u32, h: [f32; 3], p: [f32; 3], d: [f32; 3]) -> Spot {
        let axis = axis as usize;
        let sign = self.origin[axis].signum();
        let mut normal = [0.0; 3];
        normal[axis] = sign;
        // Seen from outside with z up, u runs to the right and v down; on the lids u is x, and v runs against y on top.
        let (uv, along) = match axis {
            0 => ([h[1] + sign * p[1], h[2] - p[2]], [sign * d[1], -d[2]]),
            1 => ([h[0] - sign * p[0], h[2] - p[2]], [-sign * d[0], -d[2]]),
            _ => ([h[0] + p[0], h[1] - sign * p[1]], [d[0], -sign * d[1]]),
        };
        Spot { face: 2 * axis + usize::from(sign < 0.0), uv, normal, along }
    }

    /// The mean colour of the pixel's footprint; at a slant two samples along its long axis, each as wide as half of it.
    fn filtered(&self, spot: &Spot, footprint: f32, cosine: f32) -> Light {
        let texture = &self.paintings[spot.face];
        let ([u, v], [du, dv]) = (spot.uv, spot.along);
        if cosine > SLANT {
            // One sample as wide as the footprint's mean side.
            return texture.sample(u, v, footprint / cosine.sqrt());
        }
        let half = 0.5 * footprint / cosine;
        let shift = 0.5 * half / (du * du + dv * dv).sqrt().max(1e-6);
        let width = footprint.max(half);
        let near = texture.sample(u - shift * du, v - shift * dv, width);
        near.blend(texture.sample(u + shift * du, v + shift * dv, width), 128)
    }
}

fn light_on_faces(yaw: f32) -> [u32; 6] {
    let (s, c) = yaw.sin_cos();
    let normals = [[c, s, 0.0], [-c, -s, 0.0], [-s, c, 0.0], [s, -c, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    normals.map(light_on)
}

/// Light on a surface with this normal, world frame, of 256.
fn light_on(normal: [f32; 3]) -> u32 {
    let lamps = LAMPS.iter().map(|(lamp, strength)| strength * dot(*lamp, normal).max(0.0)).sum::<f32>();
    ((AMBIENT + lamps) * 256.0) as i32 as u32
}

fn spot_on_cylinder(part: u32, radius: f32, height: f32, p: [f32; 3], d: [f32; 3]) -> Spot {
    if part != LID {
        let (x, y) = (p[0] / radius, p[1] / radius);
        let u = (y.atan2(x) + std::f32::consts::PI) * radius;
        Spot { face: 0, uv: [u, height - p[2]], normal: [x, y, 0.0], along: [x * d[1] - y * d[0], -d[2]] }
    } else {
        let sign = if p[2] > height / 2.0 { 1.0 } else { -1.0 };
        let face = if sign > 0.0 { 1 } else { 2 };
        Spot {
            face,
            uv: [p[0] + radius, radius - sign * p[1]],
            normal: [0.0, 0.0, sign],
            along: [d[0], -sign * d[1]],
        }
    }
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
