// Hunt, Wray & Moin 1988: Q = (W:W - S:S)/2 = -(d_a u_b d_b u_a)/2 + (div u)^2/2, positive in vortices.
// needs wale

fn quantity(g: Gradient) -> f32 {
    let divergence = g.x.x + g.y.y + g.z.z;
    let product = g.x.x * g.x.x + g.y.y * g.y.y + g.z.z * g.z.z
        + 2.0 * (g.x.y * g.y.x + g.x.z * g.z.x + g.y.z * g.z.y);
    return 0.5 * (divergence * divergence - product);
}
