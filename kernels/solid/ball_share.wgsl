// Share of a sphere in a cell on its surface.
// needs tables, columns

// Columns an axis: 1e-5 of the volume of a sphere of 10 cells.
const BALL_COLUMNS = 8u;

// r: the centre of the cell from that of the sphere.
fn ball_share(r: vec3<f32>, radius: f32) -> f32 {
    let far = abs(r);
    // By symmetry in the octant where r is positive.
    let at = turned(far, main_axis(far));
    var sum = 0.0;
    for (var j = 0u; j < BALL_COLUMNS; j++) {
        for (var i = 0u; i < BALL_COLUMNS; i++) {
            let x = at.x + column(i, BALL_COLUMNS);
            let y = at.y + column(j, BALL_COLUMNS);
            let half = sqrt(max(radius * radius - x * x - y * y, 0.0));
            sum += max(min(half, at.z + 0.5) - max(-half, at.z - 0.5), 0.0);
        }
    }
    let share = sum / f32(BALL_COLUMNS * BALL_COLUMNS);
    return select(NEAR, share, share > 0.0);
}
