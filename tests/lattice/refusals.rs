//! Setups and requests that are refused, each with the name of what is wrong.

use super::limits::limit;
use kit::assert_contains;
use riprap::{
    gpu::readback::Readback,
    lattice::{Derived, Face, Force, Grid, Lattice, Observer, Rates, Setup, memory},
    wgpu,
};

/// A device that does nothing: refused input never reaches one.
fn nothing() -> (wgpu::Device, wgpu::Queue) {
    wgpu::Device::noop(&wgpu::DeviceDescriptor::default())
}

#[test]
fn numbers_that_cannot_be_are_refused_by_name() {
    const NAN: f64 = f64::NAN;
    let (device, _) = nothing();
    let wall = || Face::Wall([0.0; 3]);
    let closed = |face: Face| move |setup: &mut Setup| setup.faces[1] = [face.clone(), wall()];
    let refused = |place: &str, change: &dyn Fn(&mut Setup)| {
        let mut setup = Setup::periodic([4; 3], 0.01);
        change(&mut setup);
        let told = Lattice::new(&device, setup).unwrap_err().to_string();
        assert!(told.starts_with(&format!("{place}: ")), "{place}: {told}");
    };
    for nu in [NAN, 0.0, -1.0, 1e300, 1e-300] {
        refused("nu", &|s| s.nu = nu);
    }
    for bad in [NAN, f64::INFINITY, 1e300] {
        refused("force", &|s| {
            s.force = Force::Constant([0.0, bad, 0.0]);
        });
        refused("force", &|s| {
            s.force = Force::Field(vec![[bad as f32; 3]; 64]);
        });
        refused("max_speed", &|s| s.max_speed = bad);
        refused("faces.y_min", &closed(Face::Wall([bad, 0.0, 0.0])));
        let inlet = Face::Velocity(vec![[0.0, bad as f32, 0.0]; 16]);
        refused("faces.y_min", &closed(inlet));
    }
    for bad in [NAN, 0.0, -1.0, 2.1, 5.0] {
        refused("rates.s4", &|s| s.rates = Some(Rates::equal(bad)));
        let s26 = Rates {
            s26: bad,
            ..Rates::SUGA
        };
        refused("rates.s26", &|s| s.rates = Some(s26));
    }
    for bad in [NAN, -1.0, 0.0, f64::INFINITY] {
        refused("lambda", &|s| s.lambda = Some(bad));
        refused("wall_lambda", &|s| s.wall_lambda = Some(bad));
        refused("solid_lambda", &|s| s.solid_lambda = Some(bad));
        let density = bad;
        refused("faces.y_min", &closed(Face::Pressure { density }));
        refused("faces.y_min", &closed(Face::Outflow { density }));
    }
    for bad in [NAN, -1.0, 2.0] {
        refused("odd_rate_floor", &|s| s.odd_rate_floor = Some(bad));
    }
    for bad in [NAN, -1.0, f64::INFINITY] {
        refused("wale", &|s| s.wale = Some(bad));
    }
    for bad in [0, 3] {
        refused("wale_interval", &|s| s.wale_interval = bad);
    }
    refused("max_speed", &|s| s.max_speed = -1.0);
    // It would push water into the domain or out of it.
    refused("faces.y_min", &closed(Face::Wall([0.0, 0.1, 0.0])));
    refused("brick", &|s| s.brick = [u32::MAX; 3]);
    refused("brick", &|s| s.brick = [1 << 31, 1 << 31, 1 << 7]);
}

#[test]
fn grids_of_more_cells_than_can_be_counted_are_refused() {
    let (device, _) = nothing();
    for cells in [[1 << 22, 1 << 21, 1 << 21], [u32::MAX; 3]] {
        let mut setup = Setup::periodic(cells, 0.01);
        setup.use_cpu_layout(wgpu::Features::empty());
        for walls in [false, true] {
            if walls {
                setup.faces = [const { [Face::FreeSlip, Face::FreeSlip] }; 3];
            }
            let message = limit(Lattice::new(&device, setup.clone()).unwrap_err());
            assert!(message.starts_with("cells of one grid"), "{message}");
        }
    }
}

#[test]
fn velocities_of_faces_that_are_none_are_refused() {
    let (device, queue) = nothing();
    let mut setup = Setup::periodic([4; 3], 0.01);
    setup.faces[0] = [
        Face::Velocity(vec![[0.01, 0.0, 0.0]; 16]),
        Face::Outflow { density: 1.0 },
    ];
    let mut lattice = Lattice::new(&device, setup).unwrap();
    let mut set =
        |axis, side, value| lattice.set_face_velocity(&queue, axis, side, vec![[value; 3]; 16]);
    assert!(set(0, 0, 0.02).is_ok());
    for (axis, side, value, told) in [
        (5, 0, 0.02, "axes are 0 to 2"),
        (0, 2, 0.02, "axes are 0 to 2"),
        (0, 1, 0.02, "faces.x_max"),
        (0, 0, f32::NAN, "faces.x_min: contains NaN"),
    ] {
        let message = set(axis, side, value).unwrap_err().to_string();
        assert!(message.contains(told), "{message}");
    }
    assert_eq!(
        lattice.setup().faces[0][0],
        Face::Velocity(vec![[0.02; 3]; 16])
    );
}

/// An output kernel has five storage buffers.
#[test]
fn a_device_of_few_bindings_is_told_of_them_and_not_of_bytes() {
    let limits = |n| wgpu::Limits {
        max_storage_buffers_per_shader_stage: n,
        ..wgpu::Limits::default()
    };
    let found = |setup: &Setup, n| memory(setup, &Grid::new(setup).unwrap(), &limits(n));
    let mut setup = Setup::periodic([8; 3], 0.01);
    assert!(found(&setup, 5).is_ok());
    let message = limit(found(&setup, 4).unwrap_err());
    assert_contains(&message, &["storage buffers per shader stage"]);
    assert!(!message.contains("bytes"), "{message}");
    setup.bindings = Some(3);
    let message = limit(found(&setup, 6).unwrap_err());
    assert!(message.contains("`bindings` to at most 2"), "{message}");
}

#[test]
fn what_a_lattice_does_not_have_is_not_observed() {
    let (device, queue) = nothing();
    let lattice = |n| Lattice::new(&device, Setup::periodic([n; 3], 0.01)).unwrap();
    let (mut own, mut other) = (lattice(4), lattice(4));
    let mut observer = Observer::new(&device, &own).unwrap();
    for kind in [Derived::EddyViscosity, Derived::Vorticity(9)] {
        let read = observer.derived(&device, &queue, &mut own, kind);
        let message = pollster::block_on(read).unwrap_err().to_string();
        assert!(message.starts_with("derived: "), "{message}");
    }
    let message = pollster::block_on(observer.state_on(&device, &queue, &mut own, Some(&[64])));
    let message = message.unwrap_err().to_string();
    assert!(message.contains("no cell 64"), "{message}");
    let message = pollster::block_on(observer.sums(&device, &queue, &mut other)).unwrap_err();
    assert!(message.to_string().contains("another lattice"), "{message}");
    let message = pollster::block_on(observer.state(&device, &queue, &mut other)).unwrap_err();
    assert!(message.to_string().contains("another lattice"), "{message}");
}

#[test]
fn more_than_a_buffer_holds_is_not_read_back() {
    let (device, queue) = nothing();
    let buffer = |usage| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 16,
            usage,
            mapped_at_creation: false,
        })
    };
    let open = buffer(wgpu::BufferUsages::COPY_SRC);
    let closed = buffer(wgpu::BufferUsages::STORAGE);
    let mut readback = Readback::default();
    for (buffer, count, told) in [
        (&open, 17, "that has 16"),
        (&open, usize::MAX, "that has 16"),
        (&open, 3, "multiple of 4"),
        (&closed, 4, "COPY_SRC"),
    ] {
        let read = readback.read::<u8>(&device, &queue, buffer, count);
        let message = pollster::block_on(read).unwrap_err().to_string();
        assert!(message.contains(told), "{message}");
    }
}
