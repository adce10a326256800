// A sample for statistics.wgsl (Chan, Golub & LeVeque 1983): density minus one and velocity, from the populations.
// needs scalar_grid, cell_state

fn sample(cell: vec3<u32>) -> vec4<f32> {
    return cell_state(cell);
}
