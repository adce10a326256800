//! D3Q27: directions, weights, moments of a set of populations.

/// Number of directions.
pub const Q: usize = 27;

/// Velocity of each direction; the opposites are neighbours, 2k − 1 and 2k.
pub const C: [[i32; 3]; Q] = [
    [0, 0, 0],
    [1, 0, 0],
    [-1, 0, 0],
    [0, 1, 0],
    [0, -1, 0],
    [0, 0, 1],
    [0, 0, -1],
    [1, 1, 0],
    [-1, -1, 0],
    [1, 0, 1],
    [-1, 0, -1],
    [0, 1, 1],
    [0, -1, -1],
    [1, -1, 0],
    [-1, 1, 0],
    [1, 0, -1],
    [-1, 0, 1],
    [0, 1, -1],
    [0, -1, 1],
    [1, 1, 1],
    [-1, -1, -1],
    [1, 1, -1],
    [-1, -1, 1],
    [1, -1, 1],
    [-1, 1, -1],
    [-1, 1, 1],
    [1, -1, -1],
];

/// Weights by the number of non-zero components of a direction.
pub const W: [f64; Q] = {
    let by_speed = [8.0 / 27.0, 2.0 / 27.0, 1.0 / 54.0, 1.0 / 216.0];
    let mut w = [0.0; Q];
    let mut i = 0;
    while i < Q {
        let [x, y, z] = C[i];
        w[i] = by_speed[(x * x + y * y + z * z) as usize];
        i += 1;
    }
    w
};

/// The opposite of each direction.
pub const OPPOSITE: [usize; Q] = {
    let mut opposite = [0; Q];
    let mut i = 1;
    while i < Q {
        opposite[i] = if i % 2 == 1 { i + 1 } else { i - 1 };
        i += 1;
    }
    opposite
};

/// c_i · v.
pub fn c_dot(i: usize, v: [f64; 3]) -> f64 {
    let [x, y, z] = C[i];
    f64::from(x) * v[0] + f64::from(y) * v[1] + f64::from(z) * v[2]
}

/// The direction whose velocity is `c`.
pub fn direction(c: [i32; 3]) -> usize {
    C.iter()
        .position(|&other| other == c)
        .expect("components are −1, 0 or 1")
}

/// Density ρ = 1 + Σ f̃_i and velocity u = (Σ c_i f̃_i + F/2)/ρ.
pub fn macroscopic(f: &[f64; Q], force: [f64; 3]) -> (f64, [f64; 3]) {
    let rho = 1.0 + f.iter().sum::<f64>();
    let u = [0, 1, 2].map(|axis| {
        let momentum: f64 = (0..Q).map(|i| f64::from(C[i][axis]) * f[i]).sum();
        (momentum + 0.5 * force[axis]) / rho
    });
    (rho, u)
}
