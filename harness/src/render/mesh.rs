//! The surface of a body as a mesh to draw.

use glam::DVec3;
use riprap::geometry::Polyhedron;
use std::collections::HashMap;

/// A corner of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Position relative to the body's centroid, m.
    pub position: DVec3,
    /// Outward unit normal.
    pub normal: DVec3,
}

/// A surface with flat or smooth shading, according to its normals, and the edges drawn on it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Corners; where faces meet at an edge, each has its own.
    pub vertices: Vec<Vertex>,
    /// Indices of corners, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Ends of the drawn edges relative to the centroid, m.
    pub edges: Vec<[DVec3; 2]>,
}

impl Mesh {
    /// A polyhedron with flat faces and all its edges.
    pub fn of(block: &Polyhedron) -> Self {
        let points = block.vertices();
        let mut mesh = Self::default();
        for (corners, face) in block.loops().iter().zip(block.faces()) {
            let first = mesh.vertices.len() as u32;
            mesh.vertices.extend(corners.iter().map(|&corner| Vertex {
                position: points[corner as usize],
                normal: face.normal,
            }));
            mesh.triangles.extend(
                (2..corners.len() as u32).map(|last| [first, first + last - 1, first + last]),
            );
        }
        let edges = block.edges().iter();
        mesh.edges = edges
            .map(|ends| ends.map(|end| points[end as usize]))
            .collect();
        mesh
    }

    /// A smooth sphere of `radius` (m): an icosahedron, each of its 20 triangles cut into
    /// 4^`cuts` (3 cuts look round up to about 300 pixels of diameter).
    pub fn sphere(radius: f64, cuts: u32) -> Self {
        let (mut points, mut triangles) = icosahedron();
        for _ in 0..cuts {
            let mut middles = HashMap::new();
            let mut middle = |a: u32, b: u32, points: &mut Vec<DVec3>| {
                *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                    let between = (points[a as usize] + points[b as usize]).normalize();
                    points.push(between);
                    points.len() as u32 - 1
                })
            };
            let mut finer = Vec::with_capacity(4 * triangles.len());
            for [a, b, c] in triangles {
                let ab = middle(a, b, &mut points);
                let bc = middle(b, c, &mut points);
                let ca = middle(c, a, &mut points);
                finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
            }
            triangles = finer;
        }
        let vertices = points.into_iter().map(|normal| Vertex {
            position: radius * normal,
            normal,
        });
        Self {
            vertices: vertices.collect(),
            triangles,
            edges: Vec::new(),
        }
    }

    /// Largest distance of a vertex from the centroid, m.
    pub fn radius(&self) -> f64 {
        let distances = self.vertices.iter().map(|v| v.position.length());
        distances.fold(0.0, f64::max)
    }
}

/// Vertices on the unit sphere, and triangles.
fn icosahedron() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let shape = Polyhedron::icosahedron(1.0).expect("an edge of 1 m is valid");
    let points = shape.vertices().iter().map(|v| v.normalize()).collect();
    let triangles = shape
        .loops()
        .iter()
        .map(|corners| [0, 1, 2].map(|k| corners[k]));
    let triangles = triangles.collect();
    (points, triangles)
}
