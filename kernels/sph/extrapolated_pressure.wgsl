// Adami, Hu & Adams 2012, J. Comput. Phys. 231:7057, eq. 27: the pressure of the water around a point,
// extrapolated to it.
// needs $equation_of_state

override GRAVITY_X: f32;
override GRAVITY_Y: f32;
override GRAVITY_Z: f32;

// Sums over the water around the point.
var<private> weights: f32;
var<private> pressure: f32;
var<private> column: vec3<f32>;

fn reset_pressure() {
    weights = 0.0;
    pressure = 0.0;
    column = vec3(0.0);
}

// A fluid particle with the kernel weight w; r points from it to the point.
fn add_pressure(w: f32, r: vec3<f32>, excess: f32) {
    weights += w;
    pressure += w * pressure_of(excess);
    column += w * (1.0 + excess) * r;
}

// For a point with this acceleration. The pressure is not negative, and 0 without water.
fn extrapolated_pressure(acceleration: vec3<f32>) -> f32 {
    let effective_gravity = vec3(GRAVITY_X, GRAVITY_Y, GRAVITY_Z) - acceleration;
    let sum = max(pressure + dot(effective_gravity, column), 0.0);
    return select(0.0, sum / weights, weights > 0.0);
}
