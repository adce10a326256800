// Gauss-Legendre quadrature with two points per panel, over columns through a cell with exact lengths. The columns follow
// the main axis from the middle of the part, along which its surface is hardly ever steep.
// needs axes

// Half the distance between the two points, 1 / sqrt(12) of a panel.
const GAUSS = 0.28867513;

// Position of column i of n, an even number, from the middle of the cell. All columns have the same weight.
fn column(i: u32, n: u32) -> f32 {
    let panel = f32(i / 2u) + 0.5 + select(GAUSS, -GAUSS, i % 2u == 0u);
    return panel * 2.0 / f32(n) - 0.5;
}
