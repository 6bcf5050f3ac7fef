//! Triangles with colours.

/// A surface of triangles, map frame, m, z up. The front of a triangle has its corners counter-clockwise.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SurfaceMesh {
    /// Positions, m.
    pub vertices: Vec<[f32; 3]>,
    /// Unit normals out of the surface, one per vertex.
    pub normals: Vec<[f32; 3]>,
    /// Colours, sRGB, one per vertex.
    pub colors: Vec<[u8; 3]>,
    /// Indices of the corners among the vertices.
    pub triangles: Vec<[u32; 3]>,
}

impl SurfaceMesh {
    /// Area, m^2.
    #[must_use]
    pub fn area(&self) -> f64 {
        let at = |index: u32| nalgebra::Vector3::from(self.vertices[index as usize]).cast::<f64>();
        let area = |t: &[u32; 3]| (at(t[1]) - at(t[0])).cross(&(at(t[2]) - at(t[0]))).norm() / 2.0;
        self.triangles.iter().map(area).sum()
    }

    /// The mesh without connected parts of fewer than `min_vertices` vertices: noise leaves specks.
    #[must_use]
    pub fn without_specks(&self, min_vertices: usize) -> Self {
        let part = self.parts();
        let mut sizes = vec![0_usize; self.vertices.len()];
        part.iter().for_each(|&root| sizes[root as usize] += 1);
        let is_kept = |vertex: usize| sizes[part[vertex] as usize] >= min_vertices;
        let mut kept = Self::default();
        let mut index = vec![u32::MAX; self.vertices.len()];
        for vertex in (0..self.vertices.len()).filter(|&vertex| is_kept(vertex)) {
            index[vertex] = kept.vertices.len() as u32;
            kept.vertices.push(self.vertices[vertex]);
            kept.normals.push(self.normals[vertex]);
            kept.colors.push(self.colors[vertex]);
        }
        let corners = self.triangles.iter().map(|triangle| triangle.map(|corner| index[corner as usize]));
        kept.triangles = corners.filter(|triangle| triangle[0] != u32::MAX).collect();
        kept
    }

    /// For each vertex the lowest-numbered vertex of its connected part.
    fn parts(&self) -> Vec<u32> {
        let mut root: Vec<u32> = (0..self.vertices.len() as u32).collect();
        for triangle in &self.triangles {
            for other in [triangle[1], triangle[2]] {
                let (a, b) = (find(&mut root, triangle[0]), find(&mut root, other));
                root[a.max(b) as usize] = a.min(b);
            }
        }
        (0..root.len() as u32).map(|vertex| find(&mut root, vertex)).collect()
    }
}

/// The root of a vertex; the path to it is halved.
fn find(root: &mut [u32], mut vertex: u32) -> u32 {
    while root[vertex as usize] != vertex {
        root[vertex as usize] = root[root[vertex as usize] as usize];
        vertex = root[vertex as usize];
    }
    vertex
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn specks_go_and_indices_follow() {
        let vertices = (0..7).map(|i| [i as f32, (i * i) as f32, 0.0]).collect();
        let mesh = SurfaceMesh {
            vertices,
            normals: vec![[0.0, 0.0, 1.0]; 7],
            colors: (0..7).map(|i| [i; 3]).collect(),
            triangles: vec![[0, 1, 2], [3, 4, 5], [4, 5, 6]],
        };
        let kept = mesh.without_specks(4);
        assert_eq!(kept.colors, [[3; 3], [4; 3], [5; 3], [6; 3]]);
        assert_eq!(kept.triangles, [[0, 1, 2], [1, 2, 3]]);
        assert_eq!(mesh.without_specks(3), mesh);
        assert!((mesh.area() - 3.0).abs() < 1e-6, "{}", mesh.area());
    }
}
