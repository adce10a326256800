// No cell is filled in part by a solid at rest.

fn with_surface(psm: PsmCell, index: u32, local: u32) -> PsmCell {
    return psm;
}
