//! Vertex colours as a picture: each triangle has a patch of two by two texels.

use super::srgb::srgb;
use std::collections::BTreeMap;
use trundle_core::ColorImage;

/// The colours of the triangles of each material with vertex colours.
#[derive(Debug, Default)]
pub(super) struct Painting {
    /// Triangles by the index of their material.
    triangles: BTreeMap<usize, Vec<PaintedTriangle>>,
}

/// A triangle with colours.
#[derive(Debug)]
struct PaintedTriangle {
    /// Index of its first corner in the mesh; the others follow.
    first: usize,
    /// Linear shares of red, green and blue, of each corner.
    colors: [[f32; 3]; 3],
}

impl Painting {
    /// Adds a triangle whose corners are three positions of the mesh in a row, from `first` on.
    pub(super) fn add(&mut self, material: usize, first: usize, colors: [[f32; 3]; 3]) {
        self.triangles.entry(material).or_default().push(PaintedTriangle { first, colors });
    }

    /// Sets the texture coordinates of all triangles: the middles of three texels of their patches.
    pub(super) fn place(&self, uvs: &mut [[f32; 2]]) {
        for triangles in self.triangles.values() {
            let side = side_of(triangles.len());
            let unit = 1.0 / (2 * side) as f32;
            for (i, PaintedTriangle { first, .. }) in triangles.iter().enumerate() {
                let (x, y) = ((2 * (i % side)) as f32, (2 * (i / side)) as f32);
                for (corner, [dx, dy]) in [[0.5, 0.5], [1.5, 0.5], [0.5, 1.5]].into_iter().enumerate() {
                    uvs[first + corner] = [(x + dx) * unit, (y + dy) * unit];
                }
            }
        }
    }

    /// The picture of a material, if it has one. The fourth texel of a patch makes the blend between the others linear.
    pub(super) fn picture(&self, material: usize) -> Option<ColorImage> {
        let triangles = self.triangles.get(&material)?;
        let side = side_of(triangles.len());
        let texel = |x: usize, y: usize| {
            let Some(PaintedTriangle { colors, .. }) = triangles.get(y / 2 * side + x / 2) else {
                return [0; 3];
            };
            let [a, b, c] = colors.map(|color| color.map(srgb));
            match (x % 2, y % 2) {
                (0, 0) => a,
                (1, 0) => b,
                (0, _) => c,
                _ => std::array::from_fn(|k| fourth(a[k], b[k], c[k])),
            }
        };
        Some(ColorImage::from_fn(2 * side, 2 * side, texel))
    }
}

/// Patches across and down.
fn side_of(count: usize) -> usize {
    let side = count.isqrt();
    if side * side < count { side + 1 } else { side.max(1) }
}

fn fourth(a: u8, b: u8, c: u8) -> u8 {
    (i16::from(b) + i16::from(c) - i16::from(a)).clamp(0, 255) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_look_at_their_own_colours() {
        let mut painting = Painting::default();
        let (red, green, blue) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        painting.add(4, 0, [red, green, blue]);
        painting.add(4, 3, [blue; 3]);
        let mut uvs = vec![[0.0; 2]; 6];
        painting.place(&mut uvs);
        let picture = painting.picture(4).unwrap();
        let at = |[u, v]: [f32; 2]| {
            picture[((u * picture.width() as f32) as usize, (v * picture.height() as f32) as usize)]
        };
        let seen: Vec<_> = uvs.into_iter().map(at).collect();
        assert_eq!(seen[..3], [[255, 0, 0], [0, 255, 0], [0, 0, 255]]);
        assert_eq!(seen[3..], [[0, 0, 255]; 3]);
        assert!(painting.picture(0).is_none());
        assert_eq!([1, 2, 4, 5, 9].map(side_of), [1, 2, 2, 3, 3]);
    }
}
