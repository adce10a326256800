//! Blocks lighter and heavier than the fluid.

use crate::fixture::{World, fluid, material};

/// Four blocks of half to eight times the density of the fluid that start with a velocity and a spin, a few cells across,
/// where added masses are largest.
#[test]
fn blocks_of_half_to_eight_times_the_density_come_to_rest() {
    // τ = 0.506, 1.1 and 0.65; the last with exchanges every third step.
    for (nu, interval) in [(0.002, 1), (0.2, 1), (0.05, 3)] {
        let ratios = [0.5, 1.0, 2.65, 8.0];
        let materials: String = ratios
            .iter()
            .enumerate()
            .map(|(n, ratio)| material(&format!("rock{n}"), 1000.0 * ratio))
            .collect();
        let block = |n: usize| {
            let (x, y) = (2.5 + 4.8 * (n % 2) as f64, 2.6 + 4.7 * (n / 2) as f64);
            format!(
                r#"
                [[blocks]]
                kind = "box"
                size = [2.5, 2, 1.5]
                position = [{x}, {y}, 3.1]
                rotation = {{ axis = [1, 2, {n}], angle = 30 }}
                velocity = [0.02, 0.01, 0.03]
                spin = [0.02, 0.01, -0.01]
                material = "rock{n}""#
            )
        };
        let blocks: String = (0..4).map(block).collect();
        let mut world = World::new(&format!(
            r#"{}{materials}
            [boundaries]
            x_min = {{ kind = "wall" }}
            x_max = {{ kind = "wall" }}
            [rock]
            gravity = [0, 0, 0]
            [coupling]
            interval = {interval}
            [numerics]
            time_step = 0.25
            eddy_viscosity = "wale"
            {blocks}"#,
            fluid([20, 20, 12], nu),
        ));
        let speeds = |world: &World| -> Vec<f64> {
            let spins = world.sim.coupled().unwrap().blocks().spins();
            let turning = spins.map(|spin| 1.25 * spin.length());
            turning
                .take(4)
                .enumerate()
                .map(|(n, turning)| turning + world.velocity(n).length())
                .collect()
        };
        let start = speeds(&world);
        let mut largest = start.clone();
        for _ in 0..20 {
            world.advance(12);
            for (largest, now) in largest.iter_mut().zip(speeds(&world)) {
                *largest = largest.max(now);
            }
        }
        let end = speeds(&world);
        println!("ν {nu}: {start:.4?}, at most {largest:.4?}, {end:.4?}");
        for n in 0..4 {
            assert!(
                largest[n] < 1.2 * start[n],
                "ν {nu}, ratio {}: {largest:?}",
                ratios[n]
            );
            assert!(
                end[n] < 0.95 * start[n],
                "ν {nu}, ratio {}: {end:?}",
                ratios[n]
            );
        }
    }
}

/// Light cubes, eight cells across, in a stream between their own images: nothing there damps sound, and a delayed response
/// to sound amplifies it.
#[test]
fn sound_between_light_blocks_dies_away() {
    for (interval, ratio) in [(1, 0.3), (1, 0.5), (2, 0.6), (4, 1.0)] {
        sound_dies_away(interval, 1000.0 * ratio);
    }
}

fn sound_dies_away(interval: u32, density: f64) {
    let stream = 0.1;
    let mut world = World::new(&format!(
        r#"{}{}
        [initial]
        velocity = [{stream}, 0, 0]
        [rock]
        gravity = [0, 0, 0]
        [coupling]
        interval = {interval}
        [numerics]
        time_step = 0.25
        [[blocks]]
        kind = "box"
        size = [4, 4, 4]
        position = [4.15, 4, 4]"#,
        fluid([16, 16, 16], 0.0577),
        material("light", density),
    ));
    world.advance(1500);
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for _ in 0..60 {
        world.advance(1);
        let speed = world.velocity(0).x;
        (least, most) = (least.min(speed), most.max(speed));
    }
    println!("every {interval}, {density}: {least:.6} to {most:.6}");
    assert!(most - least < 0.01 * stream, "{least} {most}");
    assert!(most < stream && least > 0.5 * stream, "{least} {most}");
}
