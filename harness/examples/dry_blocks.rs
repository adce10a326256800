//! Uses blocks and contact without any GPU.
//!
//! Five dominoes stand on a floor; the first is pushed for a moment. The program prints when each one falls, and the
//! energy balance: if it does not close, the program fails.
//!
//! `cargo run --release -p riprap-harness --example dry_blocks`

use glam::{DQuat, DVec3};
use riprap::{
    geometry::{Load, Polyhedron, Shape},
    rock::{Block, Blocks, Material, Setup, broadphase::HostBroadphase},
};
use std::{error::Error, sync::Arc};

/// Thickness, width and height of a domino, m.
const DOMINO: DVec3 = DVec3::new(0.1, 0.4, 0.8);
const COUNT: usize = 5;
/// Distance from one to the next, m.
const APART: f64 = 0.4;

fn main() -> Result<(), Box<dyn Error>> {
    // Blocks of the same shape share it.
    let cuboid = |edges| Polyhedron::cuboid(edges).map(|shape| Arc::new(Shape::from(shape)));
    let floor = cuboid(DVec3::new(6.0, 2.0, 0.2))?;
    let domino = cuboid(DOMINO)?;
    let mut list = vec![Block::new("floor", floor, DVec3::new(1.0, 0.0, -0.1)).fixed()];
    for i in 0..COUNT {
        let at = DVec3::new(APART * i as f64, 0.0, 0.5 * DOMINO.z);
        list.push(Block::new(format!("domino {i}"), domino.clone(), at));
    }
    let mut blocks = Blocks::new(Setup {
        blocks: list,
        materials: vec![Material::default()],
        ..Setup::default()
    })?;
    let mut finder = HostBroadphase;

    // A push of 400 N at the top of the first one, for 0.3 s.
    let mut loads = vec![Load::default(); blocks.len()];
    loads[1] = Load::at(DVec3::X * 400.0, DVec3::Z * 0.5 * DOMINO.z);
    blocks.set_loads(&loads)?;
    let start = blocks.ledger();
    let mut fallen = [false; COUNT];
    for frame in 1..=150 {
        pollster::block_on(blocks.advance(&mut finder, 0.02 * f64::from(frame)))?;
        if frame == 15 {
            blocks.set_loads(&vec![Load::default(); blocks.len()])?;
        }
        for (i, fallen) in fallen.iter_mut().enumerate() {
            let tilt = blocks.rotation(i + 1).angle_between(DQuat::IDENTITY);
            if !*fallen && tilt > 0.5 {
                *fallen = true;
                println!("{:.2} s: domino {i} falls", blocks.time());
            }
        }
    }
    let end = blocks.ledger();
    println!("{} contacts hold {end:#?}", blocks.contacts().count());
    let error = (end.balance() - start.balance()).abs() / end.dissipated();
    println!("the energy adds up to {error:.1e} of what was taken");
    if fallen.iter().all(|&fallen| fallen) && error < 0.01 {
        Ok(())
    } else {
        Err("not all fell, or energy was lost".into())
    }
}
