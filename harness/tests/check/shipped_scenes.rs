//! The scenes shipped with the harness.

use std::path::Path;

use riprap::rock::Motion;
use riprap::scene::Scene;
use riprap::scene::build::block_setup;
use riprap::scene::build::particle_setup;
use riprap::units::Units;

/// Speed of a CPU adapter on two cores, cell updates/s.
const UPDATES: f64 = 40e6;

#[test]
fn shipped_scenes_are_sound_and_run_in_minutes() {
    let dir = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        count += 1;
        let scene = Scene::from_file(&path).unwrap();
        let mut advice = scene.suspicious_keys(1e-6);
        // With so short a step any run is long.
        advice.retain(|warning| warning.place != "run");
        assert_eq!(advice, [], "{}", path.display());
        if scene.has_particles() {
            let setup = block_setup(&scene).unwrap();
            let (_, start) = particle_setup(&scene, &setup).unwrap();
            assert!(start.positions.len() > 1000, "{}", path.display());
            continue;
        }
        if scene.has_blocks() {
            // Their run times are given in their comments: they depend on contacts that form and end.
            let setup = block_setup(&scene).unwrap().setup;
            assert!(setup.blocks.iter().any(|b| b.motion != Motion::Fixed));
            continue;
        }
        let units = Units::of(&scene).unwrap();
        assert_eq!(scene.advise(&units).unwrap(), [], "{}", path.display());
        scene.solid_mask().unwrap();
        scene.initial_fields().unwrap();
        let updates = scene.domain.cell_count() as f64 * scene.run.step_count(&units) as f64;
        assert!(
            updates / UPDATES < 60.0,
            "{}: {updates:.2e} cell updates",
            path.display()
        );
    }
    assert!(count >= 14, "{count}");
}
