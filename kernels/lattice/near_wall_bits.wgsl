// Prandtl 1925, Z. angew. Math. Mech. 5:136: the eddy viscosity next to faces of blocks, which near_wall_viscosity.wgsl reads.

// Bits of non-negative floats, which have the order of the floats: a cell in front of two faces gets the larger value.
@group(0) @binding(42) var<storage, read_write> near_wall_viscosity: array<atomic<u32>>;
