//! Bitwise equal results of two runs, and of runs restarted anywhere.

use crate::fixture::{World, fluid, material};
use riprap::{
    scene::Field,
    simulation::checkpoint::{Checkpoint, FluidState, LatticeState},
};

/// A free block that leaves its tiles, a driven block, one that is asleep on the floor, and a fixed one.
pub fn scene(interval: u32, average: bool) -> String {
    format!(
        r#"{}{}{}damping = 0.7
        [boundaries]
        z_min = {{ kind = "wall" }}
        z_max = {{ kind = "free_slip" }}
        [rock]
        sleep = {{ speed = 2e-3, time = 1.5 }}
        gravity = [0, 0, -0.01]
        [coupling]
        interval = {interval}
        average = {average}
        [numerics]
        time_step = 0.25
        eddy_viscosity = "wale"
        solid_operator = "noble"
        [[blocks]]
        kind = "box"
        size = [2, 2, 1.5]
        position = [0.5, 2, 4.8]
        rotation = {{ axis = [1, 2, 3], angle = 40 }}
        velocity = [0.14, 0.1, 0]
        spin = [0.05, 0.1, 0.15]
        [[blocks]]
        kind = "sphere"
        radius = 1
        position = [5, 2, 2.5]
        motion = "driven"
        velocity = ["0.05 * sin(0.3 * t)", 0, 0]
        [[blocks]]
        kind = "box"
        size = [2, 2, 1]
        position = [2, 5, 0.5]
        material = "heavy"
        [[blocks]]
        kind = "box"
        size = [1, 1, 1]
        position = [5.3, 5.3, 3]
        motion = "fixed""#,
        fluid([14, 14, 14], 0.02),
        material("rock", 2000.0),
        // Too heavy for the flow to wake it.
        material("heavy", 20_000.0)
    )
}

impl World {
    /// The whole state as written to files.
    fn bits(&mut self) -> Vec<u8> {
        let checkpoint = self.rig.wait(self.sim.checkpoint()).unwrap();
        let file = tempfile::NamedTempFile::new().unwrap();
        checkpoint.write(file.path()).unwrap();
        std::fs::read(file.path()).unwrap()
    }

    fn load(&mut self, bits: &[u8]) {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), bits).unwrap();
        let checkpoint = Checkpoint::read(file.path()).unwrap();
        self.sim.restore(&checkpoint).unwrap();
    }
}

#[test]
fn runs_repeat_and_go_on_from_every_cut() {
    for (interval, average) in [(1, false), (3, true)] {
        let text = scene(interval, average);
        // Before and after a readback, at odd and even steps, awake and asleep.
        let cuts = [1, 5, 13, 24, 36, 47];
        let mut whole = World::new(&text);
        let (mut saved, mut slept) = (Vec::new(), 0);
        for cut in cuts {
            whole.advance(cut - whole.sim.step());
            saved.push(whole.bits());
            let mut asleep = whole.sim.coupled().unwrap().blocks().asleep();
            slept += u32::from(asleep.any(|asleep| asleep));
        }
        assert!((1..cuts.len() as u32).contains(&slept), "{slept}");
        whole.advance(60 - whole.sim.step());
        let expected = whole.bits();
        let coupled = whole.sim.coupled().unwrap();
        let searches = coupled.exchanges().cells.searches;
        assert!(searches > 2, "the tiles were found {searches} times");

        let mut other = World::new(&text);
        other.advance(60);
        assert!(other.bits() == expected, "a second time, every {interval}");
        // Into a run that has continued, with loads in transit.
        for (cut, bits) in cuts.iter().zip(&saved) {
            other.load(bits);
            assert!(
                other.bits() == *bits,
                "as it was, cut at {cut}, every {interval}"
            );
            other.advance(60 - cut);
            assert!(other.bits() == expected, "cut at {cut}, every {interval}");
        }
        let mut fresh = World::new(&text);
        fresh.load(&saved[3]);
        fresh.advance(60 - cuts[3]);
        assert!(fresh.bits() == expected, "a new run, every {interval}");
    }
}

/// Its strain makes it longer and shorter than the period.
#[test]
fn a_deformable_block_as_long_as_the_period_goes_on_from_a_cut() {
    let text = format!(
        r#"{}{}youngs_modulus = 1e4
        [boundaries]
        z_min = {{ kind = "wall" }}
        z_max = {{ kind = "wall" }}
        [rock]
        gravity = [0, 0, 0]
        [numerics]
        time_step = 0.25
        [[blocks]]
        kind = "box"
        size = [4, 2, 1]
        position = [2, 1.5, 1.4]
        velocity = [0.1, 0, 0]
        deformable = true
        initial_stress = [10, 0, 0, 0, 0, 0]"#,
        fluid([8, 6, 6], 0.02),
        material("rock", 2000.0),
    );
    let mut whole = World::new(&text);
    whole.advance(7);
    let cut = whole.bits();
    whole.advance(23);
    let mut fresh = World::new(&text);
    fresh.load(&cut);
    fresh.advance(23);
    assert!(fresh.bits() == whole.bits());
}

/// The effect of solids in the last step is in the velocities of their cells and in no population.
#[test]
fn a_restart_shows_what_the_run_showed() {
    let fields = [
        Field::Velocity,
        Field::Pressure,
        Field::Vorticity,
        Field::EddyViscosity,
    ];
    let shown = |world: &mut World| {
        let image = world.rig.wait(world.sim.image(&fields)).unwrap();
        let arrays = image.arrays.into_iter();
        arrays
            .map(|a| a.values.into_iter().map(f32::to_bits).collect::<Vec<_>>())
            .collect::<Vec<_>>()
    };
    let text = scene(1, false);
    let mut whole = World::new(&text);
    for cut in [0, 7, 20] {
        whole.advance(cut - whole.sim.step());
        let bits = whole.bits();
        let expected = shown(&mut whole);
        let mut fresh = World::new(&text);
        fresh.load(&bits);
        assert!(shown(&mut fresh) == expected, "a new run, cut at {cut}");
        // From a state that has not been continued yet.
        let again = fresh.bits();
        assert!(again == bits, "written again, cut at {cut}");
        let mut other = World::new(&text);
        other.advance(3);
        other.load(&bits);
        assert!(shown(&mut other) == expected, "another run, cut at {cut}");
        whole.advance(1);
        fresh.advance(1);
        assert!(shown(&mut fresh) == shown(&mut whole), "a step after {cut}");
    }
}

/// Between two exchanges the loads on faces are those of the last one.
#[test]
fn a_restart_between_exchanges_has_the_loads_on_faces() {
    let text = format!(
        r#"{}
        name = "fixed"
        [[probes]]
        name = "loads"
        kind = "block"
        block = "fixed"
        faces = true"#,
        scene(3, false)
    );
    let mut whole = World::new(&text);
    for cut in [7, 8, 9] {
        whole.advance(cut - whole.sim.step());
        let bits = whole.bits();
        let faces = |world: &World| world.sim.coupled().unwrap().face_loads(3).to_vec();
        assert_eq!(faces(&whole).len(), 6);
        let mut fresh = World::new(&text);
        fresh.load(&bits);
        assert_eq!(faces(&fresh), faces(&whole), "cut at {cut}");
    }
}

fn lattice(checkpoint: &mut Checkpoint) -> &mut LatticeState {
    match &mut checkpoint.fluid {
        Some(FluidState::Lattice(state)) => state,
        _ => panic!("no fluid on a lattice"),
    }
}

#[test]
fn checkpoints_of_other_scenes_leave_everything_as_it_is() {
    let mut world = World::new(&scene(1, true));
    world.advance(4);
    let bits = world.bits();
    let fewer = scene(1, true).replace(
        "motion = \"fixed\"",
        "motion = \"fixed\"\nrepeat = { count = 2, step = [0, 0, 1.2] }",
    );
    let mut other = World::new(&fewer);
    other.advance(2);
    let state = other.rig.wait(other.sim.checkpoint()).unwrap();
    let error = world.sim.restore(&state).unwrap_err().to_string();
    assert!(error.contains("blocks"), "{error}");
    assert!(world.bits() == bits);
    let mut dry = state.clone();
    dry.rock = None;
    lattice(&mut dry).coupling = None;
    let error = world.sim.restore(&dry).unwrap_err().to_string();
    assert!(error.contains("without blocks"), "{error}");
    let mut broken = world.rig.wait(world.sim.checkpoint()).unwrap();
    let mut outside = broken.clone();
    lattice(&mut broken).populations.values.truncate(27);
    lattice(&mut outside).inside.cells[0] = u32::MAX;
    world.advance(3);
    let bits = world.bits();
    for bad in [broken, outside] {
        assert!(world.sim.restore(&bad).is_err());
        assert!(world.bits() == bits);
    }
}
