//! The depth view as registration by contrast samples it: every stride-th pixel with its point, its normal, and the
//! harmonics of that normal in the depth view's own frame, which no pose changes.

use nalgebra::Vector3;

use super::equations::SHADES;
use super::problem::ContrastProblem;
use crate::light::basis;
use crate::numeric::robust;
use crate::pose::residuals::NORMAL_ERROR;
use crate::view::{Size, extent};

/// A grid pixel with a point and a normal.
pub(in crate::pose) struct Sample {
    /// Index of the pixel on the grid.
    pub cell: usize,
    pub point: Vector3<f64>,
    pub normal: Vector3<f64>,
}

/// Points on a grid.
pub(in crate::pose) struct Samples {
    pub grid: Size,
    /// Number of depth pixels from one sample to the next.
    pub stride: usize,
    /// The existing samples, row by row.
    pub list: Vec<Sample>,
    /// Pairs of neighbours, right of or below each other, as indices in the list.
    pub neighbours: Vec<[u32; 2]>,
    /// Weight of each grid pixel from the error of its normal; zero without a sample.
    pub weight: Vec<f32>,
    /// Harmonics of each grid pixel; zero without a sample.
    pub shades: Vec<[f32; SHADES]>,
    /// Mean of the points, and their root mean square distance from it.
    pub centre: Vector3<f64>,
    pub radius: f64,
    /// Median distance between neighbours.
    pub step: f64,
}

impl Samples {
    pub fn new(problem: &ContrastProblem<'_>, stride: usize) -> Self {
        let size = problem.depth.size;
        let grid = Size { width: size.width.div_ceil(stride), height: size.height.div_ceil(stride) };
        let mut samples = Self {
            grid,
            stride,
            list: Vec::new(),
            neighbours: Vec::new(),
            weight: vec![0.0; grid.len()],
            shades: vec![[0.0; SHADES]; grid.len()],
            centre: Vector3::zeros(),
            radius: 1.0,
            step: 1.0,
        };
        for cell in 0..grid.len() {
            let (column, row) = grid.position(cell);
            samples.enter(problem, cell, size.index(column * stride, row * stride));
        }
        samples.join();
        samples.measure();
        samples
    }

    fn enter(&mut self, problem: &ContrastProblem<'_>, cell: usize, index: usize) {
        let error = f64::from(problem.normal_error[index]);
        let points = &problem.depth.points;
        if !problem.normals.is_valid(index) || !points.is_valid(index) || error.is_nan() {
            return;
        }
        let [point, normal] = [points, problem.normals].map(|field| field.get(index).map(f64::from));
        self.weight[cell] = robust::weight((error / NORMAL_ERROR).powi(2)) as f32;
        let [_, shades @ ..] = basis(normal);
        self.shades[cell] = shades.map(|value| value as f32);
        self.list.push(Sample { cell, point: point.into(), normal: normal.into() });
    }

    /// Finds the neighbours.
    fn join(&mut self) {
        let mut place = vec![u32::MAX; self.grid.len()];
        for (k, sample) in self.list.iter().enumerate() {
            place[sample.cell] = k as u32;
        }
        for (k, sample) in self.list.iter().enumerate() {
            let (column, row) = self.grid.position(sample.cell);
            let right = (column + 1 < self.grid.width).then(|| place[sample.cell + 1]);
            let below = (row + 1 < self.grid.height).then(|| place[sample.cell + self.grid.width]);
            for other in right.into_iter().chain(below).filter(|&other| other != u32::MAX) {
                self.neighbours.push([k as u32, other]);
            }
        }
    }

    /// Measures centre, size and spacing.
    fn measure(&mut self) {
        let (centre, radius) = extent(self.list.iter().map(|sample| sample.point));
        (self.centre, self.radius) = (centre, radius.max(f64::MIN_POSITIVE));
        let mut steps: Vec<f32> = self.neighbours.iter().map(|&pair| self.distance(pair) as f32).collect();
        if !steps.is_empty() {
            self.step = f64::from(crate::numeric::quantile(&mut steps, 0.5));
        }
    }

    /// Distance between two neighbours.
    pub fn distance(&self, [a, b]: [u32; 2]) -> f64 {
        (self.list[a as usize].point - self.list[b as usize].point).norm()
    }
}
