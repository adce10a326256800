// Gardner & Sitar 2018, eq. 8: cells in which blocks meet solids at rest. The solids count as one more part; their share of the
// force is not summed. A joint between a block and a solid closes as one between two blocks does.
// needs surface_fraction

fn with_surface(psm: PsmCell, index: u32, local: u32) -> PsmCell {
    let surface = surface_at(index, local);
    let e = surface.fraction;
    let block = psm.shares > Real(0.0);
    let shares = psm.shares + e;
    let part = select(Real(1.0), psm.shares / max(shares, Real(1e-30)), block);
    return PsmCell(
        min(psm.fraction + e, Real(1.0)),
        select(Real(0.0), shares, block),
        Vector(part * psm.velocity.x, part * psm.velocity.y, part * psm.velocity.z),
        psm.near | surface.near,
        psm.interior,
        psm.joint | (block & (e > Real(0.0))),
        psm.facing & (e == Real(0.0)),
        psm.several | (block & (e > Real(0.0))),
    );
}
