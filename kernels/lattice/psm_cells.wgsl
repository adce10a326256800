// Gardner & Sitar 2018, eq. 8-10: f* = f + (1 - B) fluid + B solid. The weight B depends on the fraction e of the cell that
// blocks fill and on the relaxation time tau. The operator of the solid is linear in rho and in the velocity
// of the solid, so that the force of each block in a cell follows from its own fraction and velocity.
// needs velocity, moments, psm_planes, psm_storage, solid_weights, $cell_flags, $operator, $weight, $reals, $surface, $block_friction

// B of the momentum in full cells where blocks are in contact with each other or with a wall. B = 1 would reflect the populations
// in such a cell forever: the block would keep the pressure of the time when its joint closed, and would be tied to its neighbour
// by the momentum between them. With a smaller B, fluid flows along the joint, and blocks slide on it.
override JOINT_WEIGHT: f32;
// The same in joints with two rows of cells; with a prescribed aperture these let through as much as joints with one row.
override FACING_WEIGHT: f32;

struct PsmCell {
    // e, and the sum of the fractions of the parts, which share the force in proportion; more than 1 where blocks overlap.
    fraction: Real,
    shares: Real,
    velocity: Vector,
    near: Mask,
    interior: Mask,
    joint: Mask,
    facing: Mask,
    // Whether several blocks meet in it.
    several: Mask,
}

fn psm_cell(slot: u32, local: u32) -> PsmCell {
    let sum = decode_sum(unpack_reals(read_psm(PLANE_SUM, slot, local)));
    let velocity = Vector(
        unpack_reals(read_psm(PLANE_VELOCITY, slot, local)),
        unpack_reals(read_psm(PLANE_VELOCITY + 1u, slot, local)),
        unpack_reals(read_psm(PLANE_VELOCITY + 2u, slot, local)),
    );
    let fraction = unpack_reals(read_psm(PLANE_FRACTION, slot, local));
    let blocks = PsmCell(fraction, sum.fraction, velocity, sum.near, sum.interior, sum.joint, sum.facing, sum.several);
    return with_surface(blocks, slot, local);
}

// The velocity for the eddy viscosity of the next step: that of the solid in the solid part of the cell.
fn mean_velocity(psm: PsmCell, u: Vector) -> Vector {
    let e = psm.fraction;
    return Vector(
        u.x + e * (psm.velocity.x - u.x),
        u.y + e * (psm.velocity.y - u.y),
        u.z + e * (psm.velocity.z - u.z),
    );
}

// The formula gives an eddy viscosity to the rotation of a solid, where there must be none.
fn outside_solids(psm: PsmCell, nu_t: Real) -> Real {
    return nu_t * (1.0 - psm.fraction);
}

// Runs before the collision: stores the values for the loads, and replaces the moments h by the change by the solid alone, so
// that a GPU holds no more values than without solids.
fn collide_with_solid(
    p: Place,
    slot: u32,
    local: u32,
    cell: u32,
    psm: PsmCell,
    tau_minus_half: Real,
    odd_rate: Real,
    rho: Real,
    u: Vector,
    h: ptr<function, array<Real, 27>>,
) -> SolidWeights {
    let e = psm.fraction;
    // A plane that fills less than half of a cell leaves its centre in the fluid.
    let clear = (e < Real(0.5)) & (psm.shares == Real(0.0)) & !solid(cell);
    let open = solid_weight(e, tau_minus_half, odd_rate);
    let closure = closure_of(e);
    let narrow = (closure > Real(0.0)) & (psm.shares > Real(0.0)) & !psm.interior;
    var at_wall = Mask(false);
    // Momentum that the fluid loses along walls.
    var lost = Vector(Real(0.0), Real(0.0), Real(0.0));
    for (var face = 0u; face < 6u; face++) { // unroll
        let here = narrow & wall_at(p, cell, face);
        at_wall = at_wall | here;
        lost = lost_to_wall(face, here, h, lost);
    }
    let joint = select(Real(0.0), closure, psm.joint | at_wall);
    // Part of the least B. With several blocks it reaches 1 in a cell that is half full.
    let least = max(closure, select(Real(0.0), min(2.0 * e, Real(1.0)), psm.several));
    let momentum = max(open, least * LEAST_WEIGHT);
    let closed = select(Real(JOINT_WEIGHT), Real(FACING_WEIGHT), psm.facing & !at_wall);
    let others = max(open, least * JOINT_DAMPING);
    let without_law = select(momentum + joint * (closed - momentum), Real(1.0), psm.interior);
    let higher_without_law = select(others + joint * (JOINT_DAMPING - others), Real(1.0), psm.interior);
    let v = psm.velocity;
    let excess = (*h)[0u];
    let without_block = (e > Real(0.0)) & (psm.shares == Real(0.0));
    let on_surface = sliding_on_surface(p, slot, local, without_block, rho, v, h);
    var s = equilibrium(rho, sliding_velocity(p, slot, local, rho, on_surface, h));
    for (var k = 1u; k < 27u; k++) { // unroll
        s[k] -= (*h)[k];
    }
    let factor = solid_operator(1.0 / (0.5 + tau_minus_half), rho, u, h, psm.interior, damping_in_full_cells(v, closure), &s);
    let share_of_law = apply_wall_stress(p, slot, local, rho, v, h, &s);
    let weight = with_law(without_law, share_of_law);
    let higher = with_law(higher_without_law, share_of_law);
    *h = s;
    let fluid = (psm.shares > Real(0.0)) & !solid(cell);
    let beta = select(Real(0.0), weight / max(psm.shares, Real(1e-30)), fluid);
    // Values beyond the domain may be NaN; they must not count.
    let a = factor * rho;
    let each = 2.0 * closure / max(psm.shares, Real(1.0));
    write_psm(PLANE_BETA, slot, local, pack_reals(select(beta, Real(1.0), clear)));
    write_psm(PLANE_A, slot, local, pack_reals(select(select(Real(0.0), beta * a, fluid), excess, clear)));
    write_psm(PLANE_G, slot, local, pack_reals(select(select(Real(0.0), beta * ((*h)[1u] - a * v.x), fluid) + each * lost.x, u.x, clear)));
    write_psm(PLANE_G + 1u, slot, local, pack_reals(select(select(Real(0.0), beta * ((*h)[3u] - a * v.y), fluid) + each * lost.y, u.y, clear)));
    write_psm(PLANE_G + 2u, slot, local, pack_reals(select(select(Real(0.0), beta * ((*h)[9u] - a * v.z), fluid) + each * lost.z, u.z, clear)));
    return SolidWeights(weight, higher);
}

// Noble & Torczynski 1998, eq. 4: the velocity in the middle of the step, after half of the body force on the fluid and half of
// the change by the solid, as velocity_psm.wgsl has it for the step before.
fn velocity_at_middle(
    weights: SolidWeights,
    rho: Real,
    u: Vector,
    by_half_force: Vector,
    solid: ptr<function, array<Real, 27>>,
) -> Vector {
    let half = 0.5 / rho;
    return Vector(
        u.x + weights.momentum * (half * (*solid)[1u] - by_half_force.x),
        u.y + weights.momentum * (half * (*solid)[3u] - by_half_force.y),
        u.z + weights.momentum * (half * (*solid)[9u] - by_half_force.z),
    );
}

// The part of the operator that the equilibrium of the solid replaces in full cells, which reflect populations between each other
// forever. The equilibrium depends on their density, which makes noise grow by up to half of |u_x| + |u_y| + |u_z| a step where a
// surface moves along itself, as that of a sphere that turns.
fn damping_in_full_cells(v: Vector, closure: Real) -> Real {
    return min(abs(v.x) + abs(v.y) + abs(v.z), Real(1.0)) * closure;
}

// Where `here`, adds half the tangential momentum that returns from a wall, the sum of f c over the directions that leave the
// wall. In a full cell at a wall, the wall friction of the lattice acts on no block by itself: it is applied to the
// block, in full in a closed joint and less as the joint opens.
fn lost_to_wall(face: u32, here: Mask, h: ptr<function, array<Real, 27>>, before: Vector) -> Vector {
    let sign_half = select(Real(0.5), Real(-0.5), Mask(face % 2u == 1u));
    let zero = Real(0.0);
    var found: Vector;
    switch face / 2u {
        case 0u: {
            found = Vector(zero, leaving((*h)[3u], (*h)[4u], (*h)[5u], sign_half), leaving((*h)[9u], (*h)[10u], (*h)[11u], sign_half));
        }
        case 1u: {
            found = Vector(leaving((*h)[1u], (*h)[4u], (*h)[7u], sign_half), zero, leaving((*h)[9u], (*h)[12u], (*h)[15u], sign_half));
        }
        default: {
            found = Vector(leaving((*h)[1u], (*h)[10u], (*h)[19u], sign_half), leaving((*h)[3u], (*h)[12u], (*h)[21u], sign_half), zero);
        }
    }
    return Vector(
        before.x + select(zero, found.x, here),
        before.y + select(zero, found.y, here),
        before.z + select(zero, found.z, here),
    );
}

// The sum of f c_t over the directions with c_n = 1 or -1, from the moments f c_t, f c_t c_n and f c_t (c_n^2 - 1/3).
fn leaving(first: Real, second: Real, third: Real, sign_half: Real) -> Real {
    return 0.5 * (third + first * THIRD) + sign_half * second;
}
