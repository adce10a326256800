//! The state between two steps, whole.

use super::{
    Blocks,
    body::State,
    books::Books,
    bytes::{Plain, fields},
    deforming::Strain,
    films::Film,
    pairs::Mark,
    touch::{Pair, Touch},
    touches::Touches,
};
use crate::{
    Error, Result,
    rock::{
        contact::{Cache, Seam},
        law::{Force, History},
    },
};

/// First bytes of a snapshot; the digit is the version of the form.
const MAGIC: &[u8; 16] = b"riprap blocks 5\n";

/// Everything that the next steps depend on: poses, momenta, deformations, forces, contact histories, what the
/// resolver remembers, the ledger. What does not change, such as shapes, is in the
/// [`Setup`](super::Setup).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Snapshot {
    time: f64,
    steps: u64,
    time_step: f64,
    started: bool,
    states: Vec<State>,
    marks: Vec<Mark>,
    pairs: Vec<Pair>,
    touches: Vec<Touch>,
    films: Vec<Film>,
    books: Books,
    /// Of blocks that deform.
    strains: Vec<Strain>,
}

impl Snapshot {
    /// Time, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// As bytes, the same on every machine.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        self.write(&mut bytes);
        bytes
    }

    /// From what [`Snapshot::to_bytes`] gave.
    ///
    /// # Errors
    /// [`Error::Argument`] if the bytes are no snapshot, or are cut short.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let Some(mut rest) = bytes.strip_prefix(MAGIC) else {
            let message = "this is no snapshot of this version of riprap";
            return Err(Error::argument("snapshot", message));
        };
        let snapshot = Self::read(&mut rest)?;
        if rest.is_empty() {
            Ok(snapshot)
        } else {
            let message = format!("{} bytes too many", rest.len());
            Err(Error::argument("snapshot", message))
        }
    }
}

impl Blocks {
    /// The present state.
    pub fn snapshot(&self) -> Snapshot {
        let mut snapshot = Snapshot::default();
        self.save(&mut snapshot);
        snapshot
    }

    /// The present state in place of an older one, whose memory it uses.
    pub fn save(&self, snapshot: &mut Snapshot) {
        snapshot.time = self.time;
        snapshot.steps = self.steps;
        snapshot.time_step = self.time_step;
        snapshot.started = self.started;
        snapshot.states.clone_from(&self.states);
        snapshot.marks.clone_from(&self.marks);
        snapshot.pairs.clone_from(&self.pairs);
        self.touches
            .list(&mut snapshot.pairs, &mut snapshot.touches);
        snapshot.films.clear();
        snapshot.films.extend(self.touches.films());
        snapshot.books = self.books;
        snapshot.strains.clone_from(&self.deforming.strains);
    }

    /// Goes back, or on, to a state of the same setup: the next steps give the same bits as they did
    /// from there.
    ///
    /// # Errors
    /// [`Error::Argument`] if the state is not one of these blocks.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<()> {
        let parts = self.parts.block.len() as u32;
        let blocks = self.len() as u32;
        let way = |turns| self.period().map(|period| period.way(turns));
        let known = |pair: &Pair| {
            pair.parts.iter().all(|&part| part < parts)
                && (pair.turns == [0; 3] || way(pair.turns).is_some_and(|way| way.is_finite()))
                && (pair.touch == super::touch::NONE
                    || (pair.touch as usize) < snapshot.touches.len())
        };
        let own = |touch: &Touch| {
            touch
                .parts
                .iter()
                .zip(touch.blocks)
                .all(|(&part, block)| self.parts.block.get(part as usize) == Some(&block))
        };
        let fits = snapshot.states.len() == self.len()
            && snapshot.strains.len() == self.deforming.strains.len()
            && (snapshot.marks.is_empty() || snapshot.marks.len() == self.len())
            && snapshot.pairs.iter().all(known)
            && snapshot.touches.iter().all(own)
            && snapshot
                .films
                .iter()
                .all(|film| film.blocks.iter().all(|&block| block < blocks));
        if !fits {
            let message = format!(
                "it holds {} blocks, {} of them deformable, these are {} and {} of another scene",
                snapshot.states.len(),
                snapshot.strains.len(),
                self.len(),
                self.deforming.strains.len()
            );
            return Err(Error::argument("snapshot", message));
        }
        self.time = snapshot.time;
        self.steps = snapshot.steps;
        self.time_step = snapshot.time_step;
        self.started = snapshot.started;
        self.states.clone_from(&snapshot.states);
        self.marks.clone_from(&snapshot.marks);
        self.pairs.clone_from(&snapshot.pairs);
        self.touches = Touches::from_list(&snapshot.touches, &snapshot.films);
        self.books = snapshot.books;
        self.deforming.strains.clone_from(&snapshot.strains);
        self.place();
        Ok(())
    }
}

fields!(Snapshot {
    time,
    steps,
    time_step,
    started,
    states,
    marks,
    pairs,
    touches,
    films,
    books,
    strains
});
fields!(Film {
    blocks,
    normal,
    arms,
    resistance
});
fields!(State {
    centre,
    rotation,
    velocity,
    momentum,
    spin,
    force,
    torque,
    load,
    load_torque,
    slow,
    asleep,
    slept,
});
fields!(Strain {
    deformation,
    rate,
    moment,
    load,
    marked
});
fields!(Mark {
    centre,
    rotation,
    room
});
fields!(Pair {
    parts,
    turns,
    cache,
    touch
});
fields!(Cache {
    plane,
    point,
    contact,
    second
});
fields!(Touch {
    parts,
    blocks,
    way,
    point,
    pressure_centre,
    normal,
    overlap,
    area,
    section,
    width,
    limit,
    force,
    seam,
    stored,
    power,
});
fields!(Force {
    spring,
    dashpot,
    moment,
    bending,
    friction,
    history
});
fields!(History {
    shear,
    normal,
    bonded,
    slip
});
fields!(Seam {
    area,
    overlap,
    arms,
    normals,
    axis,
    extents,
    seconds
});
fields!(Books {
    friction,
    lost,
    film,
    work,
    power
});
