//! Depth discontinuities (`Discontinuity`): the points of the depth map on the object's silhouette under a pose.
//!
//! Method: draws the points on a raster of cells as wide as the spacing of the points, nearest first. Discontinuities
//! are the points of covered cells next to empty or much farther ones. The end of the data is not always the end of the
//! object. A sharp edge of the depth map, where the surface faces the sensor and then stops, lies on the silhouette in
//! every view. An occluding contour, where the surface turns away, lies on the silhouette only in the view from which
//! the surface turns away.

use nalgebra::Vector3;

use super::problem::SilhouetteProblem;
use crate::pose::similarity::Similarity;
use crate::view::Size;

/// Neighbours in the depth map whose distances differ by more than this share, 15 mm at 0.75 m, do not belong to one
/// surface.
const JUMP: f64 = 0.02;
/// Cosines between normal and ray of the depth camera. A discontinuity begins to count as sharp at the first and counts
/// fully above the second. Normals of real sensors at an occluding contour do not fall below 0.3.
const SHARP: [f64; 2] = [0.35, 0.7];
/// Cosine between normal and ray of the colour camera below which a surface turns away.
const TURNED_AWAY: f64 = 0.45;
/// Weight of a discontinuity on such a surface.
const TURNING_WEIGHT: f64 = 0.5;

/// A depth discontinuity: a point of the depth map on the object's silhouette.
#[derive(Clone, Copy)]
pub struct Discontinuity {
    pub index: u32,
    pub weight: f64,
    /// Outward unit normal in the image.
    pub normal: [f64; 2],
    /// Whether background is beside the point rather than another part of the object.
    pub is_outer: bool,
}

/// Finds depth discontinuities; owns its memory.
pub struct Discontinuities {
    raster: Size,
    /// Width of a cell in image pixels.
    cell: f64,
    /// Nearest point of each cell, and its depth.
    owners: Vec<u32>,
    depths: Vec<f32>,
    /// Sharpness of the depth map's own edge at each point; zero inside.
    sharpness: Vec<f32>,
    /// The discontinuities under the present pose.
    pub found: Vec<Discontinuity>,
}

/// Reach, in cells, of the neighbourhood that determines the normal of a discontinuity.
const AROUND: usize = 5;
/// The mark of a cell without a point.
const BARE: u32 = u32::MAX;

impl Discontinuities {
    pub fn new(problem: &SilhouetteProblem<'_>) -> Self {
        let (image, depth) = (problem.image, problem.depth);
        let inside = image.mask.iter().filter(|&&inside| inside).count();
        let cell = (inside as f64 / depth.valid().max(1) as f64).sqrt().max(1.0);
        let across = |length: usize| (length as f64 / cell).ceil() as usize + 1;
        let raster = Size { width: across(image.size.width), height: across(image.size.height) };
        Self {
            owners: vec![BARE; raster.len()],
            depths: vec![f32::INFINITY; raster.len()],
            sharpness: (0..depth.size.len()).map(|index| sharpness(problem, index)).collect(),
            found: Vec::new(),
            raster,
            cell,
        }
    }

    /// Finds the discontinuities under a pose. `pixels` are the image positions of the points, NaN where missing.
    pub fn update(&mut self, problem: &SilhouetteProblem<'_>, pose: &Similarity, pixels: &[[f32; 2]]) {
        self.draw(problem, pose, pixels);
        self.found.clear();
        let eye = pose.inverse().translation;
        for cell in 0..self.raster.len() {
            let owner = self.owners[cell];
            if owner == BARE || !self.raster.neighbours(cell).any(|beside| self.is_beyond(cell, beside)) {
                continue;
            }
            let weight = f64::from(self.sharpness[owner as usize]).max(contour(problem, pose, &eye, owner as usize));
            let Some((normal, is_outer)) = self.outward(cell).filter(|_| weight > 0.0) else { continue };
            self.found.push(Discontinuity { index: owner, weight, normal, is_outer });
        }
    }

    /// Whether the other cell is empty or much farther away.
    fn is_beyond(&self, cell: usize, other: usize) -> bool {
        f64::from(self.depths[other]) > (1.0 + JUMP) * f64::from(self.depths[cell])
    }

    /// Direction towards the cells beyond a cell, and whether most of them are empty.
    fn outward(&self, cell: usize) -> Option<([f64; 2], bool)> {
        let (column, row) = self.raster.position(cell);
        let (mut sum, mut bare, mut count) = ([0.0; 2], 0, 0);
        for v in row.saturating_sub(AROUND)..=(row + AROUND).min(self.raster.height - 1) {
            for u in column.saturating_sub(AROUND)..=(column + AROUND).min(self.raster.width - 1) {
                let other = self.raster.index(u, v);
                if self.is_beyond(cell, other) {
                    sum[0] += u as f64 - column as f64;
                    sum[1] += v as f64 - row as f64;
                    (bare, count) = (bare + usize::from(self.owners[other] == BARE), count + 1);
                }
            }
        }
        let length = sum[0].hypot(sum[1]);
        (length > 0.0).then(|| (sum.map(|part| part / length), 2 * bare > count))
    }

    /// Width of a cell in image pixels: the spacing of discontinuities.
    pub const fn cell(&self) -> f64 {
        self.cell
    }

    /// Whether a point covers a pixel of the image.
    pub fn covers(&self, [column, row]: [f64; 2]) -> bool {
        let at = self.raster.nearest((column / self.cell) as f32, (row / self.cell) as f32);
        at.is_some_and(|cell| self.owners[cell] != BARE)
    }

    fn draw(&mut self, problem: &SilhouetteProblem<'_>, pose: &Similarity, pixels: &[[f32; 2]]) {
        self.owners.fill(BARE);
        self.depths.fill(f32::INFINITY);
        let [along, shift] = [pose.scale * pose.rotation.row(2).transpose(), Vector3::repeat(pose.translation.z)];
        for (index, &[column, row]) in pixels.iter().enumerate().filter(|(_, pixel)| !pixel[0].is_nan()) {
            let depth = (along.dot(&problem.point(index)) + shift.z) as f32;
            let [x, y] = [column, row].map(|at| at / self.cell as f32);
            for at in [[x.floor(), y.floor()], [x.ceil(), y.floor()], [x.floor(), y.ceil()], [x.ceil(), y.ceil()]] {
                if let Some(cell) = self.raster.nearest(at[0], at[1])
                    && depth < self.depths[cell]
                {
                    (self.depths[cell], self.owners[cell]) = (depth, index as u32);
                }
            }
        }
    }
}

/// Sharpness of the depth map's own edge at a point; zero inside and at the frame, where the map is cut off.
fn sharpness(problem: &SilhouetteProblem<'_>, index: usize) -> f32 {
    let depth = problem.depth;
    if !depth.points.is_valid(index) {
        return 0.0;
    }
    let here = f64::from(depth.points.z[index]);
    let ends = depth.size.neighbours(index).any(|beside| {
        let there = f64::from(depth.points.z[beside]);
        if there.is_nan() { !depth.mask[beside] } else { there - here > JUMP * here }
    });
    if !ends {
        return 0.0;
    }
    let sight = if depth.camera.is_orthographic() { Vector3::z() } else { problem.point(index) };
    let [none, full] = SHARP;
    ((cosine(problem, index, &sight) - none) / (full - none)).clamp(0.0, 1.0) as f32
}

/// Weight of a surface that turns away from the colour camera at `eye`.
fn contour(problem: &SilhouetteProblem<'_>, pose: &Similarity, eye: &Vector3<f64>, index: usize) -> f64 {
    let is_parallel = problem.image.camera.is_orthographic();
    let sight = if is_parallel { pose.rotation.tr_mul(&Vector3::z()) } else { problem.point(index) - eye };
    TURNING_WEIGHT * (1.0 - cosine(problem, index, &sight) / TURNED_AWAY).max(0.0)
}

/// |cosine| between normal and ray; one without a normal.
fn cosine(problem: &SilhouetteProblem<'_>, index: usize, sight: &Vector3<f64>) -> f64 {
    let normal = Vector3::from(problem.normals.get(index).map(f64::from));
    let cosine = normal.dot(sight).abs() / sight.norm();
    if cosine.is_nan() { 1.0 } else { cosine }
}
