//! What is known of the water around some blocks, passed on to those that have none around them.

use glam::DVec3;

/// A linear field of pressure.
pub(super) trait Field: Copy {
    /// The same, moved by `way` (m).
    fn moved(self, way: DVec3) -> Self;

    /// The mean of some, at least one.
    fn mean(fields: &[Self]) -> Self;
}

/// The fields of blocks without one, of those that `may` have one: inside a jointed mass all sides of a block are joints,
/// and the water in these is that of the blocks around it. Each gets the mean of those of the blocks beside it, and so
/// on from block to block. `beside`: a block, another one that touches it, and by how much that is moved to do so, m.
pub(super) fn passed_on<T: Field>(
    known: &[Option<T>],
    may: impl Fn(usize) -> bool,
    beside: &[(usize, usize, DVec3)],
) -> Vec<Option<T>> {
    let mut fields = known.to_vec();
    loop {
        let mut around = vec![Vec::new(); fields.len()];
        for &(block, other, way) in beside {
            if fields[block].is_none() && may(block) {
                around[block].extend(fields[other].map(|field| field.moved(way)));
            }
        }
        let mut any = false;
        for (field, around) in fields.iter_mut().zip(&around) {
            if !around.is_empty() {
                *field = Some(T::mean(around));
                any = true;
            }
        }
        if !any {
            return fields;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Field for f64 {
        fn moved(self, way: DVec3) -> Self {
            self + way.x
        }

        fn mean(fields: &[Self]) -> Self {
            fields.iter().sum::<f64>() / fields.len() as f64
        }
    }

    #[test]
    fn from_both_ends_of_a_row_to_its_middle_but_not_through_what_may_not() {
        let known = [Some(1.0), None, None, None, Some(5.0), None, None];
        let row = |n: usize| (n, n + 1, DVec3::ZERO);
        let mut beside: Vec<_> = (0..6).map(row).collect();
        beside.extend((0..6).map(|n| (n + 1, n, 0.5 * DVec3::X)));
        let found = passed_on(&known, |n| n != 5, &beside);
        let middle = 0.5 * (1.5 + 0.5 + 5.0);
        assert_eq!(
            found,
            [
                Some(1.0),
                Some(1.5),
                Some(middle),
                Some(5.0),
                Some(5.0),
                None,
                None
            ]
        );
    }
}
