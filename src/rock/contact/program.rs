//! The linear program of Boon, Houlsby & Utili 2012, eq. 12: min s, a_k · x − s ≤ b_k, by clarabel.
//!
//! Its solution is no proof; it provides a point and a plane to be tested.

use super::pair::Row;
use crate::{Error, Result};
use clarabel::{
    algebra::CscMatrix,
    solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT},
};
use glam::DVec3;

/// Solvers by number of rows, each built once and updated for every problem.
#[derive(Default)]
pub(super) struct Program {
    solvers: Vec<Option<Box<DefaultSolver<f64>>>>,
    matrix: Vec<f64>,
    bounds: Vec<f64>,
}

/// Solution of the program.
pub(super) struct Optimum<'a> {
    /// The point with the largest smallest slack, in L.
    pub point: DVec3,
    /// Multipliers of the rows.
    pub dual: &'a [f64],
}

/// Unit of length of the second solution, in L. clarabel is accurate to 1e-10 L, and the largest sphere in an
/// overlap of 1e-9 L may be no larger than that.
const MAGNIFIED: f64 = 1e-6;

/// Extent of the second program, in its own unit.
const HORIZON: f64 = 10.0;

impl Program {
    /// # Errors
    /// If clarabel refuses the problem.
    pub fn solve(&mut self, rows: &[Row]) -> Result<Optimum<'_>> {
        self.look(rows, DVec3::ZERO, 1.0, f64::INFINITY)
    }

    /// Solves the program again, magnified about `point`, for a pair that the first solution leaves
    /// undecided. Rows beyond the horizon are moved onto it, which can only shrink the overlap.
    ///
    /// # Errors
    /// If clarabel refuses the problem.
    pub fn magnify(&mut self, rows: &[Row], point: DVec3) -> Result<Optimum<'_>> {
        self.look(rows, point, MAGNIFIED, HORIZON)
    }

    fn look(&mut self, rows: &[Row], from: DVec3, unit: f64, horizon: f64) -> Result<Optimum<'_>> {
        let count = rows.len();
        self.matrix.clear();
        self.matrix.extend(rows.iter().map(|row| row.normal.x));
        self.matrix.extend(rows.iter().map(|row| row.normal.y));
        self.matrix.extend(rows.iter().map(|row| row.normal.z));
        self.matrix.resize(4 * count, -1.0);
        self.bounds.clear();
        let slacks = rows.iter().map(|row| row.offset - row.normal.dot(from));
        self.bounds
            .extend(slacks.map(|slack| (slack / unit).min(horizon)));
        if self.solvers.len() <= count {
            self.solvers.resize_with(count + 1, || None);
        }
        let solver = match &mut self.solvers[count] {
            Some(solver) => solver,
            empty => empty.insert(Box::new(solver(count).map_err(refused)?)),
        };
        solver.update_A(&self.matrix).map_err(refused)?;
        solver.update_b(&self.bounds).map_err(refused)?;
        solver.solve();
        let x = &solver.solution.x;
        Ok(Optimum {
            point: from + DVec3::new(x[0], x[1], x[2]) * unit,
            dual: &solver.solution.z,
        })
    }
}

impl Optimum<'_> {
    /// Normal of a plane between the blocks if they are apart, from the block of the first `split`
    /// rows to the other: Σ z_k a_k.
    pub fn normal(&self, rows: &[Row], split: usize) -> DVec3 {
        let own = rows[..split].iter().zip(self.dual);
        own.map(|(row, z)| row.normal * *z).sum()
    }
}

/// A solver for `count` rows with placeholder values: every problem is loaded by the same update,
/// so that its solution does not depend on earlier problems.
fn solver(count: usize) -> Result<DefaultSolver<f64>, clarabel::solver::SolverError> {
    let settings = DefaultSettings {
        verbose: false,
        tol_gap_abs: 1e-12,
        tol_gap_rel: 1e-12,
        tol_feas: 1e-12,
        // Both would prevent updates.
        presolve_enable: false,
        input_sparse_dropzeros: false,
        // The rows already have unit normals. Scales of the first problem would be kept for all
        // later ones and make them depend on it.
        equilibrate_enable: false,
        direct_solve_method: "qdldl".into(),
        ..DefaultSettings::default()
    };
    let starts = (0..=4).map(|column| column * count).collect();
    let indices = (0..4 * count).map(|entry| entry % count).collect();
    let matrix = CscMatrix::new(count, 4, starts, indices, vec![1.0; 4 * count]);
    DefaultSolver::new(
        &CscMatrix::zeros((4, 4)),
        &[0.0, 0.0, 0.0, 1.0],
        &matrix,
        &vec![1.0; count],
        &[NonnegativeConeT(count)],
        settings,
    )
}

fn refused(error: impl std::fmt::Display) -> Error {
    Error::argument("contact", format!("the linear program is refused: {error}"))
}
