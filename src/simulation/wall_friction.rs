//! Friction on walls and blocks with a wall model, in SI.

use super::{Simulation, lattice_fluid::LatticeFluid};
use crate::{
    Result,
    lattice::{BlockFace, WallCell, WallStress, in_plane},
    output::{Array, Surface},
    scene::{Axis, Face},
};
use std::collections::HashSet;

/// The object to which a wall with a wall model belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum WallPlace {
    /// A face of the domain.
    Face(Face),
    /// Solids at rest.
    Solids,
    /// Blocks.
    Blocks,
}

impl WallPlace {
    /// Its name in tables: the name of the face, `solids` or `blocks`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Face(face) => face.name(),
            Self::Solids => "solids",
            Self::Blocks => "blocks",
        }
    }
}

/// Friction on a wall next to a cell in the last step, or on the face of a block over a cell in the next step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallFriction {
    /// Centre of the cell face on the wall, m.
    pub position: [f64; 3],
    /// Unit normal into the fluid.
    pub normal: [f64; 3],
    /// Area, m². At an edge of a sloping face it includes what lies beyond the columns with full cells.
    pub area: f64,
    /// Object to which the wall belongs.
    pub place: WallPlace,
    /// Stress along the wall, Pa. On a no-slip wall it alternates from step to step at low viscosity.
    pub stress: [f64; 3],
    /// Friction velocity u_τ by the law of the wall, m/s.
    pub friction_velocity: f64,
    /// u_τ y/ν half a cell from the wall.
    pub y_plus: f64,
    /// Share of the stress that follows from the law of the wall: 0 on a no-slip wall, 1 for the law alone.
    pub share: f64,
}

/// The walls on which the wall model of a scene acts, and the friction there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WallFrictions {
    /// Each wall next to a cell, without those near a block, which are no-slip.
    pub walls: Vec<WallFriction>,
    /// Edge of a cell, m.
    pub cell: f64,
    /// Fraction of the area of walls and solids at rest on which the model acts; corners, convex edges, gaps under five cells and
    /// cells at open or moving faces are no-slip.
    pub area_share: f64,
    /// The same fraction of the faces of blocks; 0 without blocks.
    pub block_area_share: f64,
}

impl Simulation {
    /// The friction on walls with a wall model; empty without one, and before the second step.
    ///
    /// # Errors
    /// If the scene has no fluid on a lattice, or the device is lost.
    pub async fn wall_friction(&mut self) -> Result<WallFrictions> {
        let fluid = self.lattice_fluid()?;
        let stresses = fluid
            .lattice
            .wall_stresses(&fluid.device, &fluid.queue)
            .await?;
        let blocks = fluid
            .lattice
            .block_faces(&fluid.device, &fluid.queue)
            .await?;
        let lattice = &fluid.lattice;
        let surfaces = lattice.surface_faces(&fluid.device, &fluid.queue).await?;
        let walls = &lattice.geometry().walls;
        let blocked = lattice
            .walls_near_blocks(&fluid.device, &fluid.queue)
            .await?;
        let each = walls.cells.iter().zip(&stresses).zip(blocked);
        let open = each.filter(|(_, blocked)| !blocked);
        let on_walls = open.map(|((wall, stress), _)| fluid.wall_friction(wall, stress));
        let on_face = |face, place| fluid.face_friction(face, place);
        let on_surfaces = surfaces.iter().map(|face| on_face(face, WallPlace::Solids));
        let on_walls: Vec<_> = on_walls.chain(on_surfaces).collect();
        let on_blocks = blocks
            .faces
            .iter()
            .map(|face| on_face(face, WallPlace::Blocks));
        let share = |some: usize, all: u64| some as f64 / all.max(1) as f64;
        Ok(WallFrictions {
            area_share: share(on_walls.len(), walls.area),
            walls: on_walls.into_iter().chain(on_blocks).collect(),
            cell: fluid.units.cell,
            block_area_share: share(blocks.faces.len(), blocks.area),
        })
    }
}

impl Simulation {
    /// The objects with a wall model anywhere: faces of the domain, solids, and blocks, if there are any; empty without one.
    pub fn wall_places(&self) -> Vec<WallPlace> {
        let Ok(fluid) = self.lattice_fluid() else {
            return Vec::new();
        };
        let walls = &fluid.lattice.geometry().walls.cells;
        let place = |wall: &WallCell| fluid.wall_friction(wall, &WallStress::default()).place;
        let mut found: HashSet<_> = walls.iter().map(place).collect();
        if fluid.lattice.geometry().surface_faces.count > 0 {
            found.insert(WallPlace::Solids);
        }
        if fluid.lattice.setup().has_block_friction() {
            found.insert(WallPlace::Blocks);
        }
        let faces = Face::ALL.into_iter().map(WallPlace::Face);
        let all = faces.chain([WallPlace::Solids, WallPlace::Blocks]);
        all.filter(|place| found.contains(place)).collect()
    }
}

impl LatticeFluid {
    fn wall_friction(&self, wall: &WallCell, received: &WallStress) -> WallFriction {
        let (units, grid) = (&self.units, self.lattice.grid());
        let (axis, side) = (wall.face as usize / 2, wall.face as usize % 2);
        let cell = grid.padded_cell(wall.cell);
        let mut normal = [0.0; 3];
        normal[axis] = [1.0, -1.0][side];
        let mut position = self.scene.centre(cell);
        position[axis] -= 0.5 * units.cell * normal[axis];
        let mut stress = [0.0; 3];
        let (a, b) = in_plane(axis);
        for (axis, value) in [a, b].into_iter().zip(received.stress) {
            stress[axis] = units.stress_from_lattice(f64::from(value));
        }
        let friction_velocity = units.velocity_from_lattice(f64::from(received.friction));
        let at_end = cell[axis] == [0, grid.cells[axis] - 1][side];
        let faces = self.scene.boundaries.iter();
        let mut own = faces.filter(|(face, _)| {
            face.axis() == Axis::ALL[axis] && usize::from(face.is_max()) == side
        });
        let face = own
            .next()
            .filter(|_| at_end && !self.lattice.setup().periodic_axes()[axis]);
        WallFriction {
            position,
            normal,
            area: units.cell.powi(2),
            place: face.map_or(WallPlace::Solids, |(face, _)| WallPlace::Face(face)),
            stress,
            friction_velocity,
            y_plus: self.wall_units_of(friction_velocity),
            share: received.share.into(),
        }
    }

    fn face_friction(&self, face: &BlockFace, place: WallPlace) -> WallFriction {
        let (units, grid) = (&self.units, self.lattice.grid());
        let (axis, side) = (face.face as usize / 2, face.face as usize % 2);
        let normal = face.normal.map(f64::from);
        let cell = grid.padded_cell(face.cell);
        let mut position = self.scene.centre(cell);
        position[axis] += (0.5 + f64::from(face.fraction)) * units.cell * [-1.0, 1.0][side];
        let friction_velocity = units.velocity_from_lattice(f64::from(face.friction));
        WallFriction {
            position,
            normal,
            area: f64::from(face.area) * units.cell.powi(2),
            place,
            stress: face
                .stress
                .map(|value| units.stress_from_lattice(value.into())),
            friction_velocity,
            y_plus: self.wall_units_of(friction_velocity),
            share: face.share.into(),
        }
    }

    /// y⁺ half a cell from a wall.
    fn wall_units_of(&self, friction_velocity: f64) -> f64 {
        friction_velocity * 0.5 * self.units.cell / self.scene.fluid.viscosity
    }
}

/// The walls as squares with the stress vector (Pa), u_τ (m/s), y⁺ and the share of the law.
pub fn wall_surface(frictions: &WallFrictions) -> Surface {
    let half = 0.5 * frictions.cell;
    let walls = &frictions.walls;
    let square = |wall: &WallFriction| {
        // A sloping face has the part within the column of a cell.
        let size = wall.normal.map(f64::abs);
        let axis = (1..3).fold(
            0,
            |best, axis| if size[axis] > size[best] { axis } else { best },
        );
        let (a, b) = in_plane(axis);
        let rise = |along: usize| -wall.normal[along] / wall.normal[axis];
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[i, j]| {
                let mut corner = wall.position;
                corner[a] += i * half;
                corner[b] += j * half;
                corner[axis] += (i * rise(a) + j * rise(b)) * half;
                corner
            })
            .to_vec()
    };
    Surface {
        polygons: walls.iter().map(square).collect(),
        arrays: vec![
            Array::vectors("stress", walls.iter().map(|wall| wall.stress.into())),
            Array::scalars(
                "friction_velocity",
                walls.iter().map(|wall| wall.friction_velocity),
            ),
            Array::scalars("y_plus", walls.iter().map(|wall| wall.y_plus)),
            Array::scalars("model_share", walls.iter().map(|wall| wall.share)),
            Array::scalars("area", walls.iter().map(|wall| wall.area)),
        ],
    }
}
