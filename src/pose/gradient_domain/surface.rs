//! The depth view's surface as the image sees it under a pose: a z-buffer of the triangles between neighbouring samples.

use nalgebra::Vector3;

use crate::pose::contrast::{ContrastProblem, Samples};
use crate::pose::similarity::Similarity;
use crate::view::Size;

/// Neighbours farther apart than this many median steps do not belong to one surface.
const JUMP: f64 = 4.0;
/// Smallest cosine between normal and line of sight; at a more grazing angle no pixel is reliable.
const LEAST_FACING: f32 = 0.15;
/// Cosine below which a pixel loses weight in proportion, and its smallest share.
const FULL_FACING: f32 = 0.3;
const LEAST_SHARE: f32 = 0.1;

/// A pixel of the image with the surface that it shows.
#[derive(Clone, Copy)]
pub(super) struct Hit {
    /// Index of the raster pixel.
    pub cell: u32,
    /// Position in the image, and depth in the colour view's frame, image pixels.
    pub place: [f32; 2],
    pub depth: f32,
    /// The normal in the depth view's frame.
    pub normal: [f32; 3],
    /// Weight from the error of the normal and the angle of view.
    pub weight: f32,
}

/// Triangles that cover less of a raster pixel are seen edge-on.
const LEAST_AREA: f32 = 1e-6;
const NONE: u32 = u32::MAX;

impl Hit {
    /// The point in the colour view's frame.
    pub fn point(&self, problem: &ContrastProblem<'_>) -> Vector3<f64> {
        let pixel = self.place.map(f64::from);
        problem.image.camera.point(problem.image.size, pixel, f64::from(self.depth)).into()
    }
}

/// Triangle and barycentric coordinates of what a pixel shows.
#[derive(Clone, Copy)]
struct Entry {
    depth: f32,
    triangle: u32,
    share: [f32; 2],
}

const EMPTY: Entry = Entry { depth: f32::INFINITY, triangle: NONE, share: [0.0; 2] };

/// The surface under one pose; owns its memory.
pub(super) struct Surface {
    /// Size of the raster, and the number of image pixels from one raster pixel to the next.
    pub size: Size,
    pub step: usize,
    triangles: Vec<[u32; 3]>,
    /// Raster position and depth, in raster pixels, of each sample, and its facing.
    placed: Vec<[f32; 3]>,
    facing: Vec<f32>,
    buffer: Vec<Entry>,
    pub hits: Vec<Hit>,
    /// Index of each raster pixel in `hits`.
    pub place: Vec<u32>,
}

impl Surface {
    /// Of this many raster pixels on the object, at most.
    pub fn new(image: Size, step: usize, samples: &Samples, most: usize) -> Self {
        let size = Size { width: image.width.div_ceil(step), height: image.height.div_ceil(step) };
        let count = samples.list.len();
        Self {
            size,
            step,
            triangles: triangles(samples),
            placed: vec![[0.0; 3]; count],
            facing: vec![0.0; count],
            buffer: vec![EMPTY; size.len()],
            hits: Vec::with_capacity(most),
            place: vec![NONE; size.len()],
        }
    }

    /// Finds what each raster pixel with `usable` shows.
    pub fn look(&mut self, problem: &ContrastProblem<'_>, samples: &Samples, pose: &Similarity, usable: &[bool]) {
        let step = self.step as f64;
        let shift = 0.5 * (step - 1.0);
        for (k, sample) in samples.list.iter().enumerate() {
            let point = pose.apply(sample.point);
            self.facing[k] = -(pose.rotation * sample.normal).z as f32;
            let place = problem.image.camera.project(problem.image.size, point.into());
            self.placed[k] = place.map_or([f32::NAN; 3], |[x, y]| {
                [(x - shift) / step, (y - shift) / step, point.z / step].map(|value| value as f32)
            });
        }
        self.buffer.fill(EMPTY);
        for index in 0..self.triangles.len() {
            self.draw(index);
        }
        self.collect(samples, usable);
    }

    fn draw(&mut self, index: usize) {
        let [a, b, c] = self.triangles[index].map(|k| self.placed[k as usize]);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        // This comparison also rejects NaN.
        if area.abs().is_nan() || area.abs() <= LEAST_AREA {
            return;
        }
        let range = |axis: usize, length: usize| {
            let low = a[axis].min(b[axis]).min(c[axis]).ceil().max(0.0);
            let high = a[axis].max(b[axis]).max(c[axis]).floor().min((length - 1) as f32);
            (low as usize, if high < low { None } else { Some(high as usize) })
        };
        let ((left, Some(right)), (top, Some(low))) = (range(0, self.size.width), range(1, self.size.height)) else {
            return;
        };
        for row in top..=low {
            for column in left..=right {
                let (x, y) = (column as f32 - a[0], row as f32 - a[1]);
                let u = (x * (c[1] - a[1]) - y * (c[0] - a[0])) / area;
                let v = (y * (b[0] - a[0]) - x * (b[1] - a[1])) / area;
                if u < 0.0 || v < 0.0 || u + v > 1.0 {
                    continue;
                }
                let depth = a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]);
                let entry = &mut self.buffer[self.size.index(column, row)];
                if depth < entry.depth {
                    *entry = Entry { depth, triangle: index as u32, share: [u, v] };
                }
            }
        }
    }

    fn collect(&mut self, samples: &Samples, usable: &[bool]) {
        self.hits.clear();
        self.place.fill(NONE);
        let step = self.step as f32;
        let shift = 0.5 * (step - 1.0);
        for (cell, entry) in self.buffer.iter().enumerate() {
            if entry.triangle == NONE || !usable[cell] {
                continue;
            }
            let corners = self.triangles[entry.triangle as usize].map(|k| k as usize);
            let [u, v] = entry.share;
            let shares = [1.0 - u - v, u, v];
            let facing: f32 = corners.iter().zip(shares).map(|(&k, share)| share * self.facing[k]).sum();
            if facing < LEAST_FACING {
                continue;
            }
            let mut normal = [0.0_f32; 3];
            let mut trust = f32::INFINITY;
            for (&k, share) in corners.iter().zip(shares) {
                let sample = &samples.list[k];
                for (sum, part) in normal.iter_mut().zip(sample.normal.iter()) {
                    *sum += share * *part as f32;
                }
                trust = trust.min(samples.weight[sample.cell]);
            }
            let length = normal.iter().map(|part| part * part).sum::<f32>().sqrt().max(f32::MIN_POSITIVE);
            let (column, row) = self.size.position(cell);
            self.place[cell] = self.hits.len() as u32;
            self.hits.push(Hit {
                cell: cell as u32,
                place: [column, row].map(|at| at as f32 * step + shift),
                depth: entry.depth * step,
                normal: normal.map(|part| part / length),
                weight: trust * (facing / FULL_FACING).clamp(LEAST_SHARE, 1.0),
            });
        }
    }
}

/// Triangles between neighbouring samples on one surface.
fn triangles(samples: &Samples) -> Vec<[u32; 3]> {
    let mut place = vec![NONE; samples.grid.len()];
    for (k, sample) in samples.list.iter().enumerate() {
        place[sample.cell] = k as u32;
    }
    let width = samples.grid.width;
    let longest = JUMP * samples.step;
    let close = |a: u32, b: u32| {
        let offset: Vector3<f64> = samples.list[a as usize].point - samples.list[b as usize].point;
        offset.norm() < longest
    };
    let mut triangles = Vec::with_capacity(2 * samples.list.len());
    for row in 0..samples.grid.height.saturating_sub(1) {
        for column in 0..width.saturating_sub(1) {
            let cell = row * width + column;
            let [a, b, c, d] = [cell, cell + 1, cell + width, cell + width + 1].map(|cell| place[cell]);
            let halves = if [a, b, c].contains(&NONE) || [b, c, d].contains(&NONE) {
                [[a, b, c], [b, d, c], [a, b, d], [a, d, c]]
            } else {
                [[a, b, c], [b, d, c], [NONE; 3], [NONE; 3]]
            };
            for corners in halves {
                let [p, q, r] = corners;
                if !corners.contains(&NONE) && close(p, q) && close(q, r) && close(r, p) {
                    triangles.push(corners);
                }
            }
        }
    }
    triangles
}
