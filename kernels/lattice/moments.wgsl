// Malaspinas 2015, arXiv:1505.06900: Hermite moments on the tensor-product lattice D3Q27.
// h_abc = sum_i f_i He_a(c_ix) He_b(c_iy) He_c(c_iz) with He = 1, x, x^2 - 1/3, at place a + 3 b + 9 c.
// Orthogonal with the lattice weights: the weights have h_000 = 1 and every other moment 0, so that
// shifted populations f - w have h_000 = rho - 1 and all other moments unchanged. Both transforms factorise
// into nine one-dimensional transforms per axis.
// needs $lanes

fn to_moments(f: ptr<function, array<Real, 27>>) {
    for (var r = 0u; r < 9u; r++) { // unroll
        let low = (*f)[3u * r];
        let mid = (*f)[3u * r + 1u];
        let high = (*f)[3u * r + 2u * 1u];
        let both = low + high;
        let h0 = both + mid;
        (*f)[3u * r] = h0;
        (*f)[3u * r + 1u] = high - low;
        (*f)[3u * r + 2u * 1u] = both - h0 * THIRD;
    }
    for (var r = 0u; r < 9u; r++) { // unroll
        let low = (*f)[9u * (r / 3u) + r % 3u];
        let mid = (*f)[9u * (r / 3u) + r % 3u + 3u];
        let high = (*f)[9u * (r / 3u) + r % 3u + 2u * 3u];
        let both = low + high;
        let h0 = both + mid;
        (*f)[9u * (r / 3u) + r % 3u] = h0;
        (*f)[9u * (r / 3u) + r % 3u + 3u] = high - low;
        (*f)[9u * (r / 3u) + r % 3u + 2u * 3u] = both - h0 * THIRD;
    }
    for (var r = 0u; r < 9u; r++) { // unroll
        let low = (*f)[r];
        let mid = (*f)[r + 9u];
        let high = (*f)[r + 2u * 9u];
        let both = low + high;
        let h0 = both + mid;
        (*f)[r] = h0;
        (*f)[r + 9u] = high - low;
        (*f)[r + 2u * 9u] = both - h0 * THIRD;
    }
}

fn from_moments(f: ptr<function, array<Real, 27>>) {
    for (var r = 0u; r < 9u; r++) { // unroll
        let h0 = (*f)[3u * r];
        let half1 = 0.5 * (*f)[3u * r + 1u];
        let second = (*f)[3u * r + 2u * 1u] + h0 * THIRD;
        let half2 = 0.5 * second;
        (*f)[3u * r] = half2 - half1;
        (*f)[3u * r + 1u] = h0 - second;
        (*f)[3u * r + 2u * 1u] = half2 + half1;
    }
    for (var r = 0u; r < 9u; r++) { // unroll
        let h0 = (*f)[9u * (r / 3u) + r % 3u];
        let half1 = 0.5 * (*f)[9u * (r / 3u) + r % 3u + 3u];
        let second = (*f)[9u * (r / 3u) + r % 3u + 2u * 3u] + h0 * THIRD;
        let half2 = 0.5 * second;
        (*f)[9u * (r / 3u) + r % 3u] = half2 - half1;
        (*f)[9u * (r / 3u) + r % 3u + 3u] = h0 - second;
        (*f)[9u * (r / 3u) + r % 3u + 2u * 3u] = half2 + half1;
    }
    for (var r = 0u; r < 9u; r++) { // unroll
        let h0 = (*f)[r];
        let half1 = 0.5 * (*f)[r + 9u];
        let second = (*f)[r + 2u * 9u] + h0 * THIRD;
        let half2 = 0.5 * second;
        (*f)[r] = half2 - half1;
        (*f)[r + 9u] = h0 - second;
        (*f)[r + 2u * 9u] = half2 + half1;
    }
}

const THIRD = 1.0 / 3.0;
