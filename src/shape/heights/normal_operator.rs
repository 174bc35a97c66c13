//! The Gauss-Newton operator of the heights, (D^T H D + a + kappa S + E + damping L), applied to a direction.
//!
//! D takes the slopes in the middle of each cell of four pixels, H is the stiffness there; S are squared second
//! differences, E the suggested edges, L the Laplacian, a the anchors. All weights are rasters that hold zero wherever
//! a neighbour is missing, the ends of the rows included, so that the raster is one line with neighbours 1 and `width`
//! apart: every loop runs straight through and fills vector registers.

use super::cell_terms::Linear;
use super::solver::{clear, fit};
use crate::numeric::{Lanes, Real};
use crate::shape::integration::Edges;

/// Weights of one system and the scratch of its products.
#[derive(Default)]
pub(super) struct NormalOperator {
    width: usize,
    /// Over (p, q) of the cell right of and below each pixel: pp, pq, qq; zero where there is no cell.
    pub stiffness: [Vec<f32>; 3],
    /// kappa of the second differences along rows and columns.
    pub bend: [Vec<f32>; 2],
    /// Weights between a pixel and its right and its lower neighbour: edges and damping together.
    link: [Vec<f32>; 2],
    /// Forces, with a margin of zeros of a row and a pixel at both ends: half of p's and q's on a cell, their sum and
    /// their difference; those of the links; those of the bends.
    sum: Vec<f32>,
    difference: Vec<f32>,
    pull: [Vec<f32>; 2],
    moment: [Vec<f32>; 2],
}

/// Length of a raster with a margin of a row and a pixel at both ends.
pub(super) const fn padded(length: usize, width: usize) -> usize {
    length + 2 * (width + 1)
}

impl NormalOperator {
    /// Makes it one of `length` pixels in rows of `width` that do not resist, with no forces; there will be `room` for
    /// more.
    pub fn fit(&mut self, width: usize, length: usize, room: usize) {
        self.width = width;
        let [pp, pq, qq] = &mut self.stiffness;
        let [bend_right, bend_below] = &mut self.bend;
        for raster in [pp, pq, qq, bend_right, bend_below] {
            clear(raster, length, room);
        }
        for raster in &mut self.link {
            fit(raster, length, room);
        }
        let ([pull_right, pull_below], [moment_right, moment_below]) = (&mut self.pull, &mut self.moment);
        for raster in [&mut self.sum, &mut self.difference, pull_right, pull_below, moment_right, moment_below] {
            clear(raster, padded(length, width), room);
        }
    }

    /// Takes over the edges' weights, and a damping between all neighbours inside: a pixel of which `near` has the first of
    /// the `flags` has one to the right, with the second one below.
    pub fn set_links(&mut self, edges: &[Edges; 2], near: &[u8], flags: [u8; 2], damping: f32) {
        for ((link, edges), flag) in self.link.iter_mut().zip(edges).zip(flags) {
            for ((link, weight), near) in link.iter_mut().zip(&edges.weight).zip(near) {
                *link = weight + if near & flag != 0 { damping } else { 0.0 };
            }
        }
    }

    /// image = operator times `direction`, which is zero off the mask.
    pub fn apply(&mut self, anchor_weight: &[f32], direction: &[f32], image: &mut [f32]) {
        self.strain_cells(direction);
        for axis in 0..2 {
            self.strain_lines(axis, direction);
        }
        self.gather(anchor_weight, direction, image);
    }

    /// Takes over what the cells right of and below some pixels say, their forces for [`resist`](Self::resist).
    pub fn set_cells(&mut self, index: usize, shading: &Linear) {
        for (raster, value) in self.stiffness.iter_mut().zip(shading.matrix) {
            value.store(&mut raster[index..]);
        }
        let (half, [by_p, by_q], place) = (Lanes::splat(0.5), shading.gradient, self.width + 1 + index);
        (half * (by_p + by_q)).store(&mut self.sum[place..]);
        (half * (by_p - by_q)).store(&mut self.difference[place..]);
    }

    /// right = what all terms do to the heights `z`, those of the cells from [`set_cells`](Self::set_cells), the anchors
    /// from `off`, which is z less the anchor.
    pub fn resist(&mut self, edges: &[Edges; 2], z: &[f32], anchor_weight: &[f32], off: &[f32], right: &mut [f32]) {
        for (axis, edges) in edges.iter().enumerate() {
            self.link[axis].copy_from_slice(&edges.weight);
            self.strain_lines(axis, z);
            let pull = &mut self.pull[axis][self.width + 1..];
            for ((pull, weight), gradient) in pull.iter_mut().zip(&edges.weight).zip(&edges.gradient) {
                *pull -= weight * gradient;
            }
        }
        self.gather(anchor_weight, off, right);
        right.iter_mut().for_each(|force| *force = -*force);
    }

    fn strain_cells(&mut self, d: &[f32]) {
        let (width, margin) = (self.width, self.width + 1);
        let Some(length) = d.len().checked_sub(margin) else { return };
        let (a, b, c, e) = (&d[..length], &d[1..][..length], &d[width..][..length], &d[margin..][..length]);
        let [pp, pq, qq] = self.stiffness.each_ref().map(|entry| &entry[..length]);
        let sum = &mut self.sum[margin..][..length];
        let difference = &mut self.difference[margin..][..length];
        for i in 0..length {
            let (fall, rise) = (0.5 * (e[i] - a[i]), 0.5 * (b[i] - c[i]));
            let (p, q) = (fall + rise, fall - rise);
            let (by_p, by_q) = (pp[i] * p + pq[i] * q, pq[i] * p + qq[i] * q);
            sum[i] = 0.5 * (by_p + by_q);
            difference[i] = 0.5 * (by_p - by_q);
        }
    }

    fn strain_lines(&mut self, axis: usize, d: &[f32]) {
        let stride = [1, self.width][axis];
        let margin = self.width + 1;
        let Some(length) = d.len().checked_sub(stride) else { return };
        let (here, next) = (&d[..length], &d[stride..][..length]);
        let link = &self.link[axis][..length];
        let pull = &mut self.pull[axis][margin..][..length];
        for i in 0..length {
            pull[i] = link[i] * (next[i] - here[i]);
        }
        let Some(length) = length.checked_sub(stride) else { return };
        let (before, here, next) = (&d[..length], &d[stride..][..length], &d[2 * stride..][..length]);
        let bend = &self.bend[axis][stride..][..length];
        let moment = &mut self.moment[axis][margin + stride..][..length];
        for i in 0..length {
            moment[i] = bend[i] * (next[i] - 2.0 * here[i] + before[i]);
        }
    }

    /// Adds up what all forces do to each height.
    fn gather(&self, anchor_weight: &[f32], direction: &[f32], image: &mut [f32]) {
        let (width, margin, length) = (self.width, self.width + 1, image.len());
        let (sum, sum_before) = (&self.sum[margin..][..length], &self.sum[..length]);
        let (from_left, from_above) =
            (&self.difference[margin - 1..][..length], &self.difference[margin - width..][..length]);
        let (anchor, direction) = (&anchor_weight[..length], &direction[..length]);
        for i in 0..length {
            image[i] = anchor[i] * direction[i] - sum[i] + sum_before[i] + from_left[i] - from_above[i];
        }
        for (axis, stride) in [(0, 1), (1, width)] {
            let (pull, behind) = (&self.pull[axis][margin..][..length], &self.pull[axis][margin - stride..][..length]);
            let moment = |shift: usize| &self.moment[axis][shift..][..length];
            let (before, here, next) = (moment(margin - stride), moment(margin), moment(margin + stride));
            for i in 0..length {
                image[i] += behind[i] - pull[i] + before[i] - 2.0 * here[i] + next[i];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An odd raster with a ragged mask; weights from a sine, so that none is like another.
    fn system(width: usize, height: usize) -> (NormalOperator, Vec<bool>, Vec<f32>, f64, [Edges; 2]) {
        let length = width * height;
        let weight = |seed: usize, index: usize| 1.1 + (1.7 * index as f32 + seed as f32).sin();
        let inside: Vec<bool> = (0..length).map(|index| index % 7 != 3).collect();
        let is_inside = |column: usize, row: usize| column < width && row < height && inside[row * width + column];
        let mut operator = NormalOperator::default();
        operator.fit(width, length, 0);
        let mut edges = [Edges::new(length), Edges::new(length)];
        for index in 0..length {
            let (column, row) = (index % width, index / width);
            let [right, low, corner] = [(1, 0), (0, 1), (1, 1)].map(|(x, y)| is_inside(column + x, row + y));
            if inside[index] && right && low && corner {
                let values = [3.0, 0.4 * weight(1, index), 2.0 + weight(2, index)];
                operator.stiffness.iter_mut().zip(values).for_each(|(entry, value)| entry[index] = value);
            }
            for (axis, next) in [right, low].into_iter().enumerate() {
                edges[axis].weight[index] = if inside[index] && next { weight(3 + axis, index) } else { 0.0 };
            }
            for (axis, (x, y)) in [(1, 0), (0, 1)].into_iter().enumerate() {
                let before = column >= x && row >= y && is_inside(column - x, row - y);
                let both = before && inside[index] && is_inside(column + x, row + y);
                operator.bend[axis][index] = if both { weight(5 + axis, index) } else { 0.0 };
            }
        }
        let anchors = (0..length).map(|index| if inside[index] { weight(8, index) } else { 0.0 }).collect();
        let damping = 0.3;
        let joined = |index: usize| {
            let (column, row) = (index % width, index / width);
            let next =
                [is_inside(column + 1, row), is_inside(column, row + 1)].map(|next| u8::from(inside[index] && next));
            next[0] + 2 * next[1]
        };
        operator.set_links(&edges, &(0..length).map(joined).collect::<Vec<u8>>(), [1, 2], damping);
        (operator, inside, anchors, f64::from(damping), edges)
    }

    /// What the operator is the matrix of, term by term.
    fn energy(
        operator: &NormalOperator,
        inside: &[bool],
        anchors: &[f32],
        damping: f64,
        edges: &[Edges; 2],
        z: &[f32],
    ) -> f64 {
        let width = operator.width;
        let at = |index: usize| f64::from(z[index]);
        let mut sum = 0.0;
        for index in 0..z.len() {
            sum += f64::from(anchors[index]) * at(index).powi(2);
            if operator.stiffness[0][index] > 0.0 {
                let [a, b, c, e] = [index, index + 1, index + width, index + width + 1].map(at);
                let (p, q) = (0.5 * (b - a + e - c), 0.5 * (c - a + e - b));
                let [pp, pq, qq] = operator.stiffness.each_ref().map(|entry| f64::from(entry[index]));
                sum += pp * p * p + 2.0 * pq * p * q + qq * q * q;
            }
            for (axis, stride) in [(0, 1), (1, width)] {
                let ends_row = axis == 0 && (index + 1) % width == 0;
                if inside[index] && !ends_row && index + stride < z.len() && inside[index + stride] {
                    let link = f64::from(edges[axis].weight[index]) + damping;
                    sum += link * (at(index + stride) - at(index)).powi(2);
                }
                if operator.bend[axis][index] > 0.0 {
                    let bend = at(index + stride) - 2.0 * at(index) + at(index - stride);
                    sum += f64::from(operator.bend[axis][index]) * bend * bend;
                }
            }
        }
        sum
    }

    #[test]
    fn the_product_is_the_gradient_of_the_energy() {
        for (width, height) in [(9, 8), (5, 1), (1, 6), (2, 2), (16, 3)] {
            let (mut operator, inside, anchors, damping, edges) = system(width, height);
            let direction: Vec<f32> =
                (0..width * height).map(|index| if inside[index] { (0.9 * index as f32).cos() } else { 0.0 }).collect();
            let mut image = vec![f32::NAN; direction.len()];
            operator.apply(&anchors, &direction, &mut image);
            let off_mask = |(force, inside): (&f32, &bool)| *inside || *force == 0.0;
            assert!(image.iter().zip(&inside).all(off_mask), "{width}x{height}");
            let product: f64 = image.iter().zip(&direction).map(|(a, b)| f64::from(a * b)).sum();
            let whole = energy(&operator, &inside, &anchors, damping, &edges, &direction);
            assert!((product - whole).abs() < 1e-4 * whole, "{width}x{height}: {product} {whole}");
            for index in (0..direction.len()).filter(|&index| inside[index]) {
                let by = |step: f32| {
                    let mut moved = direction.clone();
                    moved[index] += step;
                    energy(&operator, &inside, &anchors, damping, &edges, &moved)
                };
                // Half the difference quotient of a quadratic is its gradient, exactly.
                let slope = (by(0.5) - by(-0.5)) / 2.0;
                assert!((slope - f64::from(image[index])).abs() < 1e-3, "{width}x{height} at {index}");
            }
        }
    }
}
