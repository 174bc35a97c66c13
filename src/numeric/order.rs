//! Quantiles, sorting by a key, and thinning of long lists.

/// The value below which the `share` of `values` lies. Reorders `values`, which must hold no NaN.
pub(crate) fn quantile(values: &mut [f32], share: f64) -> f32 {
    let rank = ((values.len() - 1) as f64 * share).round() as usize;
    *values.select_nth_unstable_by(rank, f32::total_cmp).1
}

/// Indices of the values from the largest to the smallest. Equal values keep their order.
///
/// The check sorts only through this function, because each instance of the standard library's sort adds 3 kB to its .wasm file.
#[inline(never)]
pub(crate) fn descending(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
    order
}

/// Sorts by a key from its largest to its smallest value. Elements of equal keys keep their order.
pub(crate) fn sort_descending<T>(elements: &mut [T], key: impl Fn(&T) -> f64) {
    let keys: Vec<f64> = elements.iter().map(key).collect();
    let order = descending(&keys);
    for (place, &from) in order.iter().enumerate() {
        let mut from = from;
        // The element of an earlier place was swapped to where the element of that place came from.
        while from < place {
            from = order[from];
        }
        elements.swap(place, from);
    }
}

/// At most `most` of the indices, evenly spread.
pub(crate) fn evenly_spread<I: Iterator<Item = usize>>(
    most: usize,
    indices: impl Fn() -> I,
) -> impl Iterator<Item = usize> {
    indices().step_by(indices().count().div_ceil(most).max(1))
}

/// Keeps at most `most` of the elements, evenly spread.
pub(crate) fn thin<T: Copy>(elements: &mut Vec<T>, most: usize) {
    let count = elements.len();
    if count > most {
        (0..most).for_each(|k| elements[k] = elements[k * count / most]);
        elements.truncate(most);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn a_quantile_is_a_member_of_that_rank() {
        let values = [5.0, -1.0, 3.0, 2.0, 4.0];
        for (share, expected) in [(0.0, -1.0), (0.25, 2.0), (0.5, 3.0), (1.0, 5.0)] {
            assert_eq!(quantile(&mut values.clone(), share), expected);
        }
        assert_eq!(quantile(&mut [7.0], 0.9), 7.0);
    }

    #[test]
    fn the_largest_key_comes_first_and_equal_keys_keep_their_order() {
        let mut random = crate::numeric::random::Random::new(5, 0);
        for count in 0..40 {
            let mut sorted: Vec<(f64, usize)> = (0..count).map(|k| ((6.0 * random.uniform()).floor(), k)).collect();
            let mut expected = sorted.clone();
            expected.sort_by(|a, b| b.0.total_cmp(&a.0));
            sort_descending(&mut sorted, |element| element.0);
            assert_eq!(sorted, expected);
        }
    }

    #[test]
    fn what_is_thinned_is_spread_and_no_more_than_asked_for() {
        for most in [1, 3, 7, 10, 100] {
            let mut kept: Vec<usize> = (0..10).collect();
            thin(&mut kept, most);
            assert_eq!(kept.len(), most.min(10));
            let spread: Vec<usize> = evenly_spread(most, || 0..10).collect();
            assert!(spread.len() <= most && spread[0] == 0 && kept[0] == 0, "{spread:?}");
            assert!(
                kept.is_sorted() && spread.windows(2).all(|pair| pair[1] - pair[0] == 10_usize.div_ceil(most).max(1))
            );
        }
        let mut kept: Vec<usize> = (0..10).collect();
        thin(&mut kept, 5);
        assert_eq!(kept, [0, 2, 4, 6, 8]);
        assert_eq!(evenly_spread(5, || 0..0).count(), 0);
    }
}
