// Higham 1993, SIAM J. Sci. Comput. 14:783, sums of short sums. Each invocation sums 64 domain cells in a fixed
// order: excess mass, momentum, kinetic energy rho u.u/2, enstrophy (curl u)^2/2, largest u.u. The caller adds
// the partial sums in f64.
// needs scalar_grid, cell_gradient

// Density minus one, of each domain cell.
@group(0) @binding(50) var<storage, read> density: array<f32>;

struct Sums {
    excess: f32,
    momentum_x: f32,
    momentum_y: f32,
    momentum_z: f32,
    kinetic_energy: f32,
    enstrophy: f32,
    max_speed_squared: f32,
    fluid_cells: f32,
}

@group(0) @binding(54) var<storage, read_write> partial_sums: array<Sums>;

const RUN = 64u;

@compute @workgroup_size(64)
fn sum_cells(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let total = CELLS_X * CELLS_Y * CELLS_Z;
    let first = invocation(group, groups, local);
    let runs = (total + RUN - 1u) / RUN;
    if (first >= runs) {
        return;
    }
    var sums = Sums();
    for (var k = 0u; k < RUN; k++) {
        // Adjacent invocations read cells that are adjacent in memory.
        let n = first + k * runs;
        if (n >= total) {
            break;
        }
        let cell = domain_cell(n);
        let cell_flags = flags_of(cell);
        if ((cell_flags & 128u) != 0u) {
            continue;
        }
        let u = cell_velocity(cell);
        let g = cell_gradient(cell, cell_flags);
        let curl = vec3(g.z.y - g.y.z, g.x.z - g.z.x, g.y.x - g.x.y);
        let rho = 1.0 + density[n];
        sums.excess += density[n];
        sums.momentum_x += rho * u.x;
        sums.momentum_y += rho * u.y;
        sums.momentum_z += rho * u.z;
        sums.kinetic_energy += 0.5 * rho * dot(u, u);
        sums.enstrophy += 0.5 * dot(curl, curl);
        sums.max_speed_squared = max(sums.max_speed_squared, dot(u, u));
        sums.fluid_cells += 1.0;
    }
    partial_sums[first] = sums;
}
