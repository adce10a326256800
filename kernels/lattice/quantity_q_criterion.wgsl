// Hunt, Wray & Moin 1988: Q = (W:W - S:S)/2 = -(d_a u_b d_b u_a)/2, positive in vortices.
// needs wale

fn quantity(g: Gradient) -> f32 {
    let squares = g.x.x * g.x.x + g.y.y * g.y.y + g.z.z * g.z.z;
    return -0.5 * squares - g.x.y * g.y.x - g.x.z * g.z.x - g.y.z * g.z.y;
}
