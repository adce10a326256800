//! Blocks in a fluid on the device.

use super::{
    FACE_LAYERS, Forms, Frame, MAX_FACES, Motion, Part, Plan,
    face_sums::FaceSums,
    frame::MAX_DISTANCE,
    kernels::Kernels,
    near_cells::{outline, rows},
    program,
    tiles::{NEIGHBOURS, Outline, Tiling},
};
use crate::{
    Error, Result,
    geometry::{Form, Pose, Shape},
    gpu::kernel::Kernel,
    lattice::Lattice,
};
use std::sync::Arc;

/// A block in a fluid.
#[derive(Clone, Debug)]
pub struct SolidBlock {
    /// Its shape, m.
    pub shape: Arc<Shape>,
    /// Whether the load of the fluid on it is needed.
    pub loaded: bool,
    /// Whether the loads on its faces are needed.
    pub faces: bool,
    /// Periodic axes along which it has no images: those that a fixed block fills because it is longer than the domain.
    pub filled: [bool; 3],
}

impl SolidBlock {
    /// A block with loads, but not on its faces, and with images along all periodic axes.
    pub fn new(shape: Arc<Shape>) -> Self {
        Self {
            shape,
            loaded: true,
            faces: false,
            filled: [false; 3],
        }
    }
}

/// Work done since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CellWork {
    /// Number of tiles whose solid fractions were computed.
    pub tiles: u64,
    /// Number of lanes of bricks that were combined.
    pub lanes: u64,
    /// Number of searches for the tiles of blocks.
    pub searches: u64,
}

/// Blocks in a fluid, as partially saturated cells.
///
/// A step is [`SolidCells::place`] with the poses of the blocks, [`SolidCells::record_cells`],
/// [`Lattice::record_psm`], [`SolidCells::record_loads`], [`Lattice::record_rest`]; then
/// [`SolidCells::wrenches`] holds the sums from which [`SolidCells::loads`] computes loads. With [`SolidCells::record_faces`] after
/// the loads, [`SolidCells::face_sums`] holds those for [`SolidCells::face_loads`]. Poses, motions and loads are SI.
#[derive(Debug)]
pub struct SolidCells {
    pub(super) frame: Frame,
    tiling: Tiling,
    /// See [`super::program::sphere_growth`].
    sphere_growth: f64,
    /// Blocks in the order of the device: those with loads first.
    pub(super) blocks: Vec<SolidBlock>,
    /// Index of each block in that order.
    pub(super) number: Vec<usize>,
    pub(super) loaded: usize,
    /// First part of each block, and first face of each part.
    first_part: Vec<u32>,
    first_face: Vec<u32>,
    faces: usize,
    pub(super) poses: Vec<Pose>,
    outlines: Vec<Vec<Outline>>,
    /// Copy of the data of blocks on the device, in its order.
    tables: Tables,
    plan: Plan,
    pub(super) kernels: Kernels,
    /// `None` unless a block requests faces.
    pub(super) face_sums: Option<FaceSums>,
    work: CellWork,
    /// The work lists on the device, unless they are empty or complete.
    listed: Option<Listed>,
}

/// Tiles and lanes of bricks that moved blocks require.
#[derive(Debug)]
struct Listed {
    moved: Vec<usize>,
    changed: Vec<usize>,
    tiles: u64,
    lanes: u64,
}

impl Listed {
    fn is_of(&self, moved: &[usize], changed: &[usize]) -> bool {
        self.moved == moved && self.changed == changed
    }
}

/// Data of blocks for the device, in its order.
#[derive(Debug, Default)]
struct Tables {
    parts: Vec<Part>,
    faces: Vec<[f32; 4]>,
    motions: Vec<Motion>,
}

impl SolidCells {
    /// Adds blocks to the lattice, which must have a solid operator; they have no position until
    /// [`SolidCells::place`].
    ///
    /// # Errors
    /// [`Error::Argument`] if the lattice has no solid operator, or the frame is invalid; [`Error::Limit`] of the device.
    pub fn new(
        device: &wgpu::Device,
        lattice: &Lattice,
        frame: Frame,
        blocks: Vec<SolidBlock>,
    ) -> Result<Self> {
        frame.check()?;
        let mut order: Vec<usize> = (0..blocks.len()).collect();
        order.sort_by_key(|&block| !blocks[block].loaded);
        let mut number = vec![0; blocks.len()];
        for (place, &block) in order.iter().enumerate() {
            number[block] = place;
        }
        let blocks: Vec<_> = order.iter().map(|&block| blocks[block].clone()).collect();
        let (mut first_part, mut first_face) = (vec![0], vec![0]);
        let (mut faces, mut most) = (0, 0);
        let mut forms = Forms::default();
        for block in &blocks {
            for part in block.shape.parts() {
                forms.spheres |= matches!(part.form, Form::Sphere { .. });
                if let Form::Convex(shape) = &part.form {
                    forms.polyhedra = true;
                    let count = shape.faces().len() as u32;
                    if count > MAX_FACES {
                        return Err(Error::Limit {
                            name: "faces of a convex part in a fluid".into(),
                            wants: count.into(),
                            has: MAX_FACES.into(),
                            remedy: "simplify its mesh".into(),
                        });
                    }
                    faces += count;
                    most = most.max(count);
                }
                first_face.push(faces);
            }
            first_part.push(first_face.len() as u32 - 1);
        }
        let requests = |block: &usize| blocks[*block].faces;
        let requested: Vec<usize> = (0..blocks.len()).filter(requests).collect();
        let kernels = Kernels::new(device, lattice, forms, most)?;
        let face_sums = match requested.is_empty() {
            true => None,
            false => Some(FaceSums::new(device, lattice, kernels.mapping, requested)?),
        };
        let parts = first_face.len() - 1;
        Ok(Self {
            face_sums,
            sphere_growth: program::sphere_growth(lattice.setup().weight(), lattice.setup().tau()),
            tiling: Tiling::new(*lattice.grid(), lattice.setup().periodic_axes()),
            loaded: blocks.iter().filter(|block| block.loaded).count(),
            plan: Plan::new(blocks.len()),
            kernels,
            frame,
            number,
            first_part,
            first_face,
            faces: faces as usize,
            poses: Vec::new(),
            outlines: vec![Vec::new(); blocks.len()],
            tables: Tables {
                parts: vec![Part::default(); parts],
                faces: vec![[0.0; 4]; faces as usize],
                motions: vec![Motion::default(); blocks.len()],
            },
            blocks,
            work: CellWork::default(),
            listed: None,
        })
    }

    /// Places the blocks at `poses`, one per block, for the coming steps: uploads changed data
    /// and lists the work.
    ///
    /// # Errors
    /// If the number of poses differs, one is not finite, leaves no volume or is too far away, or the device
    /// cannot hold the cells; the next call then starts from the beginning.
    pub fn place(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
        poses: &[Pose],
    ) -> Result<()> {
        if poses.len() != self.blocks.len() {
            let message = format!("{} poses for {} blocks", poses.len(), self.blocks.len());
            return Err(Error::argument("poses", message));
        }
        let nowhere = |pose: &Pose| !pose.is_finite();
        if let Some(bad) = poses.iter().position(nowhere) {
            return Err(Error::NotFinite {
                block: format!("block {bad}"),
                time: lattice.step() as f64 * self.frame.units.time_step,
                remedy: "look at its load and its drive; a shorter time step may help".into(),
            });
        }
        for (block, pose) in poses.iter().enumerate() {
            pose.check_volume(|| format!("block {block}"))?;
        }
        let far = |pose: &Pose| self.frame.place(pose.centre).abs().max_element() > MAX_DISTANCE;
        if let Some(bad) = poses.iter().position(far) {
            let message = format!(
                "its centroid {} is farther away than cells are counted ({MAX_DISTANCE:.0e}): it has left the scene; \
                 end the run before, or close the boundary through which it went",
                poses[bad].centre
            );
            return Err(Error::argument(format!("block {bad}"), message));
        }
        let poses = self.ordered(poses);
        let start = self.poses.is_empty();
        let differs = |block: usize, what: fn(&Pose, &Pose) -> bool| {
            start || what(&poses[block], &self.poses[block])
        };
        let moved: Vec<usize> = (0..poses.len())
            .filter(|&block| {
                differs(block, |a, b| {
                    (a.centre, a.deformation) != (b.centre, b.deformation)
                })
            })
            .collect();
        let changed: Vec<usize> = (0..poses.len())
            .filter(|&block| differs(block, |a, b| a != b))
            .collect();
        if changed.is_empty() {
            self.set_work(queue, &[], &[], false);
            return Ok(());
        }
        for &block in &moved {
            self.outlines[block] = self.outlines_at(block, &poses[block]);
        }
        let cell = self.frame.units.cell;
        let strayed = moved.iter().any(|&block| {
            let radius = self.blocks[block].shape.radius();
            self.plan.has_strayed(block, &poses[block], radius, cell)
        });
        if strayed {
            // All blocks: the result depends on their poses only.
            for (block, pose) in poses.iter().enumerate() {
                let outlines = std::mem::take(&mut self.outlines[block]);
                self.find(block, pose, &outlines);
                self.outlines[block] = outlines;
            }
        }
        let anew = start || strayed;
        if anew {
            // Until everything is in place.
            self.poses.clear();
            self.make_room(device, queue, lattice)?;
            self.upload_plan(queue);
            if let Some(faces) = &mut self.face_sums {
                let held = (&*lattice, &self.kernels);
                let plan = (&self.plan, &self.first_part[..]);
                faces.lay(device, queue, held, plan, &self.outlines)?;
            }
            self.work.searches += 1;
        }
        self.poses = poses;
        if anew || !moved.is_empty() {
            lattice.blocks_have_moved();
        }
        self.upload_tables(queue, &changed, anew);
        if anew {
            let tiles: Vec<u32> = (0..self.plan.tiles.len() as u32).collect();
            let lanes: Vec<u32> = (0..self.plan.lane_count() as u32).collect();
            self.set_work(queue, &tiles, &lanes, true);
        } else if let Some(listed) = self
            .listed
            .as_ref()
            .filter(|listed| listed.is_of(&moved, &changed))
        {
            self.kernels.no_edges(queue);
            self.work.tiles += listed.tiles;
            self.work.lanes += listed.lanes;
        } else {
            let tiles = moved.iter().flat_map(|&block| self.plan.tiles_of(block));
            let tiles: Vec<u32> = tiles.collect();
            let lanes = self.plan.lanes_of(&changed);
            self.set_work(queue, &tiles, &lanes, false);
            self.listed = Some(Listed {
                tiles: tiles.len() as u64,
                lanes: lanes.len() as u64,
                moved,
                changed,
            });
        }
        Ok(())
    }

    /// Poses, or data of blocks, in the order of the device.
    fn ordered<T: Copy>(&self, given: &[T]) -> Vec<T> {
        let mut ordered = given.to_vec();
        for (value, &place) in given.iter().zip(&self.number) {
            ordered[place] = *value;
        }
        ordered
    }

    fn outlines_at(&self, block: usize, pose: &Pose) -> Vec<Outline> {
        let parts = self.blocks[block].shape.parts().iter();
        let outlines = parts.map(|part| outline(&self.frame, part, pose));
        outlines
            .map(|outline| outline.grown(self.sphere_growth))
            .collect()
    }

    /// Searches the tiles of a block again, if due.
    fn find(&mut self, block: usize, pose: &Pose, outlines: &[Outline]) {
        let radius = self.blocks[block].shape.radius();
        let at = (pose, radius, self.frame.units.cell);
        let first = self.first_part[block];
        let margin = match self.blocks[block].faces {
            true => FACE_LAYERS as f64,
            false => NEIGHBOURS,
        };
        let around = (outlines, margin, self.imaged(block));
        self.plan.find(&self.tiling, block, at, around, first);
    }

    /// Axes along which a block, in the order of the device, has images.
    pub(super) fn imaged(&self, block: usize) -> [bool; 3] {
        let (_, periodic) = self.tiling.domain();
        let filled = self.blocks[block].filled;
        [0, 1, 2].map(|axis| periodic[axis] && !filled[axis])
    }

    fn make_room(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
    ) -> Result<()> {
        self.plan.assemble(lattice.geometry(), lattice.grid());
        lattice.set_psm_bricks(device, queue, &self.plan.bricks)?;
        let counts = [
            self.first_face.len() - 1,
            self.faces,
            self.blocks.len(),
            self.loaded,
        ];
        self.kernels.hold(device, lattice, &self.plan, counts)
    }

    /// Poses at which the tiles of the blocks were found, at or near the present ones; their velocities have no meaning.
    pub fn tiled(&self) -> Vec<Option<Pose>> {
        let found = self.number.iter();
        found.map(|&place| self.plan.found_at(place)).collect()
    }

    /// Restores the tiles for the poses of [`SolidCells::tiled`], so that the loads are summed in
    /// the same order; the next [`SolidCells::place`] does everything else again.
    pub fn tile(&mut self, tiled: &[Option<Pose>]) {
        for (block, tiled) in self.ordered(tiled).into_iter().enumerate() {
            self.plan.forget(block);
            if let Some(pose) = tiled {
                let outlines = self.outlines_at(block, &pose);
                self.find(block, &pose, &outlines);
            }
        }
        self.poses.clear();
    }

    fn set_work(&mut self, queue: &wgpu::Queue, tiles: &[u32], lanes: &[u32], anew: bool) {
        self.kernels.set_work(queue, tiles, lanes, anew);
        self.work.tiles += tiles.len() as u64;
        self.work.lanes += lanes.len() as u64;
        self.listed = None;
    }

    fn upload_plan(&mut self, queue: &wgpu::Queue) {
        let plan = &self.plan;
        let lists = [
            ("tiles", bytemuck::cast_slice(&plan.tiles)),
            ("lane_first", bytemuck::cast_slice(&plan.lane_first)),
            ("lane_tiles", bytemuck::cast_slice(&plan.lane_tiles)),
        ];
        for (name, bytes) in lists {
            queue.write_buffer(self.kernels.buffer(name), 0, bytes);
        }
        let most = self.kernels.mapping.segment(plan.block_first[self.loaded]);
        let (segments, block_first) = plan.segments(self.loaded, most);
        self.kernels.set_sums(queue, segments, &block_first);
    }

    /// Computes the rows of the blocks `changed`, ascending, and uploads the range that contains them; all rows with `anew`.
    fn upload_tables(&mut self, queue: &wgpu::Queue, changed: &[usize], anew: bool) {
        for &block in changed {
            let parts = self.first_part[block] as usize..;
            for (n, outline) in parts.zip(&self.outlines[block]) {
                let first = self.first_face[n];
                let (part, faces) = rows(outline, block as u32, first);
                self.tables.parts[n] = part;
                for (row, face) in self.tables.faces[first as usize..].iter_mut().zip(faces) {
                    *row = face;
                }
            }
            self.tables.motions[block] = self.frame.motion(&self.poses[block]);
        }
        let (first, end) = match changed {
            [first, .., last] if !anew => (*first, last + 1),
            [only] if !anew => (*only, only + 1),
            _ => (0, self.blocks.len()),
        };
        let parts = self.first_part[first] as usize..self.first_part[end] as usize;
        let faces = self.first_face[parts.start] as usize..self.first_face[parts.end] as usize;
        let Tables {
            parts: all_parts,
            faces: all_faces,
            motions,
        } = &self.tables;
        let tables: [(_, usize, &[u8]); 3] = [
            (
                "parts",
                size_of::<Part>() * parts.start,
                bytemuck::cast_slice(&all_parts[parts]),
            ),
            (
                "faces",
                16 * faces.start,
                bytemuck::cast_slice(&all_faces[faces]),
            ),
            (
                "motions",
                size_of::<Motion>() * first,
                bytemuck::cast_slice(&motions[first..end]),
            ),
        ];
        for (name, offset, bytes) in tables {
            queue.write_buffer(self.kernels.buffer(name), offset as u64, bytes);
        }
    }

    /// Records the computation of the solid in each cell, after [`SolidCells::place`]; nothing if no block has
    /// changed since the last call.
    pub fn record_cells(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.kernels.record(pass, 0..3);
    }

    /// Number of bricks that blocks reach.
    pub fn bricks(&self) -> &[u32] {
        &self.plan.bricks
    }

    /// Number of tiles: parts of blocks in a lane of a brick.
    pub fn tiles(&self) -> usize {
        self.plan.tiles.len()
    }

    /// Work done since the start.
    pub fn work(&self) -> CellWork {
        self.work
    }

    /// The kernels in the order in which they run, each with the workgroups of the coming step.
    pub fn kernels(&self) -> impl Iterator<Item = (&Kernel, u32)> {
        self.kernels.all()
    }

    /// The kernels of loads on single faces; none unless a block requests these.
    pub fn face_kernels(&self) -> impl Iterator<Item = &Kernel> {
        self.face_sums.iter().flat_map(FaceSums::kernels)
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        let faces = self.face_sums.as_ref().map_or(0, FaceSums::bytes);
        self.kernels.bytes() + faces
    }

    /// Cells of the domain, and which of its axes are periodic.
    pub(crate) fn domain(&self) -> ([u32; 3], [bool; 3]) {
        self.tiling.domain()
    }

    /// Position and units of the lattice.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }
}
