//! Whether the shear at walls and blocks was resolved.

use super::{scene_run::SceneRun, summary::Summary};
use riprap::simulation::{FirstCell, SUBLAYER};

impl SceneRun {
    /// Adds the largest y⁺ to the summary, and a warning if it is beyond the viscous sublayer; nothing for a flow that has
    /// diverged.
    pub(super) fn report_wall_units(&mut self, summary: &mut Summary) {
        if summary.diverged {
            return;
        }
        let found = match self.wall_units() {
            Ok(found) => found,
            Err(error) => {
                return summary.warnings.push(format!("y⁺ is not known: {error}"));
            }
        };
        summary.y_plus_walls = found.walls.map(|cell| cell.y_plus);
        summary.y_plus_blocks = found.blocks.map(|cell| cell.y_plus);
        let high = |cell: &FirstCell| cell.y_plus > SUBLAYER;
        for cell in [found.walls, found.blocks]
            .into_iter()
            .flatten()
            .filter(high)
        {
            let beside = match (cell.block, self.simulation.coupled()) {
                (Some(block), Some(coupled)) => format!("block {}", coupled.blocks().name(block)),
                _ => "a wall".into(),
            };
            summary.warnings.push(self.warning(&cell, &beside));
        }
    }

    /// The warning about a large y⁺ and its effect on the results.
    fn warning(&self, cell: &FirstCell, beside: &str) -> String {
        let [x, y, z] = cell.position;
        // Assumes the same friction.
        let finer = self.scene().domain.cell * SUBLAYER / cell.y_plus;
        format!(
            "y⁺ is at least {:.1} beside {beside} at ({x:.4}, {y:.4}, {z:.4}) m, above {SUBLAYER}: no-slip \
             shear is not resolved there and no wall model acts, so that friction comes out too small, \
             or too large at faces at an angle to the grid; pressure and the drag of edged bodies suffer less. Cells of {finer:.2e} m would resolve it",
            cell.y_plus
        )
    }
}
