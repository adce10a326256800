// Sums of an invocation for a segment or a block.
// needs tables

// Force (3), moment about the block's centroid (3 x 3, f_i r_j at 3 + 3 i + j), B, e - B, first moments of B (3) and
// of e - B (3).
var<private> wrench: array<f32, WRENCH>;
