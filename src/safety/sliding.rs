//! Safety against sliding on one or two planes.

use super::{ROUNDING, TILT, factor};
use glam::DVec3;

/// A plane that supports or restrains a block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Plane {
    /// Unit normal into the block.
    pub normal: DVec3,
    /// Area of the contact A, m².
    pub area: f64,
    /// Cohesion c, Pa.
    pub cohesion: f64,
    /// Friction angle φ, rad.
    pub friction_angle: f64,
}

/// Mode of failure of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// The block has no contacts.
    Free,
    /// Away from all planes.
    Lifting,
    /// Along the plane with this index.
    OnOne(usize),
    /// Along the line of intersection of the planes with these indices.
    OnTwo(usize, usize),
    /// No motion: there is no driving force in an admissible direction.
    Held,
}

/// Safety of a block against sliding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sliding {
    /// Resisting over driving force; infinite if the block is held, 0 if it lifts off, NaN without contacts.
    pub factor: f64,
    /// Mode of failure.
    pub mode: Mode,
    /// Direction of sliding, a unit vector; zero if the block does not slide.
    pub direction: DVec3,
    /// Driving force T, N.
    pub driving: f64,
}

impl Sliding {
    fn none(factor: f64, mode: Mode) -> Self {
        Self {
            factor,
            mode,
            direction: DVec3::ZERO,
            driving: 0.0,
        }
    }
}

/// Safety against sliding under the resultant `force` (N) of weight, loads and fluid, without contact forces: the smallest
/// factor of all admissible directions.
pub fn sliding(force: DVec3, planes: &[Plane]) -> Sliding {
    if planes.is_empty() {
        return Sliding::none(f64::NAN, Mode::Free);
    }
    let size = force.length();
    let pressed = |plane: &Plane| force.dot(plane.normal) <= ROUNDING * size;
    if !planes.iter().any(pressed) {
        return Sliding::none(0.0, Mode::Lifting);
    }
    let ones = (0..planes.len()).filter_map(|i| on_one(force, planes, i));
    let pairs = (0..planes.len()).flat_map(|i| (0..i).map(move |j| (j, i)));
    let twos = pairs.filter_map(|(i, j)| on_two(force, planes, i, j));
    let least = ones
        .chain(twos)
        .min_by(|a, b| a.factor.total_cmp(&b.factor));
    least.unwrap_or(Sliding::none(f64::INFINITY, Mode::Held))
}

/// Whether the direction `along`, a unit vector, points into none of the planes other than `own`.
fn is_open(along: DVec3, planes: &[Plane], own: &[usize]) -> bool {
    let others = planes.iter().enumerate().filter(|(n, _)| !own.contains(n));
    others.fold(true, |open, (_, plane)| {
        open && along.dot(plane.normal) >= -TILT
    })
}

fn on_one(force: DVec3, planes: &[Plane], i: usize) -> Option<Sliding> {
    let plane = &planes[i];
    let normal = -force.dot(plane.normal);
    let rest = force + normal * plane.normal;
    let driving = rest.length();
    if normal < -ROUNDING * force.length() || driving <= ROUNDING * force.length() {
        return None;
    }
    let direction = rest / driving;
    is_open(direction, planes, &[i]).then(|| Sliding {
        factor: factor(strength(plane, normal), driving, force.length()),
        mode: Mode::OnOne(i),
        direction,
        driving,
    })
}

fn on_two(force: DVec3, planes: &[Plane], i: usize, j: usize) -> Option<Sliding> {
    let (a, b) = (&planes[i], &planes[j]);
    let line = a.normal.cross(b.normal);
    let square = line.length_squared();
    let line = line.try_normalize()?;
    let driving = force.dot(line).abs();
    if driving <= ROUNDING * force.length() {
        return None;
    }
    let direction = line * force.dot(line).signum();
    // −R = N_a n_a + N_b n_b across the line.
    let cosine = a.normal.dot(b.normal);
    let [p, q] = [a, b].map(|plane| -force.dot(plane.normal));
    let normals = [(p - cosine * q) / square, (q - cosine * p) / square];
    let pressed = normals.iter().all(|n| *n >= -ROUNDING * force.length());
    (pressed && is_open(direction, planes, &[i, j])).then(|| Sliding {
        factor: factor(
            strength(a, normals[0]) + strength(b, normals[1]),
            driving,
            force.length(),
        ),
        mode: Mode::OnTwo(i, j),
        direction,
        driving,
    })
}

/// c A + N′ tan φ.
fn strength(plane: &Plane, normal: f64) -> f64 {
    plane.cohesion * plane.area + normal.max(0.0) * plane.friction_angle.tan()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plane with this dip, dip direction and friction angle, degrees; x is east and y north.
    fn plane(dip: f64, towards: f64, friction: f64) -> Plane {
        let (sin, cos) = dip.to_radians().sin_cos();
        let (east, north) = towards.to_radians().sin_cos();
        Plane {
            normal: DVec3::new(sin * east, sin * north, cos),
            area: 2.0,
            cohesion: 0.0,
            friction_angle: f64::to_radians(friction),
        }
    }

    #[test]
    fn on_an_incline_it_is_tan_phi_over_tan_beta() {
        for (beta, phi) in [(10f64, 30f64), (29.0, 30.0), (45.0, 20.0)] {
            let found = sliding(-7.0 * DVec3::Z, &[plane(beta, 75.0, phi)]);
            let exact = phi.to_radians().tan() / beta.to_radians().tan();
            assert!((found.factor - exact).abs() < 1e-14);
            assert_eq!(found.mode, Mode::OnOne(0));
            assert!((found.direction.z + beta.to_radians().sin()).abs() < 1e-14);
        }
    }

    #[test]
    fn cohesion_adds_its_share_and_uplift_takes_friction() {
        let mut incline = plane(30.0, 0.0, 30.0);
        incline.cohesion = 3.0;
        // (c A + W cos β tan φ)/(W sin β) with W = 10.
        let found = sliding(-10.0 * DVec3::Z, &[incline]).factor;
        assert!((found - (6.0 + 5.0) / 5.0).abs() < 1e-14);
        let lifted = sliding(-10.0 * DVec3::Z + 4.0 * incline.normal, &[incline]).factor;
        let friction = (10.0 * 0.75f64.sqrt() - 4.0) / 3f64.sqrt();
        assert!((lifted - (6.0 + friction) / 5.0).abs() < 1e-14);
    }

    /// Two wedges; the reference factors are from the vector method of Goodman & Shi.
    #[test]
    fn wedges() {
        let even = [plane(50.0, 120.0, 30.0), plane(50.0, 240.0, 30.0)];
        let found = sliding(-DVec3::Z, &even);
        assert!((found.factor - 1.2949).abs() < 5e-5, "{found:?}");
        assert_eq!(found.mode, Mode::OnTwo(0, 1));
        let uneven = [plane(45.0, 105.0, 20.0), plane(70.0, 235.0, 30.0)];
        let found = sliding(-DVec3::Z, &uneven);
        assert!((found.factor - 1.10662).abs() < 5e-6, "{found:?}");
        let plunge = -found.direction.z.asin().to_degrees();
        assert!((plunge - 31.1965).abs() < 5e-5, "{plunge}");
    }

    #[test]
    fn a_wall_in_the_way_holds_and_flow_along_it_does_not() {
        let floor = plane(0.0, 0.0, 35.0);
        let wall = Plane {
            normal: -DVec3::X,
            ..floor
        };
        let tan = 35f64.to_radians().tan();
        let onto = sliding(DVec3::new(5.0, 0.0, -10.0), &[floor, wall]);
        assert_eq!((onto.mode, onto.factor), (Mode::Held, f64::INFINITY));
        let along = sliding(DVec3::new(5.0, 2.0, -10.0), &[floor, wall]);
        assert_eq!(along.mode, Mode::OnTwo(0, 1));
        assert!((along.factor - 15.0 * tan / 2.0).abs() < 1e-12);
        // Sliding up the wall if the water lifts the block.
        let up = sliding(DVec3::new(5.0, 0.0, 1.0), &[floor, wall]);
        assert_eq!((up.mode, up.direction), (Mode::OnOne(1), DVec3::Z));
        assert!((up.factor - 5.0 * tan).abs() < 1e-12);
        let off = sliding(DVec3::new(-5.0, 0.0, 1.0), &[floor, wall]);
        assert_eq!((off.mode, off.factor), (Mode::Lifting, 0.0));
    }

    /// Contact normals tilt slightly: motion between walls that converge by this angle is admissible.
    #[test]
    fn a_lane_between_two_walls_is_open_up_to_the_tilt_of_contacts() {
        let floor = plane(0.0, 0.0, 35.0);
        let between = |tilt: f64| {
            let wall = |side: f64| Plane {
                normal: DVec3::new(-tilt, side, 0.0).normalize(),
                ..floor
            };
            let planes = [floor, wall(1.0), wall(-1.0)];
            sliding(DVec3::new(2.0, 0.0, -10.0), &planes).factor
        };
        let tan = 35f64.to_radians().tan();
        assert!((between(1e-5) - 5.0 * tan).abs() < 1e-3);
        assert_eq!(between(0.01), f64::INFINITY);
    }

    #[test]
    fn at_rest_on_the_level_nothing_drives() {
        let found = sliding(-DVec3::Z, &[plane(0.0, 0.0, 30.0)]);
        assert_eq!((found.mode, found.factor), (Mode::Held, f64::INFINITY));
        assert!(sliding(-DVec3::Z, &[]).factor.is_nan());
    }
}
