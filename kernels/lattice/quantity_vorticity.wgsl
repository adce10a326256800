// Vorticity, curl u, its component along AXIS.
// needs wale

override AXIS: u32;

fn quantity(g: Gradient) -> f32 {
    let curl = vec3(g.z.y - g.y.z, g.x.z - g.z.x, g.y.x - g.x.y);
    return curl[AXIS];
}
