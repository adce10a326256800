//! Fluids of particles: their keys, and what they leave no room for.

use riprap::scene::build::block_setup;
use riprap::scene::*;
use riprap::units::Units;

use crate::{CHANNEL, read, refused};

/// A dam of water in a tank, open above, its sides periodic.
pub const TANK: &str = r#"
[domain]
size = [4.0, 1.0, 2.0]
[fluid]
acceleration = [0, 0, -9.81]
[particles]
spacing = 0.05
[boundaries]
x_min = { kind = "wall" }
x_max = { kind = "free_slip" }
z_min = { kind = "wall" }
z_max = { kind = "open" }
[[water]]
kind = "box"
size = [1.0, 1.0, 1.0]
position = [0.5, 0.5, 0.5]
[run]
duration = 1
"#;

fn tank(more: &str) -> riprap::Result<Scene> {
    read(&format!("{TANK}{more}"))
}

fn changed(from: &str, to: &str) -> riprap::Result<Scene> {
    assert!(TANK.contains(from));
    read(&TANK.replace(from, to))
}

#[test]
fn a_minimal_tank_has_the_documented_defaults() {
    let scene = tank("").unwrap();
    assert!(scene.has_particles() && scene.has_fluid() && !scene.has_blocks());
    let particles = scene.particles.unwrap();
    assert_eq!(particles, Particles::of(0.05));
    assert_eq!(
        (particles.smoothing, particles.courant, particles.plane),
        (2.0, 0.7, false)
    );
    assert_eq!(particles.largest_speed, None);
    assert_eq!(particles.artificial_viscosity, 0.005);
    assert_eq!(particles.density_diffusion, 0.1);
    assert_eq!(particles.equation_of_state, EquationOfState::Linear);
    assert_eq!((particles.layers(), particles.smoothing_length()), (4, 0.1));
    assert_eq!(scene.water[0].velocity, [0.0; 3]);
    assert_eq!((scene.fluid.density, scene.fluid.viscosity), (1000.0, 0.0));
    assert_eq!(scene.boundaries.z_max, Boundary::Open);
}

#[test]
fn stiffness_belongs_to_the_scheme_that_has_one() {
    let keys = |more: &str| changed("spacing = 0.05", &format!("spacing = 0.05\n{more}"));
    let scene = keys("scheme = \"mueller\"\nstiffness = 50").unwrap();
    assert_eq!(scene.particles.unwrap().stiffness, Some(50.0));
    for (more, what) in [
        ("stiffness = 50", "mueller"),
        ("scheme = \"mueller\"\nstiffness = 0", "stiffness"),
    ] {
        let error = keys(more).unwrap_err().to_string();
        assert!(
            error.contains("particles.stiffness") && error.contains(what),
            "{error}"
        );
    }
}

#[test]
fn layers_reach_as_far_as_the_kernel() {
    let layers = |smoothing| Particles {
        smoothing,
        ..Particles::of(0.3)
    };
    for (smoothing, count) in [(1.2, 3), (1.3, 3), (1.5, 3), (2.0, 4), (2.1, 5), (3.0, 6)] {
        assert_eq!(layers(smoothing).layers(), count, "{smoothing}");
    }
}

#[test]
fn every_key_of_particles_is_understood() {
    let scene = read(
        r#"
[domain]
size = [4.0, 0.123, 2.0]
[fluid]
density = 998
viscosity = 1e-6
acceleration = [0, 0, -9.81]
[particles]
spacing = 0.05
smoothing = 1.5
scheme = "delta"
equation_of_state = "tait"
largest_speed = 5
artificial_viscosity = 0
density_diffusion = 0.2
courant = 0.1
plane = true
[boundaries]
x_min = { kind = "wall" }
x_max = { kind = "wall" }
z_min = { kind = "wall" }
z_max = { kind = "open" }
[[water]]
kind = "vertices"
vertices = [[0,0,0],[1,0,0],[0,1,0],[0,0,1]]
position = [0.1, 0, 0.2]
rotation = { axis = [0, 1, 0], angle = 10 }
velocity = [1, 0, 0]
[run]
duration = 1
[output]
fields = ["velocity", "pressure", "density"]
[[output.histories]]
quantities = ["mass", "kinetic_energy", "potential_energy", "max_speed", "momentum_x"]
[[probes]]
name = "level"
kind = "gauge"
at = [1, 0.1]
every = 0.1
[[probes]]
name = "sensor"
kind = "point"
at = [1, 0.1, 0.2]
fields = ["pressure"]
[[probes]]
name = "front"
kind = "run_up"
min = [0, 0, 0]
max = [4, 0.1, 2]
direction = "+x"
"#,
    )
    .unwrap();
    let particles = scene.particles.unwrap();
    assert_eq!(particles.equation_of_state, EquationOfState::Tait);
    assert_eq!(particles.largest_speed, Some(5.0));
    assert!(particles.plane);
    assert_eq!(scene.water[0].rotation.angle, 10.0);
    assert_eq!(scene.probes[0].place, ProbePlace::Gauge { at: [1.0, 0.1] });
    assert!(matches!(
        scene.probes[2].place,
        ProbePlace::RunUp {
            direction: Direction::PlusX,
            ..
        }
    ));
}

#[test]
fn particles_that_contradict_themselves_are_refused() {
    for (from, to, parts) in [
        (
            "spacing = 0.05",
            "spacing = 0",
            ["particles.spacing", "greater"],
        ),
        (
            "spacing = 0.05",
            "spacing = 0.03",
            ["domain.size[1]", "33.333333 particles"],
        ),
        (
            "spacing = 0.05",
            "spacing = 0.2",
            [
                "domain.size[1]",
                "hold 5 particles 0.2 m apart, and the kernel wants 12 at least",
            ],
        ),
        (
            "spacing = 0.05",
            "spacing = 0.05\nsmoothing = 1",
            ["particles.smoothing", "1.2 to 3"],
        ),
        (
            "spacing = 0.05",
            "spacing = 0.05\nscheme = \"muller\"",
            ["no word `muller`", "delta"],
        ),
        (
            "spacing = 0.05",
            "spacing = 0.05\nlargest_speed = 0",
            ["particles.largest_speed", "greater"],
        ),
        (
            "spacing = 0.05",
            "spacing = 0.05\nartificial_viscosity = -1",
            ["particles.artificial_viscosity", "from 0"],
        ),
        (
            "spacing = 0.05",
            "spacing = 0.05\ndensity_diffusion = nan",
            ["particles.density_diffusion", "from 0"],
        ),
        (
            "spacing = 0.05",
            "spacing = 0.05\ncourant = 1.1",
            ["particles.courant", "at most 1,"],
        ),
        (
            "[fluid]",
            "[fluid]\nviscosity = -1",
            ["fluid.viscosity", "from 0"],
        ),
        ("-9.81]", "\"x\"]", ["fluid.acceleration", "three numbers"]),
        (
            "size = [1.0, 1.0, 1.0]",
            "size = [1.0, 0, 1.0]",
            ["water[0].size[1]", "greater"],
        ),
        (
            "size = [1.0, 1.0, 1.0]",
            "size = [1.0, 1.0, 1.0]\nvelocity = [inf, 0, 0]",
            ["water[0].velocity", "finite"],
        ),
        ("[particles]\nspacing = 0.05", "", ["water", "[particles]"]),
        (
            "[fluid]\nacceleration = [0, 0, -9.81]",
            "",
            ["particles", "add [fluid]"],
        ),
    ] {
        refused(changed(from, to), &parts);
    }
    let water = TANK.find("[[water]]").unwrap();
    let run = TANK.find("[run]").unwrap();
    let dry = format!("{}{}", &TANK[..water], &TANK[run..]);
    refused(read(&dry), &["water", "add [[water]]"]);
}

#[test]
fn what_is_of_a_lattice_is_refused_among_particles() {
    refused(
        changed(
            "size = [4.0, 1.0, 2.0]",
            "size = [4.0, 1.0, 2.0]\ncell = 0.1",
        ),
        &["domain.cell", "no cells"],
    );
    for (kind, parts) in [
        ("\"pressure\"", ["boundaries.z_max", "`pressure`"]),
        (
            "\"velocity\", velocity = [0, 0, 0]",
            ["boundaries.z_max", "`velocity`"],
        ),
        (
            "\"wall\", velocity = [1, 0, 0]",
            ["boundaries.z_max.velocity", "driven"],
        ),
    ] {
        refused(changed("\"open\"", kind), &parts);
    }
    let slice = "[[output.slices]]\nname = \"s\"\naxis = \"y\"\nfield = \"speed\"\n";
    let view = "[[views]]\nname = \"v\"\ntraces = 10\n";
    for (more, parts) in [
        ("[numerics]\nmach = 0.1\n", ["numerics", "lattice"]),
        ("[initial]\npressure = 1\n", ["initial", "lattice"]),
        (slice, ["output.slices", "lattice"]),
        (
            "[output]\nfields = [\"vorticity\"]\n",
            ["output.fields", "no vorticity"],
        ),
        (
            "[[output.histories]]\nquantities = [\"enstrophy\"]\n",
            ["output.histories[0].quantities", "enstrophy"],
        ),
        (view, ["views[0]", "always shown"]),
        (
            "[[probes]]\nname = \"p\"\nkind = \"plane\"\naxis = \"x\"\nposition = 1\n",
            ["probes[0]", "gauge"],
        ),
        (
            "[[probes]]\nname = \"p\"\nkind = \"gauge\"\nat = [9, 0]\n",
            ["probes[0].at", "outside"],
        ),
        (
            "[[probes]]\nname = \"p\"\nkind = \"gauge\"\nat = [1, 0, 0]\n",
            ["`at` has 3 numbers", "x and y"],
        ),
        (
            "[[probes]]\nname = \"p\"\nkind = \"gauge\"\nat = [1, 0]\nfields = [\"pressure\"]\n",
            ["`gauge`", "remove `fields`"],
        ),
        (
            "[[probes]]\nname = \"p\"\nkind = \"point\"\nat = [1, 0, 0]\nfields = [\"solid\"]\n",
            ["probes[0].fields", "no solid"],
        ),
        (
            "[[solids]]\nkind = \"sphere\"\ncenter = [1, 0.5, 1]\nradius = 0.2\nvoid = true\n",
            ["solids[0].void", "hole"],
        ),
    ] {
        refused(tank(more), &parts);
    }
    refused(
        read(
            &TANK
                .replace("spacing = 0.05", "spacing = 0.05\nplane = true")
                .replace(
                    "[boundaries]",
                    "[boundaries]\ny_min = { kind = \"wall\" }\ny_max = { kind = \"open\" }",
                ),
        ),
        &["boundaries.y_max", "nothing varies along y"],
    );
    refused(Units::of(&tank("").unwrap()), &["particles", "no lattice"]);
}

#[test]
fn what_is_of_particles_is_refused_on_a_lattice() {
    for (more, parts) in [
        (
            "[boundaries]\nz_min = { kind = \"wall\" }\nz_max = { kind = \"open\" }\n",
            ["boundaries.z_max", "[particles]"],
        ),
        (
            "[[water]]\nkind = \"sphere\"\nradius = 1e-3\n",
            ["water", "[particles]"],
        ),
        (
            "[[output.histories]]\nquantities = [\"potential_energy\"]\n",
            ["output.histories[0].quantities", "particles"],
        ),
        (
            "[[probes]]\nname = \"p\"\nkind = \"gauge\"\nat = [0, 0]\n",
            ["probes[0]", "free water"],
        ),
        (
            "[[probes]]\nname = \"p\"\nkind = \"sensor\"\nat = [0, 0, 0]\nnormal = \"+z\"\nsize = 1e-3\n",
            ["probes[0]", "free water"],
        ),
        (
            "[[probes]]\nname = \"p\"\nkind = \"run_up\"\nmin = [0, 0, 0]\nmax = [1e-3, 1e-3, 1e-3]\ndirection = \"+x\"\n",
            ["probes[0]", "free water"],
        ),
    ] {
        refused(read(&format!("{CHANNEL}{more}")), &parts);
    }
}

#[test]
fn walls_hold_water_without_a_material() {
    let solid = "[[solids]]\nkind = \"box\"\nmin = [2, 0, 0]\nmax = [3, 1, 1]\n";
    let setup = block_setup(&tank(solid).unwrap()).unwrap().setup;
    let names: Vec<&str> = setup.blocks.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(names, ["solid_1", "wall_x_min", "wall_x_max", "wall_z_min"]);
    assert_eq!(setup.materials.len(), 1);
}

#[test]
fn loads_on_faces_are_of_cells() {
    let block = "[[materials]]\nname = \"rock\"\ndensity = 2500\nnormal_stiffness = 1e8\nfriction = 30\n\
                 [[blocks]]\nname = \"b\"\nkind = \"box\"\nsize = [0.2, 0.2, 0.2]\nposition = [2, 0.5, 1]\n\
                 [[probes]]\nname = \"p\"\nkind = \"block\"\nblock = \"b\"\n";
    tank(block).unwrap();
    refused(
        tank(&format!("{block}faces = true\n")),
        &["probes[0].faces", "particles"],
    );
}

#[test]
fn blocks_meet_across_periodic_sides_but_not_in_a_plane() {
    let period = |scene: riprap::Result<Scene>| block_setup(&scene.unwrap()).unwrap().setup.period;
    let found = period(tank("")).expect("the sides are periodic");
    assert_eq!(found.origin, glam::DVec3::ZERO);
    assert_eq!(found.size.to_array(), [f64::INFINITY, 1.0, f64::INFINITY]);
    let plane = changed("spacing = 0.05", "spacing = 0.05\nplane = true");
    assert_eq!(period(plane), None);
    let flow = period(read(CHANNEL)).expect("some faces are periodic");
    assert!(flow.size.min_element().is_finite());
}

/// −1.2 + 7.6 is 6.3999… in binary.
#[test]
fn probes_reach_the_end_of_the_domain_whatever_rounding_makes_of_it() {
    let rounded = TANK.replace("size = [4.0,", "origin = [-1.2, 0, 0]\nsize = [7.6,");
    let probe = |end: f64| {
        let keys = "kind = \"box\"\nname = \"all\"\nmin = [-1.2, 0, 0]";
        read(&format!(
            "{rounded}[[probes]]\n{keys}\nmax = [{end}, 1, 2]\n"
        ))
    };
    // −1.2 + 7.6 is less than 6.4 in f64.
    probe(6.4).unwrap();
    refused(probe(6.4001), &["probes[0].max", "outside the domain"]);
}

/// The documentation of scenes says what a table holds where there is no water.
#[test]
fn the_schema_says_what_dry_probes_write() {
    let schema = serde_json::to_value(schemars::schema_for!(ProbePlace)).unwrap();
    let kinds = schema["oneOf"].as_array().unwrap();
    for name in ["point", "line", "box", "gauge", "run_up"] {
        let of = |kind: &&serde_json::Value| kind["properties"]["kind"]["const"] == name;
        let kind = kinds.iter().find(of).expect(name);
        let told = kind["description"].as_str().unwrap();
        assert!(told.contains("NaN"), "{name}: {told}");
    }
}
