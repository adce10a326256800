//! The fluid step and copies on every adapter. An iteration is two steps, an even and an odd one.

mod common;

use common::{Adapter, on_adapters};
use criterion::Throughput;
use kit::{
    copy::{Copy, METHODS},
    subject::{StreamOnly, Subject, sheared_noise},
};
use riprap::{
    Error,
    lattice::{Collision, Force, Lattice, Setup, Storage},
};

type Change = fn(&mut Setup);

const VARIANTS: [(&str, Change); 7] = [
    ("mrt", |_| {}),
    ("bgk", |s| s.collision = Collision::Bgk),
    ("force", |s| s.force = Force::Constant([1e-6, 0.0, 0.0])),
    ("wale", |s| s.wale = Some(0.5)),
    ("guard", |s| s.max_speed = 0.3),
    ("16-bit", |s| {
        (s.storage, s.lanes) = (Storage::F16, s.lanes.max(2));
    }),
    (STREAM_ONLY, |_| {}),
];

const STREAM_ONLY: &str = "stream only";

fn main() -> Result<(), Error> {
    on_adapters("MLUPS of collide_stream, MB/s of copy", |adapter| {
        for n in [32u32, 64] {
            steps(adapter, n)?;
        }
        let copy = Copy::new(&adapter.device, 32 << 20)?;
        for method in METHODS {
            let work = Throughput::Bytes(2 * copy.traffic() as u64);
            let variant = format!("{method:?}");
            adapter.turns("copy", &variant, (2, work), Subject::Copying(&copy, method));
        }
        Ok(())
    })
}

fn steps(adapter: &mut Adapter<'_>, n: u32) -> Result<(), Error> {
    for (variant, change) in VARIANTS {
        let mut setup = adapter.setup(n);
        change(&mut setup);
        let state = sheared_noise(&setup)?;
        let mut lattice = Lattice::new(&adapter.device, setup)?;
        lattice.start(&adapter.device, &adapter.queue, &state, true)?;
        let subject = match variant {
            STREAM_ONLY => Subject::Streaming(Box::new(StreamOnly::new(&adapter.device, lattice)?)),
            _ => Subject::Steps(Box::new(lattice)),
        };
        let work = Throughput::Elements(2 * u64::from(n).pow(3));
        adapter.turns(
            "collide_stream",
            &format!("{variant} {n}³"),
            (2, work),
            subject,
        );
    }
    Ok(())
}
