// No wall model.
// needs $lanes, grid

fn at_least_near_wall(p: Place, nu_t: Real) -> Real {
    return nu_t;
}
