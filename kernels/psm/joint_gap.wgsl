// Gap that blocks in contact, or a block and a wall, leave in a cell between them.

// Fraction of a cell that blocks in contact may leave empty between them.
const CLOSED_GAP = 2e-3;
// From this gap on the joint is open. In a narrower joint, the fluid of the cell would act as a spring between both bodies that
// lags by a step: a block that lifts off its bed by this gap would oscillate.
const OPEN_GAP = 0.1;
// Gap between a full cell and the face of another block up to which the joint is closed.
const TOUCHING_GAP = 1e-3;
