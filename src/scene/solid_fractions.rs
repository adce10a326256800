//! Solid fraction of each cell due to static solids.

use super::{Boundary, Domain, Face, Scene, Shape, Solid, SolidSurface, static_solids::Mask};
use crate::{
    error::{Error, Result},
    geometry::{HalfSpace, Polyhedron, Terrain, TriangleMesh, volumes_below},
};
use glam::{DMat3, DVec3};
use std::{collections::HashMap, f64::consts::PI};

/// Solid or fluid fraction below which a cell is entirely fluid or solid: above the rounding of decimal coordinates.
const WHOLE: f64 = 1e-4;
/// Radius below which the growth of a sphere does not increase further, cells.
const LEAST_RADIUS: f64 = 2.0;

/// Part of the identity that keeps the shift of a sharp edge bounded.
const DAMPING: f64 = 1e-3;
/// Angle, in radians, below which a corner does not move.
const LEAST_ANGLE: f64 = 1e-9;

/// The cells that the solids of a scene fill.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidFractions {
    /// The cells that are entirely solid.
    pub mask: Mask,
    /// Index (x fastest, ascending) and solid fraction of the cells that are partially solid.
    pub partial: Vec<(u32, f32)>,
}

impl SolidFractions {
    /// The fraction of a cell that the solids leave open.
    pub fn open(&self, cell: [u32; 3]) -> f64 {
        if self.mask.is_solid(cell) {
            return 0.0;
        }
        let index = self.mask.index(cell) as u32;
        let found = self.partial.binary_search_by_key(&index, |(cell, _)| *cell);
        found.map_or(1.0, |place| 1.0 - f64::from(self.partial[place].1))
    }
}

/// By how much solids are larger for the weight than in truth.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Growth {
    /// Of the radius R of a sphere times R, cells².
    pub sphere: f64,
    /// Outward shift of a plane with the unit normal n over 1 − Σn_a⁴, cells.
    pub oblique: f64,
}

impl Scene {
    /// The cells that the solids of the scene fill, entirely or partially. If several solids cut a cell, their fractions add
    /// up, to at most one. Cells at pressure faces are entirely solid from one half on, and fluid below.
    ///
    /// # Errors
    /// If the file of a mesh or terrain cannot be read, a mesh is open or lies wholly outside the domain, a terrain leaves a
    /// part of the domain without heights, or no fluid is left.
    pub fn solid_fractions(&self) -> Result<SolidFractions> {
        self.effective_solid_fractions(Growth::default())
    }

    /// As [`Self::solid_fractions`], of the solids enlarged by `growth`.
    pub(crate) fn effective_solid_fractions(&self, growth: Growth) -> Result<SolidFractions> {
        let mut mask = Mask::new(self.cells())?;
        let mut partial = Vec::new();
        if self.solids.iter().any(Solid::is_exact) {
            let mut filled = vec![0f32; mask.as_slice().len()];
            self.fill_solids(growth, |solid, cell, part| {
                let filled = &mut filled[mask.index(cell)];
                *filled = match solid.void {
                    false => (*filled + part as f32).min(1.0),
                    true => filled.min(1.0 - part as f32),
                };
            })?;
            let cells = self.domain.cells();
            let some = (0..).zip(filled).filter(|(_, part)| *part > 0.0);
            for (n, part) in some {
                let cell = place(cells, n);
                // An outflow face continues the state of its cells, which grows in cells that are partially solid.
                let whole = if self.is_at_outlet(cell) { 0.5 } else { WHOLE };
                if f64::from(part) >= 1.0 - whole {
                    mask.set(cell, true);
                } else if f64::from(part) > whole {
                    partial.push((n, part));
                }
            }
        } else {
            self.fill_solids(growth, |solid, cell, _| mask.set(cell, !solid.void))?;
        }
        if mask.solid_count() == mask.as_slice().len() {
            return Err(Error::scene(
                "solids",
                "the solids fill the whole domain; leave some fluid, for example turn a half \
                 space by reversing its normal (it points out of the solid)",
            ));
        }
        Ok(SolidFractions { mask, partial })
    }

    /// Whether a pressure face is next to a cell.
    fn is_at_outlet(&self, cell: [u32; 3]) -> bool {
        let cells = self.domain.cells();
        let at = |face: Face| {
            let axis = face.axis().index();
            cell[axis] == if face.is_max() { cells[axis] - 1 } else { 0 }
        };
        let mut faces = self.boundaries.iter();
        faces.any(|(face, boundary)| matches!(boundary, Boundary::Pressure { .. }) && at(face))
    }

    /// Calls `mark` for each cell of each solid and hole, in their order, with the fraction that they fill.
    pub(super) fn fill_solids(
        &self,
        growth: Growth,
        mut mark: impl FnMut(&Solid, [u32; 3], f64),
    ) -> Result<()> {
        for (index, solid) in self.solids.iter().enumerate() {
            let key = format!("solids[{index}]");
            if solid.is_exact() {
                let terrain = matches!(solid.shape, Shape::Terrain { .. });
                let mut triangles = self.surface_of(&key, solid, growth)?;
                if !matches!(solid.shape, Shape::Sphere { .. }) {
                    let sign = if solid.void { -1.0 } else { 1.0 };
                    let shift = sign * growth.oblique * self.domain.cell;
                    shift_oblique(&mut triangles, shift, terrain);
                }
                let gap = fill(&triangles, &self.domain, terrain, |cell, part| {
                    mark(solid, cell, part)
                });
                self.check_covered(&key, gap)?;
            } else {
                self.fill_by_centres(&key, solid, |cell| mark(solid, cell, 1.0))?;
            }
        }
        Ok(())
    }

    /// The mesh of a solid, which must be closed and reach into the domain; `None` for other shapes.
    pub(super) fn solid_mesh(&self, key: &str, shape: &Shape) -> Result<Option<TriangleMesh>> {
        let Shape::Mesh {
            file,
            scale,
            translate,
        } = shape
        else {
            return Ok(None);
        };
        let path = self.dir().join(file);
        let mesh = TriangleMesh::read(&path, *scale, *translate)?;
        let (min, max) = mesh.bounds();
        self.check_reach(&format!("{key} ({})", file.display()), min, max)?;
        mesh.closed()
            .map_err(|message| Error::file(path, message))?;
        Ok(Some(mesh))
    }

    /// The terrain of a solid; `None` for other shapes.
    pub(crate) fn terrain(&self, shape: &Shape) -> Result<Option<Terrain>> {
        match shape {
            Shape::Terrain {
                file,
                scale,
                translate,
            } => Terrain::read(&self.dir().join(file), *scale, *translate).map(Some),
            _ => Ok(None),
        }
    }

    /// The triangles of the surface of a solid, m; for a terrain only those of the height surface.
    fn surface_of(&self, key: &str, solid: &Solid, growth: Growth) -> Result<Vec<[DVec3; 3]>> {
        let shape = &solid.shape;
        if let Some(terrain) = self.terrain(shape)? {
            let (origin, end) = (self.domain.origin, self.domain.end());
            return Ok(terrain.triangles([origin[0], origin[1]], [end[0], end[1]]));
        }
        if let Some(mesh) = self.solid_mesh(key, shape)? {
            return Ok((0..mesh.triangles.len()).map(|n| mesh.corners(n)).collect());
        }
        let faces = |planes: &[HalfSpace]| {
            let (shape, centre) = Polyhedron::from_half_spaces(planes)
                .map_err(|error| error.at_key(|what| format!("{key}.{what}")))?;
            Ok(triangles_of(&shape, centre))
        };
        match shape {
            Shape::Box { min, max } => {
                let (min, max) = (DVec3::from(*min), DVec3::from(*max));
                let made = Polyhedron::cuboid(max - min)
                    .map_err(|error| error.at_key(|what| format!("{key}.{what}")))?;
                Ok(triangles_of(&made, 0.5 * (min + max)))
            }
            Shape::HalfSpace { point, normal } => {
                let mut planes = self.domain.beyond().to_vec();
                planes.push(HalfSpace::through(
                    DVec3::from(*point),
                    DVec3::from(*normal),
                ));
                faces(&planes)
            }
            Shape::Sphere { center, radius } => {
                let cell = self.domain.cell;
                let growth = if solid.void { 0.0 } else { growth.sphere };
                let radius = radius + growth * cell * cell / radius.max(LEAST_RADIUS * cell);
                Ok(sphere(DVec3::from(*center), radius, cell))
            }
            Shape::Mesh { .. } | Shape::Terrain { .. } => Ok(Vec::new()),
        }
    }

    /// Checks that a terrain has heights over all of the domain; `gap` is a column without one.
    pub(super) fn check_covered(&self, key: &str, gap: Option<[u32; 2]>) -> Result<()> {
        let Some([i, j]) = gap else {
            return Ok(());
        };
        let [x, y, _] = self.domain.centre([i, j, 0]);
        Err(Error::scene(
            format!("{key}.file"),
            format!(
                "the terrain has no height at x = {x}, y = {y} m, which is in the domain; move it with `translate`, shrink the \
                 domain, or fill the gap"
            ),
        ))
    }
}

impl Solid {
    /// Whether the fluid is bounded by the true surface, not by a staircase of cells.
    pub(super) fn is_exact(&self) -> bool {
        let usual = match self.shape {
            Shape::Terrain { .. } => SolidSurface::Exact,
            _ => SolidSurface::Staircase,
        };
        self.surface.unwrap_or(usual) == SolidSurface::Exact
    }
}

/// Calls `mark` with the fraction of each cell inside a closed surface or below a terrain; returns the first column without a
/// height of the terrain.
fn fill(
    triangles: &[[DVec3; 3]],
    domain: &Domain,
    terrain: bool,
    mut mark: impl FnMut([u32; 3], f64),
) -> Option<[u32; 2]> {
    let origin = DVec3::from(domain.origin);
    let in_cells = |corners: &[DVec3; 3]| corners.map(|p| (p - origin) / domain.cell);
    let triangles: Vec<_> = triangles.iter().map(in_cells).collect();
    let mut gap = None;
    volumes_below(&triangles, domain.cells(), |[i, j], volumes, covered| {
        if terrain && covered < 1.0 - WHOLE {
            gap = gap.or(Some([i, j]));
        }
        for (k, volume) in (0..).zip(volumes) {
            // An inverted mesh has −1 inside.
            let part = volume.abs().min(1.0);
            if part > 0.0 {
                mark([i, j, k], part);
            }
        }
    });
    gap
}

/// Moves the surface outwards by `shift` (1 − Σn_a⁴) m where its normal is n: each corner so far along the normals of its triangles,
/// as closely as one vector can; the corners of a terrain along z.
fn shift_oblique(triangles: &mut [[DVec3; 3]], shift: f64, terrain: bool) {
    if shift == 0.0 {
        return;
    }
    let volume: f64 = triangles.iter().map(|[a, b, c]| a.dot(b.cross(*c))).sum();
    let outwards = if terrain { 1.0 } else { volume.signum() };
    let key = |p: DVec3| (p + 0.0).to_array().map(f64::to_bits);
    let mut corners = HashMap::<_, (DMat3, DVec3)>::new();
    for triangle in &*triangles {
        let [a, b, c] = *triangle;
        let normal = outwards * (b - a).cross(c - a).normalize_or_zero();
        if normal == DVec3::ZERO {
            continue;
        }
        let squares = normal * normal;
        let by = shift * (1.0 - squares.dot(squares));
        for [p, next, last] in [[a, b, c], [b, c, a], [c, a, b]] {
            let (matrix, sum) = corners.entry(key(p)).or_insert((DMat3::ZERO, DVec3::ZERO));
            let angle = (next - p).angle_between(last - p);
            let column = angle * normal;
            *matrix += DMat3::from_cols(column * normal.x, column * normal.y, column * normal.z);
            *sum += column * by;
        }
    }
    let moved = |(matrix, sum): &(DMat3, DVec3)| match terrain {
        true => DVec3::Z * sum.z / matrix.z_axis.z.max(LEAST_ANGLE),
        false => {
            let trace = matrix.x_axis.x + matrix.y_axis.y + matrix.z_axis.z;
            let damped =
                *matrix + DMat3::from_diagonal(DVec3::splat(DAMPING * trace + LEAST_ANGLE));
            damped.inverse() * *sum
        }
    };
    for p in triangles.iter_mut().flatten() {
        *p += corners.get(&key(*p)).map_or(DVec3::ZERO, moved);
    }
}

/// Indices i, j, k of the cell n of a grid, x fastest.
fn place([nx, ny, _]: [u32; 3], n: u32) -> [u32; 3] {
    [n % nx, n / nx % ny, n / (nx * ny)]
}

/// The triangles of a polyhedron about `centre`, counter-clockwise seen from outside.
fn triangles_of(shape: &Polyhedron, centre: DVec3) -> Vec<[DVec3; 3]> {
    let corner = |n: u32| shape.vertices()[n as usize] + centre;
    let fan = |face: &Vec<u32>| {
        let (first, rest) = (face[0], face[1..].to_vec());
        (1..rest.len()).map(move |n| [first, rest[n - 1], rest[n]])
    };
    let all = shape.loops().iter().flat_map(fan);
    all.map(|corners| corners.map(corner)).collect()
}

/// A triangulated sphere with edges of at most a quarter of a cell (m) and exactly the volume of the sphere.
fn sphere(centre: DVec3, radius: f64, cell: f64) -> Vec<[DVec3; 3]> {
    let rings = ((PI * radius / (0.25 * cell)).ceil() as usize).clamp(24, 2000);
    let step = PI / rings as f64;
    let at = |ring: usize, n: usize| {
        let (polar, turn) = ((step * ring as f64).sin_cos(), (step * n as f64).sin_cos());
        DVec3::new(polar.0 * turn.1, polar.0 * turn.0, polar.1)
    };
    let mut all = Vec::with_capacity(4 * rings * rings);
    for ring in 0..rings {
        for n in 0..2 * rings {
            let (a, b) = (at(ring, n), at(ring + 1, n));
            let (c, d) = (at(ring + 1, n + 1), at(ring, n + 1));
            all.extend([[a, b, c], [a, c, d]]);
        }
    }
    let six_volumes: f64 = all.iter().map(|[a, b, c]| a.dot(b.cross(*c))).sum();
    let grown = radius * (8.0 * PI / six_volumes).cbrt();
    all.iter()
        .map(|corners| corners.map(|p| centre + grown * p))
        .collect()
}
