//! Evenly spaced streamlines (Jobard and Lefer, 1997, "Creating evenly-spaced streamlines of arbitrary density"): each new
//! line begins at a set distance from an existing one, and ends where it would come nearer than half of that to another.

use super::field_lines::{Field, Taken};
use super::section::Section;
use std::collections::VecDeque;

/// Smallest distance between lines, relative to the distance at which lines begin; the value of the paper.
const NEAREST: f64 = 0.5;
/// Smallest distance of a line from itself: less, so that a closed line looks closed.
const NEAREST_SELF: f64 = 0.15;
/// Length of the shortest line worth drawing, in the same unit.
const SHORTEST: f64 = 2.0;
/// Step relative to the cell size: bilinear velocity bends little within half a cell.
const STEP: f64 = 0.5;
/// Fraction of the largest speed below which f32 data does not resolve the direction.
const STILL: f64 = 1e-5;

/// Lines along the velocity in `section`, `separation` (m) apart, each a list of points (m) downstream; none if the
/// section has no velocity.
pub fn streamlines(section: &Section, separation: f64) -> Vec<Vec<[f64; 2]>> {
    let cells = 0..section.values.len();
    let speeds = cells.clone().filter_map(|cell| {
        let [u, v] = section.velocity_at(centre(section, cell))?;
        Some((cell, u.hypot(v))).filter(|(_, speed)| speed.is_finite())
    });
    let Some((fastest, speed)) = speeds.max_by(|a, b| a.1.total_cmp(&b.1)) else {
        return Vec::new();
    };
    let mut tracer = Tracer {
        section,
        still: STILL * speed,
        separation,
        taken: Taken::new(separation),
        lines: Vec::new(),
    };
    // Seeds next to lines first, since they pack best; then every cell that is still far from all lines, for closed eddies.
    let mut next = VecDeque::new();
    for cell in std::iter::once(fastest).chain(cells) {
        tracer.seed(centre(section, cell), &mut next);
        while let Some(line) = next.pop_front() {
            for seed in beside(&tracer.lines[line], separation) {
                tracer.seed(seed, &mut next);
            }
        }
    }
    tracer.lines
}

fn centre(section: &Section, cell: usize) -> [f64; 2] {
    let place = [cell % section.cells[0], cell / section.cells[0]];
    [0, 1].map(|axis| section.origin[axis] + section.spacing * (place[axis] as f64 + 0.5))
}

/// Points at the distance `separation` on both sides of a line.
fn beside(line: &[[f64; 2]], separation: f64) -> Vec<[f64; 2]> {
    line.windows(2)
        .flat_map(|pair| {
            let [dx, dy] = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
            // Slightly further, so that rounding does not put the seed too near to its own line.
            let shift = 1.001 * separation / dx.hypot(dy);
            [shift, -shift].map(|shift| [pair[0][0] - shift * dy, pair[0][1] + shift * dx])
        })
        .collect()
}

struct Tracer<'a> {
    section: &'a Section,
    still: f64,
    separation: f64,
    taken: Taken<2>,
    lines: Vec<Vec<[f64; 2]>>,
}

impl Tracer<'_> {
    /// Traces the line through `seed` if that is far enough from all lines, and keeps it if it is long enough to show a
    /// direction.
    fn seed(&mut self, seed: [f64; 2], next: &mut VecDeque<usize>) {
        if self.direction(seed).is_none() || self.taken.near(seed, self.separation) {
            return;
        }
        let field = Field {
            direction: |point| self.direction(point),
            step: STEP * self.section.spacing,
            own: NEAREST_SELF * self.separation,
            // A line longer than all cells does not end.
            most: 2 * self.section.values.len(),
        };
        let nearest = NEAREST * self.separation;
        let line = field.line(seed, |point| self.taken.near(point, nearest));
        if (line.len() - 1) as f64 * STEP * self.section.spacing > SHORTEST * self.separation {
            line.iter().for_each(|&point| self.taken.add(point));
            next.push_back(self.lines.len());
            self.lines.push(line);
        }
    }

    fn direction(&self, point: [f64; 2]) -> Option<[f64; 2]> {
        let [u, v] = self.section.velocity_at(point)?;
        let speed = u.hypot(v);
        (speed > self.still).then(|| [u / speed, v / speed])
    }
}
