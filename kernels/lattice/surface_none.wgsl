// No cell is filled in part by a solid at rest.

fn with_surface(psm: PsmCell, index: u32, local: u32) -> PsmCell {
    return psm;
}

fn sliding_on_surface(p: Place, index: u32, local: u32, alone: Mask, rho: Real, v: Vector, h: ptr<function, array<Real, 27>>) -> Vector {
    return v;
}
