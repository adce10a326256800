//! Collision and streaming by kinds of brick.

use super::{
    Bindings, Geometry, Grid, PSM_PLANES, Setup,
    buffers::{Buffers, storage},
    program::{self, BrickKind},
    spread::{PSM_NAMES, planes},
};
use crate::{
    Error, Result,
    gpu::{
        buffers::zeroed,
        kernel::{Kernel, Shader, largest_binding},
    },
};

/// The kernels of even and odd steps, with their buffers.
#[derive(Debug)]
struct Steps {
    kernels: [Kernel; 2],
    binds: [wgpu::BindGroup; 2],
}

/// The dispatches of one kind of brick.
#[derive(Debug)]
struct Stream {
    kind: BrickKind,
    steps: Steps,
    /// Those of steps that add a sample to the statistics.
    sampling: Option<Steps>,
    /// Its length and the bricks.
    list: Option<wgpu::Buffer>,
    groups: u32,
}

/// All kinds of brick that a setup has, those with blocks first: what they leave behind is waited for.
#[derive(Debug)]
pub(super) struct Streams {
    streams: Vec<Stream>,
    /// What blocks leave of the cells of the bricks that they reach.
    psm_planes: Vec<wgpu::Buffer>,
    /// Where each of these cells lies at the faces of blocks, for a wall model.
    face_codes: Option<wgpu::Buffer>,
    /// Bytes of the planes for one brick, in each of them; the first has the most.
    brick_bytes: Vec<u64>,
    /// The bricks that blocks reach.
    psm_bricks: Vec<u32>,
    /// The sums of statistics over time, by their names in WGSL.
    statistics: Vec<(String, wgpu::Buffer)>,
    /// Whether the coming step adds a sample to these.
    pub samples: bool,
}

impl Streams {
    pub fn new(
        device: &wgpu::Device,
        setup: &Setup,
        grid: &Grid,
        geometry: &Geometry,
        bindings: Bindings,
        buffers: &Buffers,
    ) -> Result<Self> {
        let all: u32 = grid.bricks().iter().product();
        let kinds = sorted(setup, geometry, &[]);
        let brick: u32 = grid.brick.iter().product();
        let plane = 4 * u64::from(brick * grid.lanes);
        let brick_bytes: Vec<_> = match setup.solid_operator {
            Some(_) => planes(PSM_PLANES, bindings.psm_planes),
            None => Vec::new(),
        }
        .iter()
        .map(|own| own.len() as u64 * plane)
        .collect();
        let psm_planes = psm_buffers(device, &brick_bytes, 1);
        let face_codes = code_buffer(device, setup, 1);
        let mut streams = Vec::new();
        for (n, (kind, bricks)) in kinds.into_iter().enumerate() {
            let kernels = compile(device, (setup, grid, bindings), kind, n == 0)?;
            let groups = bricks.len() as u32;
            let list = (kind != BrickKind::All).then(|| {
                let mut list = counted(&bricks);
                if !psm_planes.is_empty() {
                    list.resize(all as usize + 1, 0);
                }
                storage(device, "bricks", bytemuck::cast_slice(&list))
            });
            let others = Others {
                psm_planes: &psm_planes,
                face_codes: face_codes.as_ref(),
                statistics: &[],
            };
            let binds = bind(device, &kernels, buffers, list.as_ref(), &others)?;
            streams.push(Stream {
                kind,
                steps: Steps { kernels, binds },
                sampling: None,
                list,
                groups: if kind == BrickKind::All { all } else { groups },
            });
        }
        Ok(Self {
            streams,
            psm_planes,
            face_codes,
            brick_bytes,
            psm_bricks: Vec::new(),
            statistics: Vec::new(),
            samples: false,
        })
    }

    /// Whether steps add samples to statistics.
    pub fn has_statistics(&self) -> bool {
        !self.statistics.is_empty()
    }

    /// Compiles the kernels that add samples to the sums in `statistics`.
    ///
    /// # Errors
    /// If the device cannot bind these.
    pub fn add_statistics(
        &mut self,
        device: &wgpu::Device,
        (setup, grid, buffers): (&Setup, &Grid, &Buffers),
        bindings: Bindings,
        statistics: Vec<(String, wgpu::Buffer)>,
    ) -> Result<()> {
        let others = Others {
            psm_planes: &self.psm_planes,
            face_codes: self.face_codes.as_ref(),
            statistics: &statistics,
        };
        for (n, stream) in self.streams.iter_mut().enumerate() {
            let kernels = compile(device, (setup, grid, bindings), stream.kind, n == 0)?;
            let binds = bind(device, &kernels, buffers, stream.list.as_ref(), &others)?;
            stream.sampling = Some(Steps { kernels, binds });
        }
        self.statistics = statistics;
        Ok(())
    }

    /// What blocks leave of the cells of the bricks that they reach.
    pub fn psm_planes(&self) -> &[wgpu::Buffer] {
        &self.psm_planes
    }

    /// Where each of these cells lies at the faces of blocks, for a wall model.
    pub fn face_codes(&self) -> Option<&wgpu::Buffer> {
        self.face_codes.as_ref()
    }

    /// The list of the bricks that blocks reach, after their number, and that; none where there are none.
    pub fn psm_bricks(&self) -> Option<(&wgpu::Buffer, u32)> {
        let mut streams = self.streams.iter();
        let stream = streams.find(|stream| stream.kind == BrickKind::Psm && stream.groups > 0)?;
        Some((stream.list.as_ref()?, stream.groups))
    }

    /// Has these bricks run by the kernel for blocks, and the others by those of their kind; false if they did.
    pub fn set(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        (setup, geometry, buffers): (&Setup, &Geometry, &Buffers),
        psm: &[u32],
    ) -> Result<bool> {
        if self.psm_bricks == psm {
            return Ok(false);
        }
        let slots = psm.len().max(1) as u64;
        if let (Some(kept), Some(&brick_bytes)) =
            (self.psm_planes.first(), self.brick_bytes.first())
        {
            if kept.size() < slots * brick_bytes {
                // Half as much again, so that a block that rotates does not reallocate repeatedly.
                let most = most_slots(device, brick_bytes, slots)?;
                let room = most.min(slots + slots / 2);
                self.psm_planes = psm_buffers(device, &self.brick_bytes, room);
                self.face_codes = code_buffer(device, setup, room);
                let others = Others {
                    psm_planes: &self.psm_planes,
                    face_codes: self.face_codes.as_ref(),
                    statistics: &self.statistics,
                };
                for stream in &mut self.streams {
                    let list = stream.list.as_ref();
                    for steps in std::iter::once(&mut stream.steps).chain(&mut stream.sampling) {
                        steps.binds = bind(device, &steps.kernels, buffers, list, &others)?;
                    }
                }
            }
            if psm.is_empty() {
                for (kept, bytes) in self.psm_planes.iter().zip(&self.brick_bytes) {
                    queue.write_buffer(kept, 0, &vec![0; *bytes as usize]);
                }
                if let Some(codes) = &self.face_codes {
                    queue.write_buffer(codes, 0, &vec![0; codes.size() as usize]);
                }
            }
        }
        for (stream, (_, bricks)) in self.streams.iter_mut().zip(sorted(setup, geometry, psm)) {
            stream.groups = bricks.len() as u32;
            if let Some(list) = &stream.list {
                queue.write_buffer(list, 0, bytemuck::cast_slice(&counted(&bricks)));
            }
        }
        self.psm_bricks = psm.to_vec();
        Ok(true)
    }

    /// Records those with blocks, or the others.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>, parity: usize, psm: bool) {
        let these = |stream: &&Stream| (stream.kind == BrickKind::Psm) == psm;
        for stream in self.streams.iter().filter(these) {
            if stream.groups > 0 {
                let sampling = stream.sampling.as_ref().filter(|_| self.samples);
                let Steps { kernels, binds } = sampling.unwrap_or(&stream.steps);
                kernels[parity].record(pass, &binds[parity], stream.groups);
            }
        }
    }

    /// The kernels of a step without a sample in their order, each with its workgroups.
    pub fn kernels(&self, parity: usize) -> impl Iterator<Item = (&Kernel, u32)> {
        let streams = self.streams.iter();
        streams.map(move |stream| (&stream.steps.kernels[parity], stream.groups))
    }

    /// Those of a step with a sample, if there are statistics.
    pub fn sampling_kernels(&self, parity: usize) -> impl Iterator<Item = (&Kernel, u32)> {
        self.streams.iter().filter_map(move |stream| {
            let steps = stream.sampling.as_ref()?;
            Some((&steps.kernels[parity], stream.groups))
        })
    }

    /// Bytes of the lists, and of what blocks leave of cells.
    pub fn bytes(&self) -> [u64; 2] {
        let lists = self
            .streams
            .iter()
            .filter_map(|stream| stream.list.as_ref());
        [
            lists.map(wgpu::Buffer::size).sum(),
            self.psm_planes
                .iter()
                .chain(&self.face_codes)
                .map(wgpu::Buffer::size)
                .sum(),
        ]
    }
}

/// The kinds of brick that a setup has, each with its bricks.
fn sorted(setup: &Setup, geometry: &Geometry, psm: &[u32]) -> Vec<(BrickKind, Vec<u32>)> {
    if setup.is_all_fluid() {
        return vec![(BrickKind::All, Vec::new())];
    }
    let fixed = [
        (BrickKind::Surface, &geometry.surface),
        (BrickKind::Flagged, &geometry.mixed),
        (BrickKind::Plain, &geometry.plain),
    ];
    if setup.solid_operator.is_none() {
        let fixed = fixed.into_iter().filter(|(_, list)| !list.is_empty());
        return fixed.map(|(kind, list)| (kind, list.clone())).collect();
    }
    // The guard counts steps in the first dispatch, which needs a brick: without a block in it the
    // kernel for blocks gives what its own would.
    let mut lists = fixed.iter();
    let spare = lists.find_map(|(_, list)| list.first());
    let first: Vec<u32> = match psm {
        [] => spare.into_iter().copied().collect(),
        _ => psm.to_vec(),
    };
    let mut taken = first.clone();
    taken.sort_unstable();
    // The kernel of surfaces is compiled only where there are some.
    let fixed = fixed
        .into_iter()
        .filter(|(kind, list)| *kind != BrickKind::Surface || !list.is_empty());
    let fixed = fixed.map(|(kind, list)| (kind, without(list, &taken)));
    std::iter::once((BrickKind::Psm, first))
        .chain(fixed)
        .collect()
}

/// A list without some bricks, both ascending; what lies between these is copied as a whole.
fn without(list: &[u32], taken: &[u32]) -> Vec<u32> {
    let mut others = Vec::with_capacity(list.len());
    let mut rest = list;
    for brick in taken {
        let at = rest.partition_point(|other| other < brick);
        others.extend_from_slice(&rest[..at]);
        rest = &rest[at..];
        if rest.first() == Some(brick) {
            rest = &rest[1..];
        }
    }
    others.extend_from_slice(rest);
    others
}

/// A list with its length before it.
fn counted(bricks: &[u32]) -> Vec<u32> {
    let mut list = vec![bricks.len() as u32];
    list.extend(bricks);
    list
}

/// The kernels of a kind of brick for even and odd steps; the first kind counts steps for the guard.
fn compile(
    device: &wgpu::Device,
    (setup, grid, bindings): (&Setup, &Grid, Bindings),
    kind: BrickKind,
    first: bool,
) -> Result<[Kernel; 2]> {
    let linked = program::collide_stream(setup, bindings, kind).link()?;
    let shader = Shader::new(device, linked);
    let kernel = |odd| {
        let of_setup = program::constants(setup, grid, odd);
        let mut constants = shader.linked().constants_of(&of_setup);
        // One dispatch of a step counts it: the first, which always runs.
        if setup.max_speed > 0.0 {
            constants.push(("GUARD_COUNTS", f64::from(u8::from(first))));
        }
        if kind == BrickKind::All {
            let all: u32 = grid.bricks().iter().product();
            constants.push(("BRICKS", f64::from(all)));
        }
        shader.kernel(device, "collide_stream", &constants)
    };
    Ok([kernel(false)?, kernel(true)?])
}

/// Buffers that are not part of [`Buffers`].
struct Others<'a> {
    psm_planes: &'a [wgpu::Buffer],
    face_codes: Option<&'a wgpu::Buffer>,
    statistics: &'a [(String, wgpu::Buffer)],
}

fn bind(
    device: &wgpu::Device,
    kernels: &[Kernel; 2],
    buffers: &Buffers,
    list: Option<&wgpu::Buffer>,
    others: &Others<'_>,
) -> Result<[wgpu::BindGroup; 2]> {
    let bind = |parity: usize| {
        let mut named = buffers.named(parity == 1);
        named.extend(list.map(|list| ("bricks", list)));
        named.extend(PSM_NAMES.into_iter().zip(others.psm_planes));
        named.extend(others.face_codes.map(|codes| ("face_codes", codes)));
        let statistics = others.statistics.iter();
        named.extend(statistics.map(|(name, buffer)| (name.as_str(), buffer)));
        kernels[parity].bind(device, &named)
    };
    Ok([bind(0)?, bind(1)?])
}

/// The planes of so many bricks.
fn psm_buffers(device: &wgpu::Device, brick_bytes: &[u64], slots: u64) -> Vec<wgpu::Buffer> {
    let bytes = brick_bytes.iter();
    bytes
        .map(|bytes| zeroed(device, "psm_planes", slots * bytes))
        .collect()
}

/// Where the cells of so many bricks lie at the faces of blocks, if a wall model acts on these.
fn code_buffer(device: &wgpu::Device, setup: &Setup, slots: u64) -> Option<wgpu::Buffer> {
    let brick = u64::from(setup.brick.iter().product::<u32>() * setup.lanes);
    let codes = || zeroed(device, "face codes", 4 * slots * brick);
    setup.has_block_friction().then(codes)
}

/// Slots that a binding holds.
fn most_slots(device: &wgpu::Device, brick_bytes: u64, wanted: u64) -> Result<u64> {
    let has = largest_binding(&device.limits());
    let most = has / brick_bytes;
    if wanted <= most {
        return Ok(most);
    }
    Err(Error::Limit {
        name: "bytes of one storage binding (cells that blocks reach)".into(),
        wants: wanted * brick_bytes,
        has,
        remedy: "use fewer or smaller blocks in the fluid, a larger cell, or another adapter"
            .into(),
    })
}
