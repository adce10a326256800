//! Vertices, placements and few draw calls of a drawing.
//!
//! A mesh with many instances is stored once and drawn once for all of them. Meshes with few instances, such as the blocks
//! of a rock mass, which all differ, are placed on the host and drawn together.

use super::drawing::{Drawing, Instance};
use super::drops::Dot;
use super::mesh::Vertex;
use super::scales::Scales;
use super::strokes::End;
use bytemuck::{Pod, Zeroable};
use glam::{DMat3, DVec3};
use std::ops::Range;

/// Number of instances from which a mesh has its own draw call.
const MANY: usize = 8;
/// Colour of free bodies without a value: dry sandstone.
const STONE: [u8; 3] = [205, 190, 165];
/// Colour of fixed bodies.
const FIXED: [u8; 3] = [150, 150, 150];
/// Brightness of edges relative to that of their body.
const EDGE: f64 = 0.25;
/// Half of an edge's width, in pixels and relative to the body's radius, so that edges of small bodies do not cover
/// them.
const EDGE_HALF_WIDTH: (f32, f64) = (0.6, 0.014);
/// Radius of a body from which its edges are drawn, pixels: at this radius they are a seventh of a pixel wide.
const EDGES_FROM: f64 = 5.0;
const WHITE: [u8; 4] = [u8::MAX; 4];

/// A corner of a triangle, as in body.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Corner {
    position: [f32; 3],
    normal: [i16; 4],
    colour: [u8; 4],
}

/// Position of a mesh and its colour.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Placement {
    rows: [[f32; 4]; 3],
    tint: [u8; 4],
}

/// A draw call.
#[derive(Clone, Debug)]
pub struct Batch {
    /// Indices.
    pub indices: Range<u32>,
    /// Placements.
    pub placements: Range<u32>,
}

/// Vertices of one kind with the draw calls that use them.
#[derive(Debug)]
pub struct List<V> {
    /// Vertices.
    pub vertices: Vec<V>,
    /// Three per triangle.
    pub indices: Vec<u32>,
    /// Draw calls.
    pub batches: Vec<Batch>,
}

/// Everything to be drawn, relative to the camera's target.
#[derive(Debug)]
pub struct Geometry {
    /// Surfaces of bodies.
    pub solid: List<Corner>,
    /// Edges and lines.
    pub strokes: List<End>,
    /// Small balls.
    pub dots: Vec<Dot>,
    /// Placements; the first one is the identity.
    pub placements: Vec<Placement>,
    /// Smallest and largest coordinates of all bodies that cast shadows, m; `None` if nothing does.
    pub bounds: Option<[DVec3; 2]>,
}

impl Geometry {
    /// The geometry of a drawing relative to `target` (m), with its colours and the pixels per metre at a position.
    pub fn new(
        drawing: &Drawing<'_>,
        target: DVec3,
        scales: &Scales,
        pixels_per_metre: impl Fn(DVec3) -> f64,
    ) -> Self {
        let colour = |body: &Instance| match body.value {
            _ if body.fixed => FIXED,
            Some(value) => scales.body(value),
            None => STONE,
        };
        let mut geometry = Self {
            solid: List::default(),
            strokes: List::default(),
            dots: drawing
                .drops
                .iter()
                .flat_map(|drops| drops.dots(target, scales))
                .collect(),
            placements: vec![Placement::new(DVec3::ZERO, DMat3::IDENTITY, [u8::MAX; 3])],
            bounds: None,
        };
        let mut bodies: Vec<Vec<&Instance>> = vec![Vec::new(); drawing.meshes.len()];
        for body in &drawing.instances {
            bodies[body.mesh].push(body);
        }
        for (mesh, bodies) in drawing.meshes.iter().zip(&bodies) {
            let radius = mesh.radius();
            let half_width = [EDGE_HALF_WIDTH.0, (EDGE_HALF_WIDTH.1 * radius) as f32];
            let has_edges = |body: &&Instance| radius * pixels_per_metre(body.centre) >= EDGES_FROM;
            for body in bodies {
                geometry.widen(body.centre - target, body.deformation, &mesh.vertices);
            }
            if bodies.len() < MANY {
                for body in bodies {
                    let (centre, turn) = (body.centre - target, body.deformation);
                    let cofactors = cofactors(turn);
                    let [r, g, b] = colour(body);
                    let corners = mesh.vertices.iter().map(|vertex| {
                        let normal = (cofactors * vertex.normal).normalize_or_zero();
                        Corner::new(centre + turn * vertex.position, normal, [r, g, b, u8::MAX])
                    });
                    geometry.solid.push(corners, &mesh.triangles);
                    let edges = mesh.edges.iter().filter(|_| has_edges(body));
                    for ends in edges {
                        let ends = ends.map(|end| centre + turn * end);
                        geometry.strokes.stroke(ends, dark([r, g, b]), half_width);
                    }
                }
                continue;
            }
            let first = geometry.placements.len() as u32;
            geometry.placements.extend(
                bodies.iter().map(|body| {
                    Placement::new(body.centre - target, body.deformation, colour(body))
                }),
            );
            let placements = first..geometry.placements.len() as u32;
            // Meshes placed on the host have their own batch, which ends here.
            geometry.solid.close();
            let corners = mesh.vertices.iter();
            let corners = corners.map(|v| Corner::new(v.position, v.normal, WHITE));
            geometry.solid.push(corners, &mesh.triangles);
            geometry.solid.close_with(placements.clone());
            geometry.strokes.close();
            let any_edges = bodies.iter().any(has_edges);
            for &ends in mesh.edges.iter().filter(|_| any_edges) {
                let colour = dark([u8::MAX; 3]);
                geometry.strokes.stroke(ends, colour, half_width);
            }
            geometry.strokes.close_with(placements);
        }
        for line in &drawing.lines {
            let [r, g, b] = line.colour;
            let half_width = [0.5 * line.width as f32, f32::MAX];
            let ends = line.ends.map(|end| end - target);
            geometry
                .strokes
                .stroke(ends, [r, g, b, u8::MAX], half_width);
        }
        for plane in &drawing.planes {
            geometry.strokes.border(plane, target);
        }
        for trace in drawing.traces.iter().flat_map(|traces| &traces.lines) {
            geometry
                .strokes
                .trace(trace, target, scales, &pixels_per_metre);
        }
        geometry.solid.close();
        geometry.strokes.close();
        geometry
    }

    fn widen(&mut self, centre: DVec3, turn: DMat3, vertices: &[Vertex]) {
        for vertex in vertices {
            let place = centre + turn * vertex.position;
            let [low, high] = self.bounds.unwrap_or([place; 2]);
            self.bounds = Some([low.min(place), high.max(place)]);
        }
    }
}

impl<V> Default for List<V> {
    fn default() -> Self {
        Self {
            vertices: Vec::new(),
            indices: Vec::new(),
            batches: Vec::new(),
        }
    }
}

impl<V> List<V> {
    /// Triangles drawn, instances included.
    pub fn triangles(&self) -> usize {
        let batches = self.batches.iter();
        batches
            .map(|batch| batch.indices.len() / 3 * batch.placements.len())
            .sum()
    }

    pub fn push(&mut self, vertices: impl Iterator<Item = V>, triangles: &[[u32; 3]]) {
        let first = self.vertices.len() as u32;
        self.vertices.extend(vertices);
        let indices = triangles.iter().flatten();
        self.indices.extend(indices.map(|index| first + index));
    }

    /// Ends the batch of meshes that were placed on the host.
    fn close(&mut self) {
        self.close_with(0..1);
    }

    fn close_with(&mut self, placements: Range<u32>) {
        let begin = self.batches.last().map_or(0, |batch| batch.indices.end);
        let indices = begin..self.indices.len() as u32;
        if !indices.is_empty() {
            self.batches.push(Batch {
                indices,
                placements,
            });
        }
    }
}

impl Corner {
    fn new(position: DVec3, normal: DVec3, colour: [u8; 4]) -> Self {
        let whole = |value: f64| (value * f64::from(i16::MAX)).round() as i16;
        Self {
            position: position.as_vec3().to_array(),
            normal: [whole(normal.x), whole(normal.y), whole(normal.z), 0],
            colour,
        }
    }
}

impl Placement {
    fn new(centre: DVec3, turn: DMat3, [r, g, b]: [u8; 3]) -> Self {
        let rows = [0, 1, 2].map(|row| {
            let r = turn.row(row);
            [r.x, r.y, r.z, centre[row]].map(|value| value as f32)
        });
        Self {
            rows,
            tint: [r, g, b, u8::MAX],
        }
    }
}

fn dark(colour: [u8; 3]) -> [u8; 4] {
    let [r, g, b] = colour.map(|channel| (EDGE * f64::from(channel)).round() as u8);
    [r, g, b, u8::MAX]
}

/// The cofactor matrix of `m`, which transforms normals as `m` transforms surfaces.
fn cofactors(m: DMat3) -> DMat3 {
    DMat3::from_cols(
        m.y_axis.cross(m.z_axis),
        m.z_axis.cross(m.x_axis),
        m.x_axis.cross(m.y_axis),
    )
}
