//! The brightness terms of shape from shading for heights, as functions of the surface's two slopes in a cell, four
//! cells side by side (docs/method/heights.md).
//!
//! N = a + p b + q c points at the camera; n = N / |N|; dn/dp = (b - n (n . b)) / |N|, and likewise for q.

use std::borrow::Cow;

use super::problem::HeightProblem;
use super::ray_frames::{ORTHOGRAPHIC, RayFrames};
use crate::light::Polynomial;
use crate::numeric::{Lanes, Mask, Real, dot, robust};
use crate::view::Size;

/// (a, b, c) of four pixels in the light's frame.
type Frames = [[Lanes; 3]; 3];

/// The shading of one problem, with its normals rotated into the light's frame. All functions treat four pixels from
/// the given index on, or the cells to the right of and below them.
pub(super) struct CellTerms<'a> {
    pub(super) problem: HeightProblem<'a>,
    polynomials: [Polynomial; 3],
    view_width: usize,
    rotation: [[f32; 3]; 3],
    /// Rotated (a, b, c) of an orthographic camera.
    orthographic: Frames,
    /// 1 / scale^2 of the robust function.
    inverse_square_scale: Lanes,
}

impl<'a> CellTerms<'a> {
    pub(super) fn new(problem: HeightProblem<'a>, size: Size) -> Self {
        let rotation = std::array::from_fn(|row| std::array::from_fn(|column| problem.rotation[(row, column)] as f32));
        let frame = ORTHOGRAPHIC.map(|vector| vector.map(Lanes::splat));
        Self {
            problem,
            polynomials: Polynomial::of(problem.light),
            view_width: size.width,
            rotation,
            orthographic: frame.map(|vector| rotate(&rotation, vector)),
            inverse_square_scale: Lanes::splat(1.0 / (problem.colour_scale * problem.colour_scale)),
        }
    }

    /// (a, b, c) in the light's frame.
    #[inline(always)]
    pub(super) fn frames(&self, frames: &RayFrames, index: usize) -> Cow<'_, Frames> {
        match frames {
            RayFrames::Orthographic => Cow::Borrowed(&self.orthographic),
            _ => Cow::Owned(self.rotated(frames, index)),
        }
    }

    #[inline(never)]
    fn rotated(&self, frames: &RayFrames, index: usize) -> Frames {
        frames.lanes(index).map(|vector| rotate(&self.rotation, vector))
    }

    /// log S at the centre of the cells.
    #[inline(always)]
    pub(super) fn cell_log(&self, source: usize) -> [Lanes; 3] {
        let (here, below) = (source as isize, (source + self.view_width) as isize);
        let [red, green, blue] = self.problem.log;
        let [mut a, mut b, mut c] = [red, green, blue].map(|log| Lanes::load(log, here));
        for place in [here + 1, below, below + 1] {
            (a, b, c) = (a + Lanes::load(red, place), b + Lanes::load(green, place), c + Lanes::load(blue, place));
        }
        let quarter = Lanes::splat(0.25);
        [quarter * a, quarter * b, quarter * c]
    }

    fn pixel_log(&self, source: usize) -> [Lanes; 3] {
        let [red, green, blue] = self.problem.log.map(|log| Lanes::load(log, source as isize));
        [red, green, blue]
    }

    /// Robust brightness term of those `cells` that have a colour.
    #[inline(never)]
    pub(super) fn objective(&self, frames: &Frames, log: [Lanes; 3], slopes: [Lanes; 2], cells: Mask) -> Lanes {
        let residuals = self.residuals(NormalWithDerivatives::at(frames, slopes).normal, log);
        let squared = dot(residuals, residuals);
        (cells & squared.finite()).select(squared * self.attenuation(squared), Lanes::splat(0.0))
    }

    #[inline(always)]
    fn residuals(&self, normal: [Lanes; 3], log: [Lanes; 3]) -> [Lanes; 3] {
        let [red, green, blue] = &self.polynomials;
        [red.shade(normal) - log[0], green.shade(normal) - log[1], blue.shade(normal) - log[2]]
    }

    #[inline(always)]
    fn attenuation(&self, squared: Lanes) -> Lanes {
        robust::attenuation(squared * self.inverse_square_scale)
    }

    /// The terms of `cells` as functions of their slopes, with residuals relative to `log`.
    pub(super) fn linearise(
        &self,
        frames: &Frames,
        log: [Lanes; 3],
        slopes: [Lanes; 2],
        cells: Mask,
    ) -> LinearisedCells {
        self.linearise_at(&NormalWithDerivatives::at(frames, slopes), log, cells)
    }

    #[inline(never)]
    fn linearise_at(&self, at: &NormalWithDerivatives, log: [Lanes; 3], wanted: Mask) -> LinearisedCells {
        let zero = Lanes::splat(0.0);
        let (mut squared, mut pp, mut pq, mut qq, mut by_p, mut by_q) = (zero, zero, zero, zero, zero, zero);
        for (polynomial, log) in self.polynomials.iter().zip(log) {
            let (shade, slope) = polynomial.expand(at.normal);
            let residual = shade - log;
            let (p, q) = (dot(slope, at.derivatives[0]), dot(slope, at.derivatives[1]));
            squared = squared + residual * residual;
            (pp, pq, qq) = (pp + p * p, pq + p * q, qq + q * q);
            (by_p, by_q) = (by_p + p * residual, by_q + q * residual);
        }
        let attenuation = self.attenuation(squared);
        let weight = attenuation * attenuation;
        let known = wanted & squared.finite();
        LinearisedCells {
            objective: known.select(squared * attenuation, zero),
            matrix: known.select3([weight * pp, weight * pq, weight * qq], [zero; 3]),
            gradient: [known.select(weight * by_p, zero), known.select(weight * by_q, zero)],
        }
    }

    /// Measures how well a single pixel's colours and the weight of its normal determine its slopes, by the smaller
    /// eigenvalue of its matrix. Zero unless `wanted`.
    pub(super) fn confidence(&self, frames: &Frames, source: usize, slopes: [Lanes; 2], wanted: Mask) -> Lanes {
        let at = NormalWithDerivatives::at(frames, slopes);
        let [mut pp, mut pq, mut qq] = self.linearise_at(&at, self.pixel_log(source), wanted).matrix;
        if let Some(weights) = self.problem.normal_weight {
            let (weight, [p, q]) = (Lanes::load(weights, source as isize), at.derivatives);
            pp = pp + weight * dot(p, p);
            pq = pq + weight * dot(p, q);
            qq = qq + weight * dot(q, q);
        }
        let (zero, half) = (Lanes::splat(0.0), Lanes::splat(0.5));
        let (mean, off) = (half * (pp + qq), half * (pp - qq));
        let least = mean - (off * off + pq * pq).sqrt();
        (wanted & zero.less(least)).select(least, zero)
    }
}

/// The brightness terms of four cells around their slopes; all zero for a cell without a colour.
pub(super) struct LinearisedCells {
    pub(super) objective: Lanes,
    /// Gauss-Newton matrix: pp, pq, qq.
    pub(super) matrix: [Lanes; 3],
    /// Half the gradient.
    pub(super) gradient: [Lanes; 2],
}

/// n, dn/dp and dn/dq.
struct NormalWithDerivatives {
    normal: [Lanes; 3],
    derivatives: [[Lanes; 3]; 2],
}

impl NormalWithDerivatives {
    #[inline(always)]
    fn at([a, b, c]: &Frames, [p, q]: [Lanes; 2]) -> Self {
        let vector = [a[0] + p * b[0] + q * c[0], a[1] + p * b[1] + q * c[1], a[2] + p * b[2] + q * c[2]];
        let inverse = Lanes::splat(1.0) / dot(vector, vector).sqrt();
        let normal = [inverse * vector[0], inverse * vector[1], inverse * vector[2]];
        let derivative = |side: &[Lanes; 3]| {
            let along_normal = dot(normal, *side);
            let across = |axis: usize| inverse * (side[axis] - along_normal * normal[axis]);
            [across(0), across(1), across(2)]
        };
        Self { normal, derivatives: [derivative(b), derivative(c)] }
    }
}

fn rotate(rotation: &[[f32; 3]; 3], [x, y, z]: [Lanes; 3]) -> [Lanes; 3] {
    rotation.map(|row| Lanes::splat(row[0]) * x + Lanes::splat(row[1]) * y + Lanes::splat(row[2]) * z)
}
