//! Whether a triangle touches a cube (separating axes, Akenine-Möller 2001).

use glam::DVec3;

/// Whether the triangle `corners` touches the cube of half the edge `half` around `centre`.
pub(super) fn touches(corners: [DVec3; 3], centre: DVec3, half: f64) -> bool {
    let v = corners.map(|c| c - centre);
    let edges = [v[1] - v[0], v[2] - v[1], v[0] - v[2]];
    let apart = |axis: DVec3| {
        let reach = half * axis.abs().element_sum();
        let along = v.map(|c| c.dot(axis));
        let least = along[0].min(along[1]).min(along[2]);
        let most = along[0].max(along[1]).max(along[2]);
        least > reach || most < -reach
    };
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    !(axes.into_iter().any(apart)
        || apart(edges[0].cross(edges[1]))
        || edges
            .iter()
            .any(|e| axes.iter().any(|a| apart(a.cross(*e)))))
}
