//! Independent measures of polyhedra.

use glam::{DMat3, DVec3};
use kit::assert_near;
use riprap::geometry::Polyhedron;

/// Largest difference of two matrices' entries.
pub fn difference(a: DMat3, b: DMat3) -> f64 {
    let d = (a - b).to_cols_array();
    d.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// Newell's area vector of a ring, m².
pub fn area(points: &[DVec3]) -> DVec3 {
    let pairs = points.iter().zip(points.iter().cycle().skip(1));
    pairs.map(|(a, b)| a.cross(*b)).sum::<DVec3>() / 2.0
}

/// Asserts all invariants of a polyhedron. Coordinates have an error of some ε of the radius; an on-plane decision adds 1e-12
/// of the start box, which is up to four times as large.
pub fn assert_sound(p: &Polyhedron) {
    assert_sound_to(p, 1e-11 * p.radius());
}

/// The same for a block whose coordinates have an error of up to `close` (m).
pub fn assert_sound_to(p: &Polyhedron, close: f64) {
    let (v, e, f) = (p.vertices().len(), p.edges().len(), p.faces().len());
    assert_eq!(v + f, e + 2, "Euler: {v} vertices, {e} edges, {f} faces");
    assert_eq!(p.loops().len(), f);
    let mut total = 0.0;
    let mut closing = DVec3::ZERO;
    let mut uses = std::collections::BTreeMap::new();
    for (face, ring) in p.faces().iter().zip(p.loops()) {
        assert_near(face.normal.length(), 1.0, 1e-15);
        assert!(ring.len() >= 3);
        let points: Vec<DVec3> = ring.iter().map(|i| p.vertices()[*i as usize]).collect();
        for (i, vertex) in p.vertices().iter().enumerate() {
            let height = face.normal.dot(*vertex) - face.distance;
            assert!(height < close, "vertex {i} is {height:e} m outside");
            if ring.contains(&(i as u32)) {
                assert!(height > -close, "vertex {i} is {height:e} m off its face");
            }
        }
        let area = area(&points);
        // Counter-clockwise seen from outside. The smaller the face, the less accurate its direction.
        let tilt = area.cross(face.normal).length();
        assert!(area.dot(face.normal) > 0.0 && tilt < close * p.radius());
        closing += area;
        total += area.dot(face.normal) * face.distance / 3.0;
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            *uses.entry((a.min(b), a.max(b))).or_insert(0) += 1;
        }
    }
    let listed: std::collections::BTreeSet<_> = p
        .edges()
        .iter()
        .map(|[a, b]| (a.min(b), a.max(b)))
        .collect();
    assert_eq!(listed.len(), e, "edges are listed once");
    assert!(uses.values().all(|n| *n == 2) && uses.keys().eq(&listed));
    assert!(
        closing.length() < close * p.radius(),
        "the surface is closed"
    );
    // The divergence theorem over faces: V = Σ d A / 3.
    // The surface is at most that of a sphere of the radius.
    let error = (total - p.volume()).abs();
    assert!(
        error < 4.0 * std::f64::consts::PI * p.radius().powi(2) * close,
        "volume {} against {total}",
        p.volume()
    );
}
