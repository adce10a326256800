// Vorticity, curl u, its component along AXIS.
// needs wale

override AXIS: u32;

fn quantity(g: Gradient) -> f32 {
    if (AXIS == 0u) {
        return g.z.y - g.y.z;
    }
    return select(g.y.x - g.x.y, g.x.z - g.z.x, AXIS == 1u);
}
