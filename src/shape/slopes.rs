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
        let mean = |log: &[f32]| 0.25 * (log[source] + log[source + 1] + log[below] + log[below + 1]);
        let [red, green, blue] = self.problem.log;
        [mean(red), mean(green), mean(blue)]
    }

    fn pixel_log(&self, source: usize) -> [f32; 3] {
        [0, 1, 2].map(|channel: usize| self.problem.log[channel][source])
    }

    /// Robust brightness cost of a cell; zero where it has no colour.
    pub(super) fn cost(&self, frame: RayFrame, log: [f32; 3], slopes: [f32; 2]) -> f32 {
        let normal = Turn::at(frame, slopes).normal;
        let residuals = self.residuals(normal, log);
        let squared = dot(residuals, residuals);
        if squared.is_nan() { 0.0 } else { squared * self.trust(squared) }
    }

    fn residuals(&self, normal: [f32; 3], log: [f32; 3]) -> [f32; 3] {
        let [red, green, blue] = &self.polynomials;
        [red.shade(normal) - log[0], green.shade(normal) - log[1], blue.shade(normal) - log[2]]
    }

    /// 1 / (1 + r^2 / scale^2): the cost of Geman and McClure is r^2 times this, its weight the square of this.
    fn trust(&self, squared: f32) -> f32 {
        1.0 / (1.0 + squared / (self.problem.colour_scale * self.problem.colour_scale))
    }

    /// The terms of a cell as functions of its slopes, where `log` is to be explained.
    pub(super) fn linearise(&self, frame: RayFrame, log: [f32; 3], slopes: [f32; 2]) -> Linear {
        self.linearise_turn(Turn::at(frame, slopes), log)
    }

    fn linearise_turn(&self, turn: Turn, log: [f32; 3]) -> Linear {
        let residuals = self.residuals(turn.normal, log);
        let squared = dot(residuals, residuals);
        let (mut matrix, mut gradient) = ([0.0; 3], [0.0; 2]);
        if squared.is_nan() {
            return Linear { cost: 0.0, matrix, gradient };
        }
        let trust = self.trust(squared);
        let weight = trust * trust;
        for (polynomial, residual) in self.polynomials.iter().zip(residuals) {
            let slope = polynomial.gradient(turn.normal);
            let row = [dot(slope, turn.along[0]), dot(slope, turn.along[1])];
            matrix[0] += weight * row[0] * row[0];
            matrix[1] += weight * row[0] * row[1];
            matrix[2] += weight * row[1] * row[1];
            gradient[0] += weight * row[0] * residual;
            gradient[1] += weight * row[1] * residual;
        }
        Linear { cost: squared * trust, matrix, gradient }
    }

    /// How well a pixel alone, its colours and its firmness, fixes its slopes: the smaller eigenvalue of its matrix.
    pub(super) fn confidence(&self, frame: RayFrame, source: usize, slopes: [f32; 2]) -> f32 {
        let turn = Turn::at(frame, slopes);
        let [mut pp, mut pq, mut qq] = self.linearise_turn(turn, self.pixel_log(source)).matrix;
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

/// What a cell says about its slopes; all zero where it has no colour.
pub(super) struct Linear {
    pub(super) cost: f32,
    /// Gauss-Newton matrix: pp, pq, qq.
    pub(super) matrix: [f32; 3],
    /// Half the gradient.
    pub(super) gradient: [f32; 2],
}

/// A normal and its derivatives along both slopes.
#[derive(Clone, Copy)]
struct Turn {
    normal: [f32; 3],
    along: [[f32; 3]; 2],
}

impl Turn {
    fn at(RayFrame([a, b, c]): RayFrame, [p, q]: [f32; 2]) -> Self {
        let vector = [a[0] + p * b[0] + q * c[0], a[1] + p * b[1] + q * c[1], a[2] + p * b[2] + q * c[2]];
        let inverse = 1.0 / dot(vector, vector).sqrt();
        let normal = [inverse * vector[0], inverse * vector[1], inverse * vector[2]];
        let along = |side: [f32; 3]| {
            let share = dot(normal, side);
            let off = |axis: usize| inverse * (side[axis] - share * normal[axis]);
            [off(0), off(1), off(2)]
        };
        Self { normal, along: [along(b), along(c)] }
    }
}

fn rotate(rotation: &[[f32; 3]; 3], vector: [f32; 3]) -> [f32; 3] {
    rotation.map(|row| dot(row, vector))
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
