// Nicoud & Ducros 1999: the eddy viscosity that the next step will use.
// needs wale

override C_WALE: f32;

fn quantity(g: Gradient) -> f32 {
    return wale(g, C_WALE);
}
