// How closely blocks that meet, or a block and a wall, fill a cell between them.

// What blocks that touch may leave of a cell between them.
const ROUGH = 2e-3;
// From then on it is a gap as any other. In a narrower one what the cell holds would be a spring between the two that is
// a step late: a block that lifts off its bed by this would shake itself.
const OPENS = 0.1;
