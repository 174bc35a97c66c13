//! One pixel's terms of shape from shading for heights, as functions of the surface's two slopes there.
//!
//! N = a + p b + q c points at the camera; n = N / |N|; dn/dp = (b - n (n . b)) / |N|, and so for q.

use nalgebra::Vector3;

use crate::light::Polynomial;
use crate::shape::heights::HeightProblem;
use crate::view::{Camera, Size};

/// (a, b, c) of N = a + p b + q c: N points at the camera, p and q are slopes per pixel in pixels of height.
///
/// Orthographic: z is depth in pixels and N = (p, q, -1). Pinhole: z = f log Z, so that slopes are alike, and with the
/// ray r(u, v): a = r_v x r_u, b = (r_v x r) / f, c = (r x r_u) / f.
#[derive(Clone, Copy, Debug)]
pub(super) struct RayFrame(pub(super) [[f32; 3]; 3]);

impl RayFrame {
    pub(super) fn at(camera: &Camera, size: Size, index: usize) -> Self {
        let Some(focal_length) = camera.focal_length() else {
            return Self([[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        };
        let (column, row) = size.position(index);
        let ray = |right: f64, down: f64| {
            let [x, y] = camera.ray(size, [column as f64 + right, row as f64 + down]);
            Vector3::new(x, y, 1.0)
        };
        let along_column = ray(0.5, 0.0) - ray(-0.5, 0.0);
        let along_row = ray(0.0, 0.5) - ray(0.0, -0.5);
        let here = ray(0.0, 0.0);
        // Scaled by f^2 so that N has length of order one.
        let scale = focal_length * focal_length;
        let vectors = [
            scale * along_row.cross(&along_column),
            focal_length * along_row.cross(&here),
            focal_length * here.cross(&along_column),
        ];
        Self(vectors.map(|v| [v.x as f32, v.y as f32, v.z as f32]))
    }
}

/// The shading of one problem, its light turned into the view's frame.
pub(super) struct SlopeTerms<'a> {
    pub(super) problem: HeightProblem<'a>,
    polynomials: [Polynomial; 3],
    view_width: usize,
    rotation: [[f32; 3]; 3],
    /// Rotated (a, b, c) of an orthographic camera.
    frame: RayFrame,
}

impl<'a> SlopeTerms<'a> {
    pub(super) fn new(problem: HeightProblem<'a>, size: Size) -> Self {
        let rotation = std::array::from_fn(|row| std::array::from_fn(|column| problem.rotation[(row, column)] as f32));
        Self {
            problem,
            polynomials: Polynomial::of(problem.light),
            view_width: size.width,
            rotation,
            frame: RayFrame(RayFrame::at(&Camera::Orthographic, size, 0).0.map(|v| rotate(&rotation, v))),
        }
    }

    /// (a, b, c) of a pixel in the light's frame; `frames` is empty for an orthographic camera.
    pub(super) fn frame(&self, frames: &[RayFrame], index: usize) -> RayFrame {
        frames.get(index).map_or(self.frame, |frame| RayFrame(frame.0.map(|vector| rotate(&self.rotation, vector))))
    }

    /// log S in the middle of the cell right of and below a pixel.
    pub(super) fn cell_log(&self, source: usize) -> [f32; 3] {
        let below = source + self.view_width;
        [0, 1, 2].map(|channel: usize| {
            let log = self.problem.log[channel];
            0.25 * (log[source] + log[source + 1] + log[below] + log[below + 1])
        })
    }

    fn pixel_log(&self, source: usize) -> [f32; 3] {
        [0, 1, 2].map(|channel: usize| self.problem.log[channel][source])
    }

    /// Robust brightness cost of a cell; zero where it has no colour.
    pub(super) fn cost(&self, frame: RayFrame, source: usize, slopes: [f32; 2]) -> f32 {
        let normal = Turn::at(frame, slopes).normal;
        let log = self.cell_log(source);
        let squared: f32 = (0..3).map(|c| (log[c] - self.polynomials[c].shade(normal)).powi(2)).sum();
        let scale = self.problem.colour_scale * self.problem.colour_scale;
        if squared.is_nan() { 0.0 } else { squared / (1.0 + squared / scale) }
    }

    /// Gauss-Newton matrix (pp, pq, qq) and half the gradient over the slopes at which `log` is explained.
    pub(super) fn linearise(&self, frame: RayFrame, log: [f32; 3], slopes: [f32; 2]) -> ([f32; 3], [f32; 2]) {
        self.linearise_turn(Turn::at(frame, slopes), log)
    }

    fn linearise_turn(&self, turn: Turn, log: [f32; 3]) -> ([f32; 3], [f32; 2]) {
        let residuals: [f32; 3] = std::array::from_fn(|c| self.polynomials[c].shade(turn.normal) - log[c]);
        let squared: f32 = residuals.iter().map(|r| r * r).sum();
        let (mut matrix, mut gradient) = ([0.0; 3], [0.0; 2]);
        if squared.is_nan() {
            return (matrix, gradient);
        }
        let scale = self.problem.colour_scale * self.problem.colour_scale;
        let weight = (1.0 + squared / scale).powi(-2);
        for (polynomial, residual) in self.polynomials.iter().zip(residuals) {
            let slope = polynomial.gradient(turn.normal);
            let row = turn.along.map(|along| dot(slope, along));
            matrix[0] += weight * row[0] * row[0];
            matrix[1] += weight * row[0] * row[1];
            matrix[2] += weight * row[1] * row[1];
            gradient[0] += weight * row[0] * residual;
            gradient[1] += weight * row[1] * residual;
        }
        (matrix, gradient)
    }

    /// How well a pixel alone, its colours and its firmness, fixes its slopes: the smaller eigenvalue of its matrix.
    pub(super) fn confidence(&self, frame: RayFrame, source: usize, slopes: [f32; 2]) -> f32 {
        let turn = Turn::at(frame, slopes);
        let ([mut pp, mut pq, mut qq], _) = self.linearise_turn(turn, self.pixel_log(source));
        if let Some(firmness) = self.problem.firmness {
            let [p, q] = turn.along;
            pp += firmness[source] * dot(p, p);
            pq += firmness[source] * dot(p, q);
            qq += firmness[source] * dot(q, q);
        }
        let (mean, half) = (0.5 * (pp + qq), 0.5 * (pp - qq));
        (mean - (half * half + pq * pq).sqrt()).max(0.0)
    }
}

/// A normal and its derivatives along both slopes.
#[derive(Clone, Copy)]
struct Turn {
    normal: [f32; 3],
    along: [[f32; 3]; 2],
}

impl Turn {
    fn at(RayFrame([a, b, c]): RayFrame, [p, q]: [f32; 2]) -> Self {
        let vector: [f32; 3] = std::array::from_fn(|axis| a[axis] + p * b[axis] + q * c[axis]);
        let inverse = 1.0 / dot(vector, vector).sqrt();
        let normal = vector.map(|value| value * inverse);
        let along = [b, c].map(|side| {
            let share = dot(normal, side);
            std::array::from_fn(|axis| inverse * (side[axis] - share * normal[axis]))
        });
        Self { normal, along }
    }
}

fn rotate(rotation: &[[f32; 3]; 3], vector: [f32; 3]) -> [f32; 3] {
    rotation.map(|row| dot(row, vector))
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
