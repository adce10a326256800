// Werner & Wengle 1991, Turbulent Shear Flows 8:155: the wall stress of a smooth wall from the speed u at the distance y,
// u+ = y+ up to 11.81, u+ = 8.3 y+^(1/7) beyond. Explicit.

// Kinematic viscosity of the fluid, lattice units.
override VISCOSITY: f32;

const LINEAR_UP_TO = 11.81;
const POWER_FACTOR = 8.3;

// Stress over density.
fn smooth_wall_stress(u: f32, y: f32) -> f32 {
    let s = u / POWER_FACTOR;
    let r = sqrt(sqrt(VISCOSITY / y));
    return select(s * sqrt(s) * sqrt(sqrt(s)) * r, VISCOSITY * u / y, u * y <= LINEAR_UP_TO * LINEAR_UP_TO * VISCOSITY);
}
