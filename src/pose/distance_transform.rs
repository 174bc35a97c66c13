//! The exact Euclidean distance from every pixel to the nearest pixel of a kind.
//!
//! P. Felzenszwalb, D. Huttenlocher: "Distance transforms of sampled functions", Theory of Computing 8, 2012.

use crate::view::Size;

/// Squared distance if there is no pixel of the kind, larger than any other.
const NOWHERE: f64 = 1e12;

/// Squared distance from each pixel to the nearest pixel of a kind.
pub(crate) fn squared_distances(size: Size, is_of_kind: impl Fn(usize) -> bool) -> Vec<f64> {
    let mut values: Vec<f64> = (0..size.len()).map(|index| if is_of_kind(index) { 0.0 } else { NOWHERE }).collect();
    let longest = size.width.max(size.height);
    let (mut line, mut result) = (Vec::with_capacity(longest), vec![0.0; longest]);
    let (mut places, mut ends) = (vec![0; longest], vec![0.0; longest + 1]);
    let lines = (0..size.width).map(|column| (column, size.width, size.height));
    let rows = (0..size.height).map(|row| (row * size.width, 1, size.width));
    for (start, stride, length) in lines.chain(rows) {
        line.clear();
        line.extend((0..length).map(|k| values[start + k * stride]));
        lower_envelope(&line, &mut result, &mut places, &mut ends);
        (0..length).for_each(|k| values[start + k * stride] = result[k]);
    }
    values
}

/// Minimum over q of (p - q)^2 + f(q) for each p of a line.
fn lower_envelope(line: &[f64], result: &mut [f64], places: &mut [usize], ends: &mut [f64]) {
    let mut last = 0;
    (places[0], ends[0], ends[1]) = (0, f64::NEG_INFINITY, f64::INFINITY);
    for q in 1..line.len() {
        let meets = |p: usize| {
            let [here, there] = [q, p].map(|at| line[at] + (at * at) as f64);
            (here - there) / (2 * (q - p)) as f64
        };
        let mut at = meets(places[last]);
        while at <= ends[last] && last > 0 {
            last -= 1;
            at = meets(places[last]);
        }
        last += 1;
        (places[last], ends[last], ends[last + 1]) = (q, at, f64::INFINITY);
    }
    let mut parabola = 0;
    for p in 0..line.len() {
        while ends[parabola + 1] < p as f64 {
            parabola += 1;
        }
        result[p] = (p as f64 - places[parabola] as f64).powi(2) + line[places[parabola]];
    }
}
