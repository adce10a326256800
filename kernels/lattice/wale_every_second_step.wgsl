// The eddy viscosity is evaluated in even steps, from the velocity of the odd step before; the next odd step uses it again.
// needs grid, stream, $reals

@group(0) @binding(35) var<storage, read_write> eddy_viscosity: array<Reals>;

fn resolved_eddy_viscosity(p: Place, cell: u32) -> Real {
    if (ODD == 1u) {
        return unpack_reals(eddy_viscosity[p.element]);
    }
    let nu_t = eddy_viscosity_of_gradient(p, cell);
    eddy_viscosity[p.element] = pack_reals(nu_t);
    return nu_t;
}

// Whether the next step evaluates the eddy viscosity from the velocity of this one.
fn keeps_velocity() -> bool {
    return ODD == 1u;
}
