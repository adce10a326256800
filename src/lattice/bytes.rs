//! What a lattice takes on its device, by kind.

use super::{
    Lattice, surface::Surface, surface_friction::SurfacePart, synthetic_turbulence::Inlet,
    wall_model::WallPart,
};

impl Lattice {
    /// Bytes of its buffers, each kind with a name; kinds that it does not have are left out.
    pub fn bytes(&self) -> Vec<(&'static str, u64)> {
        let buffers = &self.buffers;
        let size = |buffer: &Option<wgpu::Buffer>| buffer.as_ref().map_or(0, wgpu::Buffer::size);
        let velocity = buffers.velocity.iter().flatten();
        let geometry = &self.geometry;
        let open = &buffers.open;
        let has_open = !(geometry.pressure.is_empty() && geometry.outflow.is_empty());
        // The kernels of even and odd steps keep a list each.
        let list = |bytes: usize| 2 * bytes as u64;
        let [lists, psm_planes] = self.streams.bytes();
        let kinds = [
            (
                "populations",
                buffers.populations.iter().map(wgpu::Buffer::size).sum(),
            ),
            (
                "velocity and eddy viscosity between steps",
                velocity.map(wgpu::Buffer::size).sum::<u64>() + size(&buffers.eddy_viscosity),
            ),
            ("flags of cells", size(&buffers.flags)),
            (
                "body force",
                buffers.force.iter().map(wgpu::Buffer::size).sum(),
            ),
            (
                "links at walls",
                list(size_of_val(&geometry.links[..]))
                    + list(size_of_val(&geometry.link_rows[..]))
                    + list(size_of_val(&geometry.moving[..]))
                    + size(&buffers.wall_velocity),
            ),
            (
                "open faces",
                [&open.pressure, &open.outflow, &open.outflow_state]
                    .iter()
                    .filter(|_| has_open)
                    .map(|buffer| buffer.size())
                    .sum(),
            ),
            (
                "synthetic turbulence",
                buffers.inlets.iter().map(Inlet::bytes).sum(),
            ),
            (
                "wall model",
                buffers.walls.iter().map(WallPart::bytes).sum::<u64>()
                    + buffers
                        .sloping_surface
                        .as_ref()
                        .map_or(0, SurfacePart::bytes)
                    + size(&buffers.near_wall_viscosity)
                    + self
                        .of_blocks
                        .lists
                        .iter()
                        .map(wgpu::Buffer::size)
                        .sum::<u64>()
                    + size(&buffers.psm_slots),
            ),
            (
                "solid fractions of static surfaces",
                buffers.surface.as_ref().map_or(0, Surface::bytes),
            ),
            ("lists of bricks", lists),
            ("saturation of bricks with blocks", psm_planes),
            ("guard", size(&buffers.guard)),
        ];
        kinds.into_iter().filter(|(_, bytes)| *bytes > 0).collect()
    }
}
