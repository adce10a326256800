// Prandtl 1925, Z. angew. Math. Mech. 5:136: the mixing length near a wall, tapered over four cells: the remaining fraction at
// the height y, cells.

fn taper(y: f32) -> f32 {
    let inner = 0.25 * clamp(y - 0.5, 0.0, 1.0) + 0.35 * clamp(y - 1.5, 0.0, 1.0);
    return max(0.0, 1.0 - inner - 0.25 * clamp(y - 2.5, 0.0, 1.0) - 0.15 * clamp(y - 3.5, 0.0, 1.0));
}
