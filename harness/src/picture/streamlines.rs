//! Streamlines at even distances (Jobard and Lefer, 1997, "Creating evenly-spaced streamlines of
//! arbitrary density"): each new line begins at a set distance from one already there, and ends
//! where it would come nearer than half of that to another.

use super::section::Section;
use std::collections::VecDeque;

/// How near a line may come to others, in parts of the distance at which lines begin; the paper's
/// own choice.
const NEAREST: f64 = 0.5;
/// How near a line may come to itself: less, so that a closed one looks closed.
const NEAREST_SELF: f64 = 0.15;
/// Length of the shortest line worth drawing, in the same parts.
const SHORTEST: f64 = 2.0;
/// Steps in parts of a cell: bilinear velocity bends little within half of one.
const STEP: f64 = 0.5;
/// Water slower than this part of the fastest has no direction that f32 data could tell.
const STILL: f64 = 1e-5;

/// Lines along the velocity in `section`, `separation` (m) apart, each a list of points (m)
/// downstream; none where the section has no velocity.
pub fn streamlines(section: &Section, separation: f64) -> Vec<Vec<[f64; 2]>> {
    let Some(velocity) = &section.velocity else {
        return Vec::new();
    };
    let speed = |cell: usize| velocity[cell][0].hypot(velocity[cell][1]);
    let fluid = |cell: &usize| !section.solid[*cell] && speed(*cell).is_finite();
    let cells = 0..velocity.len();
    let Some(fastest) = cells
        .clone()
        .filter(fluid)
        .max_by(|a, b| speed(*a).total_cmp(&speed(*b)))
    else {
        return Vec::new();
    };
    let mut tracer = Tracer {
        section,
        still: STILL * speed(fastest),
        separation,
        taken: Taken::new(section, separation),
        lines: Vec::new(),
    };
    // Seeds beside lines first, since they pack best; then every cell that is still far from all,
    // for water that turns by itself.
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

/// Points at `separation` on both sides of a line.
fn beside(line: &[[f64; 2]], separation: f64) -> Vec<[f64; 2]> {
    line.windows(2)
        .flat_map(|pair| {
            let [dx, dy] = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
            // A hair further, so that rounding does not make the seed too near to its own line.
            let shift = 1.001 * separation / dx.hypot(dy);
            [shift, -shift].map(|shift| [pair[0][0] - shift * dy, pair[0][1] + shift * dx])
        })
        .collect()
}

struct Tracer<'a> {
    section: &'a Section,
    still: f64,
    separation: f64,
    taken: Taken,
    lines: Vec<Vec<[f64; 2]>>,
}

impl Tracer<'_> {
    /// Traces the line through `seed` if that is far enough from all lines, and keeps it if it is
    /// long enough to show a direction.
    fn seed(&mut self, seed: [f64; 2], next: &mut VecDeque<usize>) {
        if self.direction(seed).is_none() || self.taken.near(seed, self.separation) {
            return;
        }
        let mut line = self.trace(seed, -1.0, &[]);
        line.reverse();
        let downstream = self.trace(seed, 1.0, &line);
        line.push(seed);
        line.extend(downstream);
        if (line.len() - 1) as f64 * STEP * self.section.spacing > SHORTEST * self.separation {
            line.iter().for_each(|&point| self.taken.add(point));
            next.push_back(self.lines.len());
            self.lines.push(line);
        }
    }

    /// Points after `seed`, upstream if `sign` is −1, until an end of the fluid or a line is near;
    /// `upstream` is the other half of the same line.
    fn trace(&self, seed: [f64; 2], sign: f64, upstream: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let step = sign * STEP * self.section.spacing;
        let own = NEAREST_SELF * self.separation;
        // Along the line, a point is near to its neighbours without the line closing.
        let skip = (2.0 * own / step.abs()).ceil() as usize + 1;
        let mut whole: Vec<[f64; 2]> = upstream.to_vec();
        whole.push(seed);
        let mut mine = Taken::new(self.section, self.separation);
        let mut known = 0;
        let mut point = seed;
        // A line longer than all cells is one that cannot end.
        for _ in 0..2 * self.section.values.len() {
            let Some(after) = self.runge_kutta(point, step) else {
                break;
            };
            while known + skip < whole.len() {
                mine.add(whole[known]);
                known += 1;
            }
            if self.taken.near(after, NEAREST * self.separation) || mine.near(after, own) {
                break;
            }
            whole.push(after);
            point = after;
        }
        whole.split_off(upstream.len() + 1)
    }

    /// One classical fourth-order step of length `step` (m) along the direction of the flow.
    fn runge_kutta(&self, [x, y]: [f64; 2], step: f64) -> Option<[f64; 2]> {
        let ahead = |[u, v]: [f64; 2], part: f64| [x + part * step * u, y + part * step * v];
        let a = self.direction([x, y])?;
        let b = self.direction(ahead(a, 0.5))?;
        let c = self.direction(ahead(b, 0.5))?;
        let d = self.direction(ahead(c, 1.0))?;
        let mean = [0, 1].map(|axis| (a[axis] + 2.0 * (b[axis] + c[axis]) + d[axis]) / 6.0);
        let after = ahead(mean, 1.0);
        self.direction(after).map(|_| after)
    }

    fn direction(&self, point: [f64; 2]) -> Option<[f64; 2]> {
        let [u, v] = self.section.velocity_at(point)?;
        let speed = u.hypot(v);
        (speed > self.still).then(|| [u / speed, v / speed])
    }
}

/// Points sorted into square bins, to find those near a place.
struct Taken {
    origin: [f64; 2],
    bin: f64,
    bins: [usize; 2],
    points: Vec<Vec<[f64; 2]>>,
}

impl Taken {
    /// For distances up to `bin` (m).
    fn new(section: &Section, bin: f64) -> Self {
        let bins = [0, 1]
            .map(|axis| (section.cells[axis] as f64 * section.spacing / bin).ceil() as usize + 1);
        Self {
            origin: section.origin,
            bin,
            bins,
            points: vec![Vec::new(); bins[0] * bins[1]],
        }
    }

    fn place(&self, point: [f64; 2]) -> [usize; 2] {
        [0, 1].map(|axis| {
            let place = ((point[axis] - self.origin[axis]) / self.bin).max(0.0) as usize;
            place.min(self.bins[axis] - 1)
        })
    }

    fn add(&mut self, point: [f64; 2]) {
        let [u, v] = self.place(point);
        self.points[u + self.bins[0] * v].push(point);
    }

    fn near(&self, point: [f64; 2], distance: f64) -> bool {
        let [u, v] = self.place(point);
        let around = |place: usize, axis: usize| {
            place.saturating_sub(1)..=(place + 1).min(self.bins[axis] - 1)
        };
        around(v, 1).any(|v| {
            around(u, 0).any(|u| {
                self.points[u + self.bins[0] * v]
                    .iter()
                    .any(|other| (other[0] - point[0]).hypot(other[1] - point[1]) < distance)
            })
        })
    }
}
