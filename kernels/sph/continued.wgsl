// Adami, Hu & Adams 2012, J. Comput. Phys. 231:7057, eq. 27: the pressure of the water around a place, continued to it.
// needs $state

override GRAVITY_X: f32 = 0.0;
override GRAVITY_Y: f32 = 0.0;
override GRAVITY_Z: f32 = 0.0;

// Sums over the water around the place.
var<private> weights: f32;
var<private> pressure: f32;
var<private> column: vec3<f32>;

fn begin_pressure() {
    weights = 0.0;
    pressure = 0.0;
    column = vec3(0.0);
}

// Water of the weight w from which it is r to the place.
fn add_pressure(w: f32, r: vec3<f32>, excess: f32) {
    weights += w;
    pressure += w * pressure_of(excess);
    column += w * (1.0 + excess) * r;
}

// Where the place has this acceleration. Nothing pulls; where there is no water there is no pressure.
fn end_pressure(acceleration: vec3<f32>) -> f32 {
    let fall = vec3(GRAVITY_X, GRAVITY_Y, GRAVITY_Z) - acceleration;
    let sum = max(pressure + dot(fall, column), 0.0);
    return select(0.0, sum / weights, weights > 0.0);
}
