// The eddy viscosity is evaluated in every step, from the velocity of the previous one.
// needs grid, $lanes

fn resolved_eddy_viscosity(p: Place, cell: u32) -> Real {
    return eddy_viscosity_of_gradient(p, cell);
}

// Whether the next step evaluates the eddy viscosity from the velocity of this one.
fn keeps_velocity() -> bool {
    return true;
}
