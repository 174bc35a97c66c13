//! Quantiles, and thinning of long lists.

/// The value below which the `share` of `values` lies. Reorders `values`, which must hold no NaN.
pub(crate) fn quantile(values: &mut [f32], share: f64) -> f32 {
    let rank = ((values.len() - 1) as f64 * share).round() as usize;
    *values.select_nth_unstable_by(rank, f32::total_cmp).1
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
