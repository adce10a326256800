// No cell is filled in part by a solid that stands still.

fn with_surface(psm: PsmCell, index: u32, local: u32) -> PsmCell {
    return psm;
}
