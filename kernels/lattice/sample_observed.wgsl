// A sample for statistics.wgsl (Chan, Golub & LeVeque 1983): the fields that macroscopic.wgsl and later kernels have written.
// needs scalar_grid

// Density minus one and velocity of each domain cell.
@group(0) @binding(50) var<storage, read> density: array<f32>;
@group(0) @binding(51) var<storage, read> velocity_x: array<f32>;
@group(0) @binding(52) var<storage, read> velocity_y: array<f32>;
@group(0) @binding(53) var<storage, read> velocity_z: array<f32>;

fn sample(cell: vec3<u32>) -> vec4<f32> {
    let n = cell.x + CELLS_X * (cell.y + CELLS_Y * cell.z);
    return vec4(density[n], velocity_x[n], velocity_y[n], velocity_z[n]);
}
