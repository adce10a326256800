// Gauss & Legendre's rule with two points a panel: columns through a cell, their lengths exact. They go along the main axis
// from the middle of the part: its surface is hardly ever steep on them.
// needs axes

// Half the distance of the two points, 1 / sqrt(12) of a panel.
const GAUSS = 0.28867513;

// Column i of n, an even number, from the middle of the cell. All weigh the same.
fn column(i: u32, n: u32) -> f32 {
    let panel = f32(i / 2u) + 0.5 + select(GAUSS, -GAUSS, i % 2u == 0u);
    return panel * 2.0 / f32(n) - 0.5;
}
