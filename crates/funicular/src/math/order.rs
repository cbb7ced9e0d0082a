//! Orders by numbers, all by one sorting routine: every closure in a call of `sort_by` makes the compiler translate a
//! routine of its own.
//!
//! Numbers are compared in the total order of [`f64::total_cmp`]: −0 before 0, NaN at the ends by its sign.

/// Indices of `keys` in ascending order. Equal keys keep their order.
pub(crate) fn ascending(keys: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..keys.len()).collect();
    // No two indices are equal, so the order is that of a stable sort.
    order.sort_unstable_by(|&i, &j| keys[i].total_cmp(&keys[j]).then(i.cmp(&j)));
    order
}

/// Sorts `items` by a key, ascending. Items with equal keys keep their order, so that a second key is sorted by first.
/// An index as key is exact as a number below 2⁵³.
pub(crate) fn sort_ascending<T>(items: &mut [T], key: impl FnMut(&T) -> f64) {
    let keys: Vec<f64> = items.iter().map(key).collect();
    let mut order = ascending(&keys);
    for start in 0..items.len() {
        // Each cycle of the permutation is done at its first place; the item from there travels to the last.
        let mut place = start;
        loop {
            let from = std::mem::replace(&mut order[place], place);
            if from == start {
                break;
            }
            items.swap(place, from);
            place = from;
        }
    }
}

/// Sorts `items` by a key, descending. Items with equal keys keep their order.
pub(crate) fn sort_descending<T>(items: &mut [T], mut key: impl FnMut(&T) -> f64) {
    // The sign reverses the total order, NaN and zeros included.
    sort_ascending(items, |item| -key(item));
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Number that often equals another one, or one of those that compare in their own way.
    fn number() -> impl Strategy<Value = f64> {
        prop_oneof![
            (-3..3_i32).prop_map(f64::from),
            proptest::sample::select(vec![0.0, -0.0, f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 5e-324]),
            any::<f64>(),
        ]
    }

    proptest! {
        /// The stable sort of the standard library is the oracle, with places that show the order of equal keys.
        #[test]
        fn orders_are_those_of_a_stable_sort(keys in proptest::collection::vec(number(), 0..80)) {
            let items: Vec<(f64, usize)> = keys.iter().copied().zip(0..).collect();
            let places = |items: &[(f64, usize)]| items.iter().map(|item| item.1).collect::<Vec<_>>();

            let (mut up, mut expected) = (items.clone(), items.clone());
            sort_ascending(&mut up, |item| item.0);
            expected.sort_by(|a, b| a.0.total_cmp(&b.0));
            prop_assert_eq!(places(&up), places(&expected));
            prop_assert_eq!(ascending(&keys), places(&expected));
            prop_assert!(up.iter().zip(&expected).all(|(a, b)| a.0.to_bits() == b.0.to_bits()));

            let (mut down, mut expected) = (items.clone(), items);
            sort_descending(&mut down, |item| item.0);
            expected.sort_by(|a, b| b.0.total_cmp(&a.0));
            prop_assert_eq!(places(&down), places(&expected));
        }

        /// Two passes, the second key first, sort by two keys.
        #[test]
        fn two_passes_sort_by_two_keys(keys in proptest::collection::vec((number(), number()), 0..80)) {
            let items: Vec<(f64, f64, usize)> = keys.iter().zip(0..).map(|(key, i)| (key.0, key.1, i)).collect();
            let (mut passes, mut expected) = (items.clone(), items);
            sort_ascending(&mut passes, |item| item.1);
            sort_ascending(&mut passes, |item| item.0);
            expected.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
            prop_assert!(passes.iter().zip(&expected).all(|(a, b)| a.2 == b.2));
        }
    }
}
