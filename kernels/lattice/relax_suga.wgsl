// Suga et al. 2015, Comput. Math. Appl. 69:518, eq. 4-10: the published operator, orthogonal with unit weights.
// delta f = sum_k s_k / |M_k|^2 M_k (M_k . d). The rows are polynomials in c: with Hermite moments converted
// to raw moments the products are short sums, in blocks of equal parity. The transposed products give delta f
// as a polynomial, whose Hermite moments follow axis by axis. No 27 x 27 matrix is needed.
// needs $cell_flags, $odd_rates

override S4: f32;
override S16: f32;
override S17: f32;
override S18: f32;
override S20: f32;

// Rate of the moments 120 + 102, and likewise for y and z.
fn third_order_rate(cell: u32, psm: PsmCell, shear_rate: Real) -> Real {
    return Real(odd_rates(cell, psm).s10);
}

fn relax(cell: u32, psm: PsmCell, shear_rate: Real, d: ptr<function, array<Real, 27>>, h: ptr<function, array<Real, 27>>) {
    let odd = odd_rates(cell, psm);
    // Raw moments of d, whose density and momentum are 0: second = h2 + h0 / 3.
    (*d)[0u] = Real(0.0);
    (*d)[1u] = Real(0.0);
    (*d)[3u] = Real(0.0);
    (*d)[9u] = Real(0.0);
    for (var r = 0u; r < 9u; r++) { // unroll
        (*d)[3u * r + 2u * 1u] += (*d)[3u * r] * (1.0 / 3.0);
    }
    for (var r = 0u; r < 9u; r++) { // unroll
        (*d)[9u * (r / 3u) + r % 3u + 2u * 3u] += (*d)[9u * (r / 3u) + r % 3u] * (1.0 / 3.0);
    }
    for (var r = 0u; r < 9u; r++) { // unroll
        (*d)[r + 2u * 9u] += (*d)[r] * (1.0 / 3.0);
    }
    var g: array<Real, 27>;

    // Even in x, y and z: rows 4, 16, 17 (traces), 5, 6 (shear), 18, 19.
    let a = (*d)[2u] + (*d)[6u] + (*d)[18u];
    let b = (*d)[8u] + (*d)[20u] + (*d)[24u];
    let energy = (S4 / 18.0) * a;
    let fourth = (S16 / 36.0) * (3.0 * b - 4.0 * a);
    let sixth = (S17 / 216.0) * (12.0 * a - 18.0 * b + 27.0 * (*d)[26u]);
    let xx = 3.0 * (*d)[2u] - a;
    let ww = (*d)[6u] - (*d)[18u];
    let shear_xx = shear_rate * xx * (1.0 / 36.0);
    let shear_ww = shear_rate * ww * (1.0 / 12.0);
    let fourth_xx = (S18 / 72.0) * (3.0 * (b - 3.0 * (*d)[24u]) - 2.0 * xx);
    let fourth_ww = (S18 / 24.0) * (3.0 * ((*d)[8u] - (*d)[20u]) - 2.0 * ww);
    g[0u] = 4.0 * fourth - 2.0 * energy - 8.0 * sixth;
    let trace = energy - 4.0 * fourth + 12.0 * sixth;
    let pure_xx = shear_xx - 2.0 * fourth_xx;
    let pure_ww = shear_ww - 2.0 * fourth_ww;
    g[2u] = trace + 2.0 * pure_xx;
    g[6u] = trace - pure_xx + pure_ww;
    g[18u] = trace - pure_xx - pure_ww;
    let trace4 = 3.0 * fourth - 18.0 * sixth;
    g[8u] = trace4 + 3.0 * fourth_xx + 3.0 * fourth_ww;
    g[20u] = trace4 + 3.0 * fourth_xx - 3.0 * fourth_ww;
    g[24u] = trace4 - 6.0 * fourth_xx;
    g[26u] = 27.0 * sixth;

    // Odd in two: rows 7-9 (shear) and 20-22.
    let fourth_xy = (S20 / 24.0) * (3.0 * (*d)[22u] - 2.0 * (*d)[4u]);
    g[4u] = shear_rate * (*d)[4u] * (1.0 / 12.0) - 2.0 * fourth_xy;
    g[22u] = 3.0 * fourth_xy;
    let fourth_yz = (S20 / 24.0) * (3.0 * (*d)[14u] - 2.0 * (*d)[12u]);
    g[12u] = shear_rate * (*d)[12u] * (1.0 / 12.0) - 2.0 * fourth_yz;
    g[14u] = 3.0 * fourth_yz;
    let fourth_zx = (S20 / 24.0) * (3.0 * (*d)[16u] - 2.0 * (*d)[10u]);
    g[10u] = shear_rate * (*d)[10u] * (1.0 / 12.0) - 2.0 * fourth_zx;
    g[16u] = 3.0 * fourth_zx;

    // Odd in one: rows 10-12, 13-15, 23-25 (x: y^2 - z^2, y: z^2 - x^2, z: x^2 - y^2).
    let sum_x = (*d)[7u] + (*d)[19u];
    let third_x = odd.s10 * sum_x * (3.0 / 72.0);
    let fifth_x = odd.s13 * (9.0 * (*d)[25u] - 6.0 * sum_x) * (1.0 / 72.0);
    let skew_x = odd.s23 * ((*d)[7u] - (*d)[19u]) * (1.0 / 8.0);
    g[1u] = 4.0 * fifth_x - 4.0 * third_x;
    g[7u] = 3.0 * third_x - 6.0 * fifth_x + skew_x;
    g[19u] = 3.0 * third_x - 6.0 * fifth_x - skew_x;
    g[25u] = 9.0 * fifth_x;
    let sum_y = (*d)[21u] + (*d)[5u];
    let third_y = odd.s10 * sum_y * (3.0 / 72.0);
    let fifth_y = odd.s13 * (9.0 * (*d)[23u] - 6.0 * sum_y) * (1.0 / 72.0);
    let skew_y = odd.s23 * ((*d)[21u] - (*d)[5u]) * (1.0 / 8.0);
    g[3u] = 4.0 * fifth_y - 4.0 * third_y;
    g[21u] = 3.0 * third_y - 6.0 * fifth_y + skew_y;
    g[5u] = 3.0 * third_y - 6.0 * fifth_y - skew_y;
    g[23u] = 9.0 * fifth_y;
    let sum_z = (*d)[11u] + (*d)[15u];
    let third_z = odd.s10 * sum_z * (3.0 / 72.0);
    let fifth_z = odd.s13 * (9.0 * (*d)[17u] - 6.0 * sum_z) * (1.0 / 72.0);
    let skew_z = odd.s23 * ((*d)[11u] - (*d)[15u]) * (1.0 / 8.0);
    g[9u] = 4.0 * fifth_z - 4.0 * third_z;
    g[11u] = 3.0 * third_z - 6.0 * fifth_z + skew_z;
    g[15u] = 3.0 * third_z - 6.0 * fifth_z - skew_z;
    g[17u] = 9.0 * fifth_z;
    g[13u] = odd.s26 * (*d)[13u] * (1.0 / 8.0);

    // Polynomial to Hermite moments: 3 g0 + 2 g2, 2 g1, g0 + 4/3 g2 per axis.
    for (var r = 0u; r < 9u; r++) { // unroll
        let constant = g[3u * r];
        let square = g[3u * r + 2u * 1u];
        g[3u * r] = 3.0 * constant + 2.0 * square;
        g[3u * r + 1u] *= 2.0;
        g[3u * r + 2u * 1u] = constant + square * (4.0 / 3.0);
    }
    for (var r = 0u; r < 9u; r++) { // unroll
        let constant = g[9u * (r / 3u) + r % 3u];
        let square = g[9u * (r / 3u) + r % 3u + 2u * 3u];
        g[9u * (r / 3u) + r % 3u] = 3.0 * constant + 2.0 * square;
        g[9u * (r / 3u) + r % 3u + 3u] *= 2.0;
        g[9u * (r / 3u) + r % 3u + 2u * 3u] = constant + square * (4.0 / 3.0);
    }
    for (var r = 0u; r < 9u; r++) { // unroll
        let constant = g[r];
        let square = g[r + 2u * 9u];
        g[r] = 3.0 * constant + 2.0 * square;
        g[r + 9u] *= 2.0;
        g[r + 2u * 9u] = constant + square * (4.0 / 3.0);
    }
    for (var k = 2u; k < 27u; k++) { // unroll
        if (k != 3u && k != 9u) {
            (*h)[k] += g[k];
        }
    }
}
