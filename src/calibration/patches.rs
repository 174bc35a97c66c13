//! Patches of the depth map's surface, and their colours in the image.

use nalgebra::Vector3;

use super::evidence::Tiles;
use super::frame::{Frame, Projection};
use super::planes::Planes;
use super::surface::Sample;
use super::unknowns::State;

/// Number of patches of a frame, about ten for each object of a scene.
pub(super) const PATCHES: usize = 48;
/// Rounds of k-means.
const ROUNDS: usize = 6;
/// Weight of normals relative to positions, in units of the cloud's spread: a right angle between normals counts as much
/// as one spread.
const NORMAL_WEIGHT: f64 = 0.7;

/// An image and its camera.
#[derive(Clone, Copy)]
pub(super) struct Sight<'a> {
    pub frame: &'a Frame,
    pub planes: &'a Planes,
}

/// Visible samples of a frame, in patches of similar position and normal.
pub(super) struct Patches {
    pub points: Vec<Vector3<f64>>,
    pub normals: Vec<Vector3<f64>>,
    pub patches: Vec<u8>,
    /// Levels of their intensities.
    pub levels: Vec<u8>,
    pub tiles: Vec<u32>,
}

impl Patches {
    /// The samples that are visible under a projection, in patches.
    pub fn new(samples: &[Sample], projection: &Projection, frame: &Frame) -> Self {
        let tiling = Tiles::new(frame.planes.size);
        let is_seen =
            |sample: &&Sample| !projection.is_hidden[sample.index] && !projection.pixels[sample.index][0].is_nan();
        let visible: Vec<&Sample> = samples.iter().filter(is_seen).collect();
        Self {
            points: visible.iter().map(|sample| sample.point).collect(),
            normals: visible.iter().map(|sample| sample.normal).collect(),
            tiles: visible.iter().map(|sample| tiling.of(projection.pixels[sample.index].map(f64::from))).collect(),
            patches: visible.iter().map(|sample| sample.patch).collect(),
            levels: visible.iter().map(|sample| sample.level).collect(),
        }
    }

    /// The image's colour at each sample; NaN off the image.
    pub fn colours(&self, sight: &Sight, state: &State) -> Vec<[f32; 3]> {
        let camera = state.camera(&sight.frame.camera);
        let colour = |point: &Vector3<f64>| {
            let pixel = camera.project(state.pose.apply(*point).into());
            pixel.map_or([f32::NAN; 3], |pixel| sight.planes.at(pixel))
        };
        self.points.iter().map(colour).collect()
    }
}

/// Groups all samples of a frame, seen or not, so that a patch does not depend on the pose: k-means of position and
/// normal, which begins with samples far from each other.
pub(super) fn group(samples: &mut [Sample]) {
    if samples.is_empty() {
        return;
    }
    let mean = samples.iter().map(|sample| sample.point).sum::<Vector3<f64>>() / samples.len() as f64;
    let spread = (samples.iter().map(|s| (s.point - mean).norm_squared()).sum::<f64>() / samples.len() as f64).sqrt();
    let feature = |sample: &Sample| {
        let place = (sample.point - mean) / spread.max(1e-9);
        let normal = NORMAL_WEIGHT * sample.normal;
        [place.x, place.y, place.z, normal.x, normal.y, normal.z]
    };
    let features: Vec<[f64; 6]> = samples.iter().map(feature).collect();
    let square = |a: &[f64; 6], b: &[f64; 6]| (0..6).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>();
    let mut centres = vec![features[0]];
    let mut far: Vec<f64> = features.iter().map(|f| square(f, &centres[0])).collect();
    while centres.len() < PATCHES.min(features.len()) {
        let next = (0..far.len()).max_by(|&a, &b| far[a].total_cmp(&far[b])).unwrap_or(0);
        centres.push(features[next]);
        far.iter_mut().zip(&features).for_each(|(far, f)| *far = far.min(square(f, &features[next])));
    }
    for _ in 0..ROUNDS {
        let (mut sums, mut counts) = (vec![[0.0; 6]; centres.len()], vec![0.0; centres.len()]);
        for (feature, sample) in features.iter().zip(samples.iter_mut()) {
            let mut least = f64::INFINITY;
            for (k, centre) in centres.iter().enumerate() {
                let distance = square(feature, centre);
                if distance < least {
                    (least, sample.patch) = (distance, k as u8);
                }
            }
            counts[sample.patch as usize] += 1.0;
            (0..6).for_each(|k| sums[sample.patch as usize][k] += feature[k]);
        }
        for (k, centre) in centres.iter_mut().enumerate().filter(|&(k, _)| counts[k] > 0.0) {
            *centre = sums[k].map(|sum| sum / counts[k]);
        }
    }
}
