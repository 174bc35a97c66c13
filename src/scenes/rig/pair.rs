//! Pairs of one object, seen by a colour camera and by a depth camera from another place: the page's gallery. Meshes,
//! albedos and lights are made here, so they are free of licences, and each pair differs from the others in kind.

use std::f64::consts::TAU;

use nalgebra::{Rotation3, Vector3};

use super::cameras::Rig;
use super::colour::{SAMPLES, develop, radiance};
use super::depth::{look, measure};
use super::illumination::Illumination;
use super::pattern::{Albedo, Pattern};
use super::raster::{NOTHING, Rays};
use super::solids::{Solid, torus};
use super::stage::Stage;
use crate::error::Result;
use crate::light::Light;
use crate::pose::Similarity;
use crate::scenes::flaws::Chance;
use crate::scenes::{Mesh, lights, surface};
use crate::view::{Lens, Pinhole, Size};

/// Sizes of both views, and their focal lengths in pixels: a photograph of the object, and the middle of a depth map.
const COLOUR_SIZE: Size = Size { width: 320, height: 320 };
const DEPTH_SIZE: Size = Size { width: 256, height: 256 };
const COLOUR_FOCAL: f64 = 640.0;
const DEPTH_FOCAL: f64 = 460.0;
/// Distance from the colour camera to the object's middle in metres.
const DISTANCE: f64 = 0.9;
/// Height of the objects, and the distance from their middle to the wall behind them, in metres.
const HEIGHT: f64 = 0.32;
const WALL: f64 = 0.6;
/// Samples along a side of the built-in surfaces.
const RELIEF_SIDE: f64 = 256.0;
/// Distance between projector and depth camera in metres.
const PROJECTOR: f64 = 0.06;
/// Seed of albedos, lamps and noise, and its streams.
const SEED: u64 = 6;
#[derive(Clone, Copy)]
enum Stream {
    Albedo,
    Light,
    Image,
    Sensor,
}

/// What a pair shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PairKind {
    /// A bust of one albedo in the light of a window.
    Bust,
    /// A knotted tube of one albedo that hides parts of itself, under an overcast sky.
    Knot,
    /// A bust with veins like marble, in the light of a window.
    Marble,
    /// A carved relief lit by a lamp that casts shadows.
    Relief,
    /// A vase of which the depth camera sees one half.
    Cut,
    /// A bowl, which looks the same after any rotation about its axis.
    Bowl,
}

impl PairKind {
    /// All kinds.
    pub const ALL: [Self; 6] = [Self::Bust, Self::Knot, Self::Marble, Self::Relief, Self::Cut, Self::Bowl];

    /// Lower-case name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bust => "bust",
            Self::Knot => "knot",
            Self::Marble => "marble",
            Self::Relief => "relief",
            Self::Cut => "cut",
            Self::Bowl => "bowl",
        }
    }

    fn recipe(self) -> Recipe {
        let plain = Recipe {
            turn: [0.0, 25.0],
            sky: lights::WINDOW,
            has_lamp: false,
            pattern: Pattern::Plain,
            away: 1.0,
            aside: 0.0,
        };
        match self {
            Self::Bust => plain,
            Self::Knot => Recipe { turn: [5.0, -20.0], sky: lights::OVERCAST, ..plain },
            Self::Marble => Recipe { turn: [0.0, 15.0], pattern: Pattern::Marble, ..plain },
            Self::Relief => Recipe { turn: [8.0, 20.0], sky: lights::OVERCAST, has_lamp: true, ..plain },
            Self::Cut => Recipe { turn: [0.0, 20.0], away: 1.2, aside: 0.5, ..plain },
            Self::Bowl => Recipe { turn: [10.0, 20.0], sky: lights::OVERCAST, ..plain },
        }
    }

    fn solid(self) -> Result<Solid> {
        Ok(match self {
            Self::Bust | Self::Marble => of_mesh(&Mesh::from_relief(&surface("bust")?)?),
            Self::Relief => of_mesh(&Mesh::from_relief(&surface("ripples")?)?),
            Self::Cut => of_mesh(&Mesh::from_relief(&surface("vase")?)?),
            Self::Knot => knot(),
            Self::Bowl => bowl(),
        })
    }
}

/// How a pair is made.
struct Recipe {
    /// Rotation from the colour camera to the depth camera about x and y, through the object's middle, degrees.
    turn: [f64; 2],
    sky: Light,
    has_lamp: bool,
    pattern: Pattern,
    /// Distance of the depth camera relative to that of the colour camera.
    away: f64,
    /// Distance by which the depth camera looks past the object, relative to its width of view.
    aside: f64,
}

/// Both views with the true pose.
#[derive(Clone, Debug)]
pub struct RenderedPair {
    /// RGBA, 8 bits of sRGB each, row-major.
    pub colour: Vec<u8>,
    /// Columns and rows of the colour image.
    pub colour_size: Size,
    /// True where the image shows only the object.
    pub colour_mask: Vec<bool>,
    /// Camera of the colour image.
    pub colour_camera: Pinhole,
    /// Millimetres along z, 0 where nothing was measured.
    pub depth: Vec<u16>,
    /// Columns and rows of the depth map.
    pub depth_size: Size,
    /// True where the depth camera sees the object.
    pub depth_mask: Vec<bool>,
    /// Camera of the depth map.
    pub depth_camera: Pinhole,
    /// P_colour = R P_depth + t, metres, scale 1.
    pub pose: Similarity,
}

/// Renders a pair of the gallery, with the typical noise of both sensors.
///
/// # Errors
/// None for the built-in surfaces.
pub fn render_pair(kind: PairKind) -> Result<RenderedPair> {
    let recipe = kind.recipe();
    let chance = |stream: Stream| Chance::of_stream(SEED, 8 * kind as u64 + stream as u64);
    let stage = stage(&kind.solid()?, recipe.pattern, &mut chance(Stream::Albedo));
    let rig = rig(&recipe);
    let view = at_distance(DISTANCE);
    let placement = rig.pose.inverse().after(&view);
    let light = Illumination::given(recipe.sky, recipe.has_lamp, &stage, Vector3::zeros(), &mut chance(Stream::Light));
    let rays = Rays::new(&rig.colour, rig.colour_size, SAMPLES);
    let hits = rays.meet(&stage, &view);
    let linear = radiance(&stage, &light, &view, &rays, &hits, rig.colour_size);
    let seen = look(&stage, &placement, &rig);
    let depth_rays = Rays::new(&rig.depth, rig.depth_size, 1);
    let met = depth_rays.meet(&stage, &placement);
    let is_object = |triangle: u32| triangle != NOTHING && stage.triangles[triangle as usize].albedo == OBJECT;
    let whole_pixel = |index: usize| {
        let (column, row) = rig.colour_size.position(index);
        (0..SAMPLES * SAMPLES).all(|part| {
            let sample = rays.size.index(SAMPLES * column + part % SAMPLES, SAMPLES * row + part / SAMPLES);
            is_object(hits.triangles[sample])
        })
    };
    Ok(RenderedPair {
        colour: develop(&linear, 1.0, &mut chance(Stream::Image)),
        colour_mask: (0..rig.colour_size.len()).map(whole_pixel).collect(),
        colour_size: rig.colour_size,
        colour_camera: rig.colour,
        depth: measure(&seen, rig.depth_size, 1.0, &mut chance(Stream::Sensor)),
        depth_mask: met.triangles.iter().map(|&triangle| is_object(triangle)).collect(),
        depth_size: rig.depth_size,
        depth_camera: rig.depth,
        pose: rig.pose,
    })
}

/// Index of the object's albedo on its stage.
const OBJECT: u32 = 0;

/// The object about the origin, in front of a plain wall.
fn stage(object: &Solid, pattern: Pattern, chance: &mut Chance) -> Stage {
    let mut stage = Stage::default();
    let here = Similarity::identity();
    stage.put(object, &here, Albedo::with(pattern, HEIGHT, &here, chance));
    let side = 4.0;
    let wall = Solid::face(Vector3::new(-0.5 * side, -0.5 * side, 0.0), side * Vector3::x(), side * Vector3::y());
    let behind = Similarity { translation: Vector3::new(0.0, 0.0, WALL), ..here };
    stage.put(&wall, &behind, Albedo::plain(&behind, chance));
    stage
}

fn at_distance(distance: f64) -> Similarity {
    Similarity { translation: Vector3::new(0.0, 0.0, distance), ..Similarity::identity() }
}

fn rig(recipe: &Recipe) -> Rig {
    let camera = |size: Size, focal: f64, aside: f64| {
        let [cx, cy] = [size.width, size.height].map(|side| 0.5 * (side as f64 - 1.0));
        Pinhole { fx: focal, fy: focal, cx: cx + aside * size.width as f64, cy, lens: Lens::None }
    };
    let [alpha, beta] = recipe.turn.map(f64::to_radians);
    let rotation =
        Rotation3::from_axis_angle(&Vector3::y_axis(), beta) * Rotation3::from_axis_angle(&Vector3::x_axis(), alpha);
    let turned = Similarity { rotation: rotation.into_inner(), ..Similarity::identity() };
    let pose = at_distance(DISTANCE).after(&turned).after(&at_distance(recipe.away * DISTANCE).inverse());
    Rig {
        colour_size: COLOUR_SIZE,
        colour: camera(COLOUR_SIZE, COLOUR_FOCAL, 0.0),
        depth_size: DEPTH_SIZE,
        depth: camera(DEPTH_SIZE, DEPTH_FOCAL, recipe.aside),
        pose,
        projector: PROJECTOR,
    }
}

/// A relief as a body of the gallery's size.
fn of_mesh(mesh: &Mesh) -> Solid {
    let scale = HEIGHT / RELIEF_SIDE;
    Solid {
        points: mesh.vertices().iter().map(|vertex| scale * (vertex - mesh.centroid())).collect(),
        normals: mesh.normals().to_vec(),
        triangles: mesh.triangles().to_vec(),
    }
}

/// A tube along a trefoil knot, tilted so that no symmetry is left. Its thickness grows along the knot.
fn knot() -> Solid {
    let centre = |u: f64| {
        let (twice, thrice) = (2.0 * TAU * u, 3.0 * TAU * u);
        let radius = 1.0 + 0.45 * thrice.cos();
        Vector3::new(radius * twice.cos(), 1.15 * radius * twice.sin(), 0.55 * thrice.sin())
    };
    Solid::net([320, 32], |[u, v]| {
        const STEP: f64 = 1e-4;
        let along = (centre(u + STEP) - centre(u - STEP)).normalize();
        let aside = along.cross(&Vector3::z()).normalize();
        let up = aside.cross(&along);
        let (sin, cos) = (TAU * v).sin_cos();
        let thickness = 0.3 + 0.07 * (TAU * u).sin();
        0.3 * HEIGHT * (centre(u) + thickness * (cos * aside + sin * up))
    })
}

/// A bowl with a rounded edge.
fn bowl() -> Solid {
    let outside = |t: f64| {
        let angle = 0.25 * TAU * t;
        [0.12 * angle.sin() + 0.02, -0.07 + 0.13 * angle.cos()]
    };
    let inside = |t: f64| {
        let angle = 0.25 * TAU * t;
        [0.11 * angle.sin() + 0.015, -0.07 + 0.115 * angle.cos()]
    };
    let mut bowl = Solid::revolved(&[&outside, &inside], [96, 48]);
    let rim = torus(0.1).stretched(Vector3::new(0.135, 0.15, 0.135));
    let lowered = rim.points.iter().map(|point| point - 0.07 * Vector3::y()).collect();
    bowl.add(Solid { points: lowered, ..rim });
    bowl
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Share of the measured points of the object that the true pose puts on the object in the image.
    fn landing(pair: &RenderedPair, pose: &Similarity) -> f64 {
        let (mut landed, mut all) = (0, 0);
        for index in (0..pair.depth.len()).filter(|&index| pair.depth_mask[index] && pair.depth[index] > 0) {
            let (column, row) = pair.depth_size.position(index);
            let ray = pair.depth_camera.ray([column as f64, row as f64]).unwrap();
            let point = 0.001 * f64::from(pair.depth[index]) * Vector3::from(ray);
            let [x, y] = pair.colour_camera.project(pose.apply(point).into()).unwrap();
            let near = pair.colour_size.nearest(x as f32, y as f32);
            landed += usize::from(near.is_some_and(|index| pair.colour_mask[index]));
            all += 1;
        }
        f64::from(landed as u32) / f64::from(all as u32)
    }

    #[test]
    fn the_true_pose_puts_the_depth_points_onto_the_object_in_the_image() {
        for kind in PairKind::ALL {
            let pair = render_pair(kind).unwrap();
            let [right, wrong] = [pair.pose, Similarity::identity()].map(|pose| landing(&pair, &pose));
            assert!(right > 0.9 && right > wrong, "{}: {right} {wrong}", kind.name());
        }
    }

    /// Holes on the object, depths in the steps of the sensor's disparity, and noise beyond those steps.
    #[test]
    fn the_depth_map_has_the_flaws_of_a_sensor() {
        let pair = render_pair(PairKind::Knot).unwrap();
        let inside = || pair.depth.iter().zip(&pair.depth_mask).filter(|&(_, &inside)| inside).map(|(&depth, _)| depth);
        let lost = inside().filter(|&depth| depth == 0).count() as f64 / inside().count() as f64;
        assert!((0.02..0.4).contains(&lost), "{lost}");
        let mut levels: Vec<u16> = inside().filter(|&depth| depth > 0).collect();
        levels.sort_unstable();
        levels.dedup();
        // z^2 / (f b) times the step of the disparity is 2.3 mm at 0.9 m.
        let gaps: Vec<u16> = levels.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(gaps.iter().all(|&gap| gap >= 1) && levels.len() > 50, "{}", levels.len());
        let around: Vec<u16> =
            gaps.iter().zip(&levels).filter(|&(_, &z)| (850..950).contains(&z)).map(|(&g, _)| g).collect();
        assert!(around.iter().all(|gap| (2..=3).contains(gap)), "{around:?}");
    }

    #[test]
    fn a_pair_is_the_same_each_time_and_no_two_are_alike() {
        let again = render_pair(PairKind::Bowl).unwrap();
        assert_eq!(render_pair(PairKind::Bowl).unwrap().depth, again.depth);
        let all: Vec<Vec<u8>> = PairKind::ALL.iter().map(|&kind| render_pair(kind).unwrap().colour).collect();
        assert!((1..6).all(|at| !all[..at].contains(&all[at])));
    }
}
