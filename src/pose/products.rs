//! Sums over many rows of the products of their numbers, for normal equations.

/// Number of rows whose products are summed in single precision before they are added to the sums.
const BATCH: u32 = 64;

/// Sums of the weighted products of N numbers.
pub struct Products<const N: usize> {
    batch: [[f32; N]; N],
    entered: u32,
    /// The sums, complete after [`flush`](Self::flush).
    pub sums: [[f64; N]; N],
}

impl<const N: usize> Products<N> {
    pub const ZERO: Self = Self { batch: [[0.0; N]; N], entered: 0, sums: [[0.0; N]; N] };

    /// Adds the products of a row. Those of the first `from` numbers with all others are left out.
    #[inline(always)]
    pub fn add(&mut self, numbers: &[f32; N], weight: f32, from: usize) {
        for row in from..N {
            let share = weight * numbers[row];
            self.batch[row].iter_mut().zip(numbers).for_each(|(sum, number)| *sum += share * number);
        }
        self.entered += 1;
        if self.entered == BATCH {
            self.flush();
        }
    }

    /// Adds the batch to the sums.
    pub fn flush(&mut self) {
        for (sums, batch) in self.sums.iter_mut().zip(&self.batch) {
            sums.iter_mut().zip(batch).for_each(|(sum, share)| *sum += f64::from(*share));
        }
        // Not one by one in the loop above: V8 of Node 20 then leaves one row of the optimised module as it is.
        self.batch = [[0.0; N]; N];
        self.entered = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_of_all_products() {
        let mut products = Products::<3>::ZERO;
        let row = |k: u32| [1.0, k as f32, (k % 7) as f32 - 3.0];
        for k in 0..200 {
            products.add(&row(k), 0.5, 1);
        }
        products.flush();
        let sum = |a: usize, b: usize| (0..200).map(|k| 0.5 * f64::from(row(k)[a] * row(k)[b])).sum::<f64>();
        for a in 1..3 {
            for b in 0..3 {
                assert!((products.sums[a][b] - sum(a, b)).abs() <= 1e-5 * sum(a, a).max(sum(b, b)), "{a} {b}");
            }
        }
        assert_eq!(products.sums[0], [0.0; 3]);
    }
}
