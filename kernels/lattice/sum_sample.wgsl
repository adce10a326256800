// Chan, Golub & LeVeque 1983, Am. Stat. 37:242, eqs. 2.1: adds a sample, shifted by the mean so far, to the sums of the open
// block.
// needs $lanes, $reals, statistics_planes

// The planes: 4 means, 7 covariances, and for the open block 4 sums and 7 sums of products. Covariances and products: density,
// xx, yy, zz, xy, yz, xz.
const SUMS = 11u;
const PRODUCTS = 15u;

// Density minus one and velocity.
struct Sample {
    excess: Real,
    x: Real,
    y: Real,
    z: Real,
}

fn mean(plane: u32, e: u32) -> Real {
    return unpack_reals(read_statistic(plane, e));
}

fn add_to(plane: u32, e: u32, value: Real) {
    set_statistic(plane, e, pack_reals(unpack_reals(read_statistic(plane, e)) + value));
}

fn sum_sample(e: u32, sample: Sample) {
    let r = sample.excess - mean(0u, e);
    let x = sample.x - mean(1u, e);
    let y = sample.y - mean(2u, e);
    let z = sample.z - mean(3u, e);
    add_to(SUMS, e, r);
    add_to(SUMS + 1u, e, x);
    add_to(SUMS + 2u, e, y);
    add_to(SUMS + 3u, e, z);
    add_to(PRODUCTS, e, r * r);
    add_to(PRODUCTS + 1u, e, x * x);
    add_to(PRODUCTS + 2u, e, y * y);
    add_to(PRODUCTS + 3u, e, z * z);
    add_to(PRODUCTS + 4u, e, x * y);
    add_to(PRODUCTS + 5u, e, y * z);
    add_to(PRODUCTS + 6u, e, x * z);
}
