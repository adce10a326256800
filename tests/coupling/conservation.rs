//! Conservation of mass and momentum between blocks and fluid.

use crate::fixture::{DENSITY, STEP, World, accelerated_fluid, fluid, material};
use glam::DVec3;
use kit::{assert_near, assert_relative};
use riprap::scene::Field;
use std::f64::consts::PI;

/// Rounding error of a momentum, kg m/s: momenta are f32 sums over some thousand cells.
fn rounding(momentum: DVec3) -> f64 {
    1e-6 * (momentum.length() + 100.0)
}

/// Edges of the boxes with the same inertia as the blocks of these scenes, the shortest first, m: a ball with I = 2/5 m r²
/// corresponds to a cube with edges of √(12/5) r.
const BOXES: [[f64; 3]; 2] = [[2.0, 2.5, 2.5], [1.936_491_673_103_708_4; 3]];

/// Virtual mass of a block, kg, with the mass `mass` and the displaced fluid mass `displaced`: stable for an added mass of two
/// thirds of `displaced`, more for a flat block, grown by a layer of one cell (0.5 m) on each side, plus that layer.
fn virtual_mass([a, b, c]: [f64; 3], displaced: f64, mass: f64) -> f64 {
    let grown = (a + 1.0) * (b + 1.0) * (c + 1.0) / (a * b * c);
    let flat = ((b + 1.0) * (c + 1.0)).sqrt() / (a + 1.0);
    let most = (grown - 1.0) + 2.0 / 3.0 * flat * grown;
    (0.5 * (most * displaced - mass)).max(0.0)
}

#[test]
fn what_driven_blocks_give_the_fluid_gains_in_every_step() {
    let scene = format!(
        r#"{}{}
        [rock]
        gravity = [0, 0, 0]
        [coupling]
        average = false
        [numerics]
        time_step = 0.25
        [[blocks]]
        kind = "box"
        size = [3, 2.5, 2]
        position = [1, 2, 4.8]
        rotation = {{ axis = [1, 2, 3], angle = 40 }}
        motion = "driven"
        velocity = ["0.04 * cos(t)", 0.03, -0.02]
        spin = [0.01, 0.02, "0.03 * sin(t)"]
        [[blocks]]
        kind = "sphere"
        radius = 1.2
        position = [4, 2, 2]
        motion = "driven"
        velocity = [0, 0, 0.05]"#,
        fluid([12, 10, 12], 0.02),
        material("rock", 2000.0)
    );
    let mut world = World::new(&scene);
    let (mut before, mass) = world.fluid();
    for step in 1..=30 {
        world.advance(1);
        let (after, now) = world.fluid();
        let given: DVec3 = (0..2).map(|block| world.cell_load(block).flow.force).sum();
        let off = after - before + STEP * given;
        assert!(
            off.length() < rounding(after),
            "step {step}: {off} of {after}"
        );
        // The tolerance covers rounding of f32 in each step.
        assert!(
            (now / mass - 1.0).abs() < 1e-6,
            "step {step}: {now} kg, not {mass}"
        );
        before = after;
    }
}

/// Momentum is also conserved for faces along the grid with a wall law, which stops and restarts on the faces of a block that
/// moves off the grid.
#[test]
fn what_the_wall_model_takes_from_the_fluid_blocks_gain() {
    let scene = format!(
        r#"{}{}
        [rock]
        gravity = [0, 0, 0]
        [coupling]
        average = false
        [numerics]
        time_step = 0.25
        eddy_viscosity = "wale"
        wall_model = "werner_wengle"
        [[blocks]]
        kind = "box"
        size = [4, 4, 3]
        position = [3, 3, 3.1]
        motion = "driven"
        velocity = [0.04, -0.02, -0.03]
        [[blocks]]
        kind = "box"
        size = [4, 4, 3]
        position = [3, 3, 8.5]
        motion = "driven"
        velocity = [0, 0, 0]"#,
        fluid([12, 12, 24], 1e-6),
        material("rock", 2000.0)
    );
    let mut world = World::new(&scene);
    let mut before = world.fluid().0;
    let mut faces = Vec::new();
    for step in 1..=60 {
        world.advance(1);
        let after = world.fluid().0;
        let given: DVec3 = (0..2).map(|block| world.cell_load(block).flow.force).sum();
        let off = after - before + STEP * given;
        assert!(
            off.length() < rounding(after),
            "step {step}: {off} of {after}"
        );
        before = after;
        if step % 10 == 0 {
            let found = world.rig.wait(world.sim.wall_friction()).unwrap();
            assert!((0.1..0.9).contains(&found.block_area_share));
            let acts = found.walls.iter().filter(|wall| wall.share > 0.0);
            faces.push(acts.count());
        }
    }
    assert!(faces.iter().all(|faces| *faces > 20), "{faces:?}");
}

/// With single loads in every step, momentum goes from the fluid to the block without a remainder, and the block moves under
/// its load and the inertia of the fluid inside it, (m + 2 m_f) a = F + m_f dv/dt + 2 m_f a_before.
#[test]
fn what_the_fluid_loses_free_blocks_gain_in_every_step() {
    let scene = format!(
        r#"{}{}{}
        [rock]
        gravity = [0, 0, 0]
        [coupling]
        average = false
        [numerics]
        time_step = 0.25
        solid_operator = "noble"
        [[blocks]]
        kind = "box"
        size = [2.5, 2.5, 2]
        position = [1, 2, 4.8]
        rotation = {{ axis = [1, 2, 3], angle = 40 }}
        velocity = [0.03, 0.02, -0.01]
        spin = [0.01, 0.02, 0.03]
        material = "light"
        [[blocks]]
        kind = "sphere"
        radius = 1.25
        position = [5, 3, 2]
        velocity = [0, 0, 0.03]
        material = "heavy""#,
        fluid([14, 14, 14], 0.05),
        material("light", 500.0),
        material("heavy", 3000.0)
    );
    let mut world = World::new(&scene);
    let volume = |block: usize, world: &World| {
        world.sim.coupled().unwrap().setup().setup.blocks[block]
            .shape
            .volume()
    };
    let mut fluid = world.fluid().0;
    let start = fluid + world.momentum(0) + world.momentum(1);
    let mut velocities = [world.velocity(0), world.velocity(1)];
    let mut rates = [DVec3::ZERO; 2];
    let mut given = [DVec3::ZERO; 2];
    // Impulse of the fluid inside the blocks that has been returned to them.
    let mut inside = DVec3::ZERO;
    for step in 1..=40 {
        world.advance(1);
        let after = world.fluid().0;
        let load = [world.cell_load(0).flow, world.cell_load(1).flow];
        let off = after - fluid + STEP * (load[0].force + load[1].force);
        assert!(
            off.length() < rounding(after),
            "step {step}: {off} of {after}"
        );
        fluid = after;
        // Impulse of the virtual mass that has not yet been delivered.
        let mut pending = DVec3::ZERO;
        for n in 0..2 {
            let mass = world.sim.coupled().unwrap().blocks().mass(n);
            let whole = DENSITY * (load[n].entrained + load[n].missing);
            // Σε is the volume, up to the error of cells that several faces cut.
            let off = whole / (DENSITY * volume(n, &world)) - 1.0;
            assert!(off.abs() < 1e-3, "{whole}");
            let inner = whole.min(DENSITY * load[n].entrained + 0.5 * mass);
            let more = virtual_mass(BOXES[n], whole, mass);
            let force = load[n].force + inner * rates[n] + more * given[n];
            inside += STEP * inner * rates[n];
            given[n] = force / (mass + more);
            pending += STEP * more * given[n];
            let now = world.velocity(n);
            rates[n] = (now - velocities[n]) / STEP;
            velocities[n] = now;
            let off = (rates[n] - given[n]).length();
            assert!(
                off < 1e-9 * given[n].length().max(1e-3),
                "step {step}, block {n}: {off}"
            );
        }
        // Fluid and rock, with the fluid inside counted once.
        let all = fluid + world.momentum(0) + world.momentum(1) - inside + pending;
        let off = (all - start).length();
        assert!(off < 1e-4 * start.length(), "step {step}: {off} of {start}");
    }
}

/// By default scenes average loads, over one step or several. The blocks slow each other down through the fluid, and the total
/// momentum is conserved.
#[test]
fn momentum_of_fluid_and_free_blocks_stays() {
    for interval in [1, 3u64] {
        let scene = format!(
            r#"{}{}{}
            [rock]
            gravity = [0, 0, 0]
            [coupling]
            interval = {interval}
            [numerics]
            time_step = 0.25
            eddy_viscosity = "wale"
            [[blocks]]
            kind = "box"
            size = [2.5, 2.5, 2]
            position = [1, 2, 4.8]
            rotation = {{ axis = [1, 2, 3], angle = 40 }}
            velocity = [0.04, 0.02, -0.01]
            spin = [0.01, 0.02, 0.03]
            material = "light"
            [[blocks]]
            kind = "sphere"
            radius = 1.25
            position = [5, 3, 2]
            velocity = [0.02, 0, 0.05]
            material = "heavy""#,
            fluid([14, 14, 14], 0.02),
            material("light", 1200.0),
            material("heavy", 3000.0)
        );
        let mut world = World::new(&scene);
        let volumes = [12.5, 4.0 / 3.0 * PI * 1.25f64.powi(3)];
        let net = |world: &World| -> DVec3 {
            let one = |n: usize| world.momentum(n) - DENSITY * volumes[n] * world.velocity(n);
            one(0) + one(1)
        };
        let first = net(&world);
        let start = world.fluid().0 + first;
        for _ in 0..8 {
            world.advance(4 * interval);
            let velocities = [world.velocity(0), world.velocity(1)];
            world.advance(interval - 1);
            let before = world.fluid().0;
            world.advance(1);
            let after = world.fluid().0;
            // Not yet delivered: half of the last load, and the momentum of the fluid inside and of the virtual mass since
            // the previous exchange.
            let pending: DVec3 = (0..2)
                .map(|n| {
                    let displaced = DENSITY * volumes[n];
                    let mass = world.sim.coupled().unwrap().blocks().mass(n);
                    let change = world.velocity(n) - velocities[n];
                    (displaced + virtual_mass(BOXES[n], displaced, mass)) * change
                })
                .sum();
            let all = after + net(&world) + pending - 0.5 * (after - before);
            let off = (all - start).length() / start.length();
            println!("every {interval}, step {}: {off:e}", world.sim.step());
            // The volume in the cells equals that of the blocks to about 1e-4.
            assert!(
                off < 1e-4,
                "every {interval}, step {}: {off:e}",
                world.sim.step()
            );
        }
        assert!((net(&world) - first).length() > 0.3 * first.length());
    }
}

/// 100 blocks of 4 cells along an edge fill three tenths of a periodic box; their initial velocities drive them together.
#[test]
fn a_hundred_blocks_keep_their_momentum_and_their_memory() {
    let mut world = World::new(&format!(
        r#"{}{}
        [rock]
        gravity = [0, 0, 0]
        [numerics]
        time_step = 0.25
        eddy_viscosity = "wale"
        velocity_scale = 0.1
        [[blocks]]
        kind = "box"
        size = [2, 2, 2]
        position = [1.4, 1.4, 1.4]
        rotation = {{ axis = [1, 1, 0.5], angle = 12 }}
        velocity = [0.04, 0.02, -0.01]
        spin = [0, 0, 0.02]
        repeat = [{{ count = 5, step = [2.8, 0, 0] }}, {{ count = 5, step = [0, 2.8, 0.1] }}, {{ count = 2, step = [0.3, 0.2, 5.6] }}]
        [[blocks]]
        kind = "sphere"
        radius = 1.2407
        position = [1.6, 1.5, 4.2]
        velocity = [-0.03, 0, 0.02]
        repeat = [{{ count = 5, step = [2.8, 0, 0] }}, {{ count = 5, step = [0, 2.8, 0.1] }}, {{ count = 2, step = [0.1, 0.2, 5.6] }}]"#,
        fluid([28, 28, 28], 0.02),
        material("rock", 2650.0)
    ));
    let count = 100;
    let volume = 8.0 * f64::from(count);
    assert_near(volume / 14f64.powi(3), 0.29, 0.01);
    let all = |world: &mut World| {
        let one = |n: usize| world.momentum(n) - DENSITY * 8.0 * world.velocity(n);
        let rock: DVec3 = (0..count as usize).map(one).sum();
        world.fluid().0 + rock
    };
    let speed = |world: &World| -> f64 {
        let sum: f64 = (0..count as usize)
            .map(|n| world.velocity(n).length())
            .sum();
        sum / f64::from(count)
    };
    let start = all(&mut world);
    let mass = world.fluid().1;
    let speed_then = speed(&world);
    world.advance(40);
    let bytes = world.sim.coupled().unwrap().solid_cells().bytes();
    world.advance(160);
    let end = all(&mut world);
    println!("{start} {end}, speed {speed_then} to {}", speed(&world));
    // The undelivered momentum is three times that of the fluid inside per step, plus half a load.
    assert!(
        (end - start).length() < 0.03 * start.length(),
        "{start} {end}"
    );
    assert_relative(world.fluid().1, mass, 1e-5);
    assert!(speed(&world) < 0.8 * speed_then);
    let grown = world.sim.coupled().unwrap().solid_cells().bytes();
    assert!(grown <= bytes + bytes / 2, "{bytes} B grew to {grown} B");
}

/// Water driven by a body force past a rotated block that cuts cells, until it is steady.
#[test]
fn every_plane_carries_the_same_water() {
    let text = format!(
        r#"{}{}
            [numerics]
            time_step = 0.25
            velocity_scale = 0.05
            [[blocks]]
            name = "stone"
            kind = "box"
            size = [2.6, 2.3, 2.9]
            position = [2.6, 2.4, 2.2]
            rotation = {{ axis = [1, 2, 3], angle = 25 }}
            motion = "fixed""#,
        accelerated_fluid([10, 9, 11], 0.4, [2e-3, 0.0, 0.0]),
        material("rock", 2650.0),
    );
    let mut world = World::new(&text);
    world.advance(2400);
    // Full cells reflect their populations, hence the mean of two steps.
    let mut planes = [0.0; 10];
    for _ in 0..2 {
        world.advance(1);
        let fields = [Field::Velocity, Field::Density];
        let image = world.rig.wait(world.sim.image(&fields)).unwrap();
        let [u, rho] = [0, 1].map(|n| &image.arrays[n].values);
        for (n, (u, rho)) in u.chunks_exact(3).zip(rho).enumerate() {
            planes[n % 10] += f64::from(u[0] * rho) / (2.0 * 99.0);
        }
    }
    let mean = planes.iter().sum::<f64>() / 10.0;
    println!("{planes:?}");
    for flux in planes {
        // If all cells had half of the body force, the planes would differ by half a per cent.
        assert_relative(flux, mean, 1e-4);
    }
}
