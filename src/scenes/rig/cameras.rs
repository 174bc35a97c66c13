//! The rig of a seed: two cameras, the pose between them, and the projector of the depth sensor.

use nalgebra::{Rotation3, Unit, Vector3};

use crate::pose::Similarity;
use crate::scenes::flaws::Chance;
use crate::view::{Lens, Pinhole, Size};

/// Sizes of colour and of depth cameras.
const COLOUR_SIZES: [Size; 2] = [Size { width: 640, height: 480 }, Size { width: 960, height: 540 }];
const DEPTH_SIZES: [Size; 2] = [Size { width: 512, height: 424 }, Size { width: 640, height: 480 }];
/// Focal lengths relative to the width: 53 to 67 degrees across for colour, 56 to 71 for depth.
const COLOUR_FOCAL: [f64; 2] = [0.75, 1.0];
const DEPTH_FOCAL: [f64; 2] = [0.7, 0.95];
/// Range of the distance between the cameras in metres, mostly sideways, and the largest rotation between them in
/// degrees.
const BASELINE: [f64; 2] = [0.02, 0.08];
const LARGEST_TURN: f64 = 3.0;
/// Range of the distance from projector to depth camera in structured-light sensors, metres.
const PROJECTOR: [f64; 2] = [0.05, 0.08];

/// Properties that all frames of a rig share.
#[derive(Clone, Debug)]
pub struct Rig {
    pub colour_size: Size,
    pub colour: Pinhole,
    pub depth_size: Size,
    pub depth: Pinhole,
    /// P_colour = R P_depth + t, metres.
    pub pose: Similarity,
    /// Position of the projector on the depth camera's x axis, metres.
    pub projector: f64,
}

impl Rig {
    pub fn random(colour_size: Option<Size>, depth_size: Option<Size>, chance: &mut Chance) -> Self {
        let sizes = [COLOUR_SIZES[chance.below(2)], DEPTH_SIZES[chance.below(2)]];
        let (colour_size, depth_size) = (colour_size.unwrap_or(sizes[0]), depth_size.unwrap_or(sizes[1]));
        let colour = camera(colour_size, COLOUR_FOCAL, chance);
        let depth = camera(depth_size, DEPTH_FOCAL, chance);
        let side = if chance.uniform() < 0.5 { -1.0 } else { 1.0 };
        let aside = Vector3::new(side, chance.between([-0.15, 0.15]), chance.between([-0.15, 0.15])).normalize();
        let axis = Vector3::from_fn(|_, _| chance.gaussian());
        let turn = chance.between([0.0, LARGEST_TURN]).to_radians();
        let rotation = Rotation3::from_axis_angle(&Unit::new_normalize(axis), turn).into_inner();
        let translation = chance.between(BASELINE) * aside;
        // The projector is next to the depth camera, on the side of the colour camera or on the opposite one.
        let side = if chance.uniform() < 0.5 { -1.0 } else { 1.0 };
        let pose = Similarity { scale: 1.0, rotation, translation };
        Self { colour_size, colour, depth_size, depth, pose, projector: side * chance.between(PROJECTOR) }
    }
}

fn camera(size: Size, focal: [f64; 2], chance: &mut Chance) -> Pinhole {
    let fx = size.width as f64 * chance.between(focal);
    let fy = fx * chance.between([0.99, 1.01]);
    let [cx, cy] =
        [size.width, size.height].map(|side| 0.5 * (side as f64 - 1.0) + side as f64 * chance.between([-0.02, 0.02]));
    // Barrel or pincushion distortion of up to about a tenth at slope one, partly compensated by the next order, as in
    // typical lenses.
    let k1 = chance.between([-0.12, 0.12]);
    let k2 = -0.4 * k1 + chance.between([-0.02, 0.02]);
    let [p1, p2] = [0; 2].map(|_| chance.between([-0.001, 0.001]));
    let k3 = chance.between([-0.005, 0.005]);
    Pinhole { fx, fy, cx, cy, lens: Lens::Brown([k1, k2, p1, p2, k3, 0.0, 0.0, 0.0]) }
}
