//! The Gauss-Newton matrix of the heights, A = D^T H D + S^T kappa S + E^T w E + diag a + damping L, applied to a
//! direction (docs/method/heights.md).
//!
//! D takes the slopes p, q at the centre of each cell of four pixels; H is the 2x2 matrix of its brightness terms. S
//! takes second differences along rows and columns, E first differences along the edges; a are the anchors' weights, L
//! is the Laplacian. Each product takes two passes: differences of the direction times their weights (fluxes), then the
//! transposed differences of the fluxes. All weight rasters are zero wherever a neighbour is missing, also at the ends
//! of rows, so that the raster is one line with neighbours 1 and `width` apart: every loop runs straight through and
//! fills vector registers.

use super::cell_terms::LinearisedCells;
use super::rasters::{padded, resize, resize_to_zeros};
use crate::numeric::{Lanes, Real};
use crate::shape::integration::Edges;

/// Weights of one matrix and the scratch memory of its products.
#[derive(Default)]
pub(super) struct NormalOperator {
    width: usize,
    /// H of the cell to the right of and below each pixel: pp, pq, qq; zero if there is no cell.
    pub stiffness: [Vec<f32>; 3],
    /// kappa of the second differences along rows and columns.
    pub smoothness: [Vec<f32>; 2],
    /// Weights of the differences to the right and to the lower neighbour: edges and damping together.
    edge_weight: [Vec<f32>; 2],
    /// Weighted differences, with a margin of zeros of one row and one pixel at both ends. For cells, they are half the
    /// sum and half the difference of both components of H (p, q).
    cell_sum: Vec<f32>,
    cell_difference: Vec<f32>,
    /// Weight times first difference, at the edges.
    edge_flux: [Vec<f32>; 2],
    /// Kappa times second difference, for the smoothness.
    second_difference: [Vec<f32>; 2],
}

impl NormalOperator {
    /// Resets to the zero matrix of `length` pixels in rows of `width`, with capacity for `room`.
    pub fn resize(&mut self, width: usize, length: usize, room: usize) {
        self.width = width;
        let [pp, pq, qq] = &mut self.stiffness;
        let [along_rows, along_columns] = &mut self.smoothness;
        for raster in [pp, pq, qq, along_rows, along_columns] {
            resize_to_zeros(raster, length, room);
        }
        for raster in &mut self.edge_weight {
            resize(raster, length, room);
        }
        let ([right, below], [along_rows, along_columns]) = (&mut self.edge_flux, &mut self.second_difference);
        for raster in [&mut self.cell_sum, &mut self.cell_difference, right, below, along_rows, along_columns] {
            resize_to_zeros(raster, padded(length, width), room);
        }
    }

    /// Adopts the edges' weights, and adds a damping between all neighbouring pixels inside. `neighbours` are the two
    /// bits in `flags` that mark a pixel with a neighbour to the right and below.
    pub fn set_edges(&mut self, edges: &[Edges; 2], flags: &[u8], neighbours: [u8; 2], damping: f32) {
        for ((sum, edges), neighbour) in self.edge_weight.iter_mut().zip(edges).zip(neighbours) {
            for ((sum, weight), flags) in sum.iter_mut().zip(&edges.weight).zip(flags) {
                *sum = weight + if flags & neighbour != 0 { damping } else { 0.0 };
            }
        }
    }

    /// product = A direction. Off the mask all weights are zero, so the direction may hold any finite value there, and
    /// the product is zero.
    pub fn apply(&mut self, anchor_weight: &[f32], direction: &[f32], product: &mut [f32]) {
        self.apply_cells(direction);
        for axis in 0..2 {
            self.apply_lines(axis, direction);
        }
        self.gather(anchor_weight, direction, product);
    }

    /// Adopts the brightness terms of four cells, and their gradients for [`downhill`](Self::downhill). The cells are
    /// to the right of and below the pixels that begin at `index`.
    pub fn set_cells(&mut self, index: usize, shading: &LinearisedCells) {
        for (raster, value) in self.stiffness.iter_mut().zip(shading.matrix) {
            value.store(&mut raster[index..]);
        }
        let (half, [by_p, by_q], place) = (Lanes::splat(0.5), shading.gradient, self.width + 1 + index);
        (half * (by_p + by_q)).store(&mut self.cell_sum[place..]);
        (half * (by_p - by_q)).store(&mut self.cell_difference[place..]);
    }

    /// right = minus half the gradient of the objective at the heights `z`: the right-hand side of a Gauss-Newton step.
    /// The cells' share comes from [`set_cells`](Self::set_cells), the anchors' from `off`, which is z minus the
    /// anchor.
    pub fn downhill(&mut self, edges: &[Edges; 2], z: &[f32], anchor_weight: &[f32], off: &[f32], right: &mut [f32]) {
        for (axis, edges) in edges.iter().enumerate() {
            self.edge_weight[axis].copy_from_slice(&edges.weight);
            self.apply_lines(axis, z);
            let flux = &mut self.edge_flux[axis][self.width + 1..];
            for ((flux, weight), gradient) in flux.iter_mut().zip(&edges.weight).zip(&edges.gradient) {
                *flux -= weight * gradient;
            }
        }
        self.gather(anchor_weight, off, right);
        right.iter_mut().for_each(|value| *value = -*value);
    }

    /// H times the slopes in each cell.
    fn apply_cells(&mut self, d: &[f32]) {
        let (width, margin) = (self.width, self.width + 1);
        let Some(length) = d.len().checked_sub(margin) else { return };
        let (a, b, c, e) = (&d[..length], &d[1..][..length], &d[width..][..length], &d[margin..][..length]);
        let [pp, pq, qq] = self.stiffness.each_ref().map(|entry| &entry[..length]);
        let sum = &mut self.cell_sum[margin..][..length];
        let difference = &mut self.cell_difference[margin..][..length];
        for i in 0..length {
            let (fall, rise) = (0.5 * (e[i] - a[i]), 0.5 * (b[i] - c[i]));
            let (p, q) = (fall + rise, fall - rise);
            let (by_p, by_q) = (pp[i] * p + pq[i] * q, pq[i] * p + qq[i] * q);
            sum[i] = 0.5 * (by_p + by_q);
            difference[i] = 0.5 * (by_p - by_q);
        }
    }

    /// Weighted first and second differences along one axis.
    fn apply_lines(&mut self, axis: usize, d: &[f32]) {
        let stride = [1, self.width][axis];
        let margin = self.width + 1;
        let Some(length) = d.len().checked_sub(stride) else { return };
        let (here, next) = (&d[..length], &d[stride..][..length]);
        let weight = &self.edge_weight[axis][..length];
        let flux = &mut self.edge_flux[axis][margin..][..length];
        for i in 0..length {
            flux[i] = weight[i] * (next[i] - here[i]);
        }
        let Some(length) = length.checked_sub(stride) else { return };
        let (before, here, next) = (&d[..length], &d[stride..][..length], &d[2 * stride..][..length]);
        let kappa = &self.smoothness[axis][stride..][..length];
        let second = &mut self.second_difference[axis][margin + stride..][..length];
        for i in 0..length {
            second[i] = kappa[i] * (next[i] - 2.0 * here[i] + before[i]);
        }
    }

    /// The transposed differences of all weighted differences, and the anchors.
    fn gather(&self, anchor_weight: &[f32], direction: &[f32], product: &mut [f32]) {
        let (width, margin, length) = (self.width, self.width + 1, product.len());
        let (sum, sum_before) = (&self.cell_sum[margin..][..length], &self.cell_sum[..length]);
        let (from_left, from_above) =
            (&self.cell_difference[margin - 1..][..length], &self.cell_difference[margin - width..][..length]);
        let (anchor, direction) = (&anchor_weight[..length], &direction[..length]);
        for i in 0..length {
            product[i] = anchor[i] * direction[i] - sum[i] + sum_before[i] + from_left[i] - from_above[i];
        }
        for (axis, stride) in [(0, 1), (1, width)] {
            let (flux, second) = (&self.edge_flux[axis], &self.second_difference[axis]);
            let (leaving, entering) = (&flux[margin..][..length], &flux[margin - stride..][..length]);
            let (before, here, next) = (
                &second[margin - stride..][..length],
                &second[margin..][..length],
                &second[margin + stride..][..length],
            );
            for i in 0..length {
                product[i] += entering[i] - leaving[i] + before[i] - 2.0 * here[i] + next[i];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An odd-sized raster with a ragged mask, and weights from a sine, so that all differ.
    fn system(width: usize, height: usize) -> (NormalOperator, Vec<bool>, Vec<f32>, f64, [Edges; 2]) {
        let length = width * height;
        let weight = |seed: usize, index: usize| 1.1 + (1.7 * index as f32 + seed as f32).sin();
        let inside: Vec<bool> = (0..length).map(|index| index % 7 != 3).collect();
        let is_inside = |column: usize, row: usize| column < width && row < height && inside[row * width + column];
        let mut operator = NormalOperator::default();
        operator.resize(width, length, 0);
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
                operator.smoothness[axis][index] = if both { weight(5 + axis, index) } else { 0.0 };
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
        operator.set_edges(&edges, &(0..length).map(joined).collect::<Vec<u8>>(), [1, 2], damping);
        (operator, inside, anchors, f64::from(damping), edges)
    }

    /// The quadratic form of the matrix, term by term.
    fn quadratic_form(
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
                if operator.smoothness[axis][index] > 0.0 {
                    let bend = at(index + stride) - 2.0 * at(index) + at(index - stride);
                    sum += f64::from(operator.smoothness[axis][index]) * bend * bend;
                }
            }
        }
        sum
    }

    #[test]
    fn the_product_is_half_the_gradient_of_the_quadratic_form() {
        for (width, height) in [(9, 8), (5, 1), (1, 6), (2, 2), (16, 3)] {
            let (mut operator, inside, anchors, damping, edges) = system(width, height);
            // The direction is not zero outside the mask, where it must have no effect.
            let direction: Vec<f32> = (0..width * height).map(|index| (0.9 * index as f32).cos()).collect();
            let mut image = vec![f32::NAN; direction.len()];
            operator.apply(&anchors, &direction, &mut image);
            let off_mask = |(value, inside): (&f32, &bool)| *inside || *value == 0.0;
            assert!(image.iter().zip(&inside).all(off_mask), "{width}x{height}");
            let product: f64 = image.iter().zip(&direction).map(|(a, b)| f64::from(a * b)).sum();
            let whole = quadratic_form(&operator, &inside, &anchors, damping, &edges, &direction);
            assert!((product - whole).abs() < 1e-4 * whole, "{width}x{height}: {product} {whole}");
            for index in (0..direction.len()).filter(|&index| inside[index]) {
                let by = |step: f32| {
                    let mut moved = direction.clone();
                    moved[index] += step;
                    quadratic_form(&operator, &inside, &anchors, damping, &edges, &moved)
                };
                // Half the difference quotient of a quadratic is exactly half its gradient.
                let slope = (by(0.5) - by(-0.5)) / 2.0;
                assert!((slope - f64::from(image[index])).abs() < 1e-3, "{width}x{height} at {index}");
            }
        }
    }
}
