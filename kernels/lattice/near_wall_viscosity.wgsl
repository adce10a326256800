// Prandtl 1925, Z. angew. Math. Mech. 5:136: the eddy viscosity that carries the stress of a wall model through the cells next to
// the wall, where WALE vanishes. wall_model.wgsl and block_friction.wgsl write it; it is 0 elsewhere.
// needs grid, $reals

@group(0) @binding(36) var<storage, read> near_wall_viscosity: array<Reals>;

fn at_least_near_wall(p: Place, nu_t: Real) -> Real {
    return max(nu_t, unpack_reals(near_wall_viscosity[p.element]));
}
