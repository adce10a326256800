// Guo, Zheng & Shi 2002: the part of the body force of a cell that the pressure balances in fluid at rest: that along axes along
// which the domain does not repeat. The populations that pass between fluid at rest and a solid in direction c then have
// w (excess + 1.5 c.F), with the excess density of the cell that they leave.
// needs $cell_force

// 1 along these axes, else 0.
override BALANCED_X: f32;
override BALANCED_Y: f32;
override BALANCED_Z: f32;

fn balanced_force(cell: vec3<u32>) -> vec3<f32> {
    return vec3(BALANCED_X, BALANCED_Y, BALANCED_Z) * cell_force(cell);
}
