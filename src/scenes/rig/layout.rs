//! Arrangement of the four kinds of scenes. World frame: x right, y down along gravity, z forward, metres.

use std::f64::consts::PI;

use nalgebra::{Rotation3, Unit, Vector3};

use super::pattern::Albedo;
use super::sheet::sheet;
use super::solids::{Solid, icosahedron, prism, torus};
use super::stage::Stage;
use crate::pose::Similarity;
use crate::scenes::flaws::Chance;

/// Half the side of a wall or a floor that has to fill the view, metres.
const WALL_REACH: f64 = 3.0;
/// Ranges of the size of objects and of their distance, metres.
const OBJECT_SIZE: [f64; 2] = [0.08, 0.25];
const OBJECT_DISTANCE: [f64; 2] = [0.6, 1.2];
/// Range of the distance from the farthest object to the wall behind it, metres.
const BACKGROUND: [f64; 2] = [0.3, 0.7];
/// Lateral reach of objects from the middle, metres.
const ASIDE: f64 = 0.62;
/// Maximum number of attempts to place objects.
const ATTEMPTS: usize = 40;

/// Kind of scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigKind {
    /// Three to six bodies of 8 to 25 cm at 0.6 to 1.2 m, with a wall at least 0.3 m behind them.
    Objects,
    /// A crumpled sheet or a draped cloth in front of a wall.
    Sheet,
    /// Boxes on a table, some on top of others.
    Boxes,
    /// Walls, a floor and furniture at 1.5 to 4 m.
    Room,
}

impl RigKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Objects, Self::Sheet, Self::Boxes, Self::Room];

    /// Lower-case name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Objects => "objects",
            Self::Sheet => "sheet",
            Self::Boxes => "boxes",
            Self::Room => "room",
        }
    }
}

/// A stage, the rig's pose in it, and the scene's centre.
pub struct Layout {
    pub stage: Stage,
    /// The transformation from the world to the colour camera.
    pub view: Similarity,
    pub target: Vector3<f64>,
}

pub fn layout(kind: RigKind, chance: &mut Chance) -> Layout {
    match kind {
        RigKind::Objects => objects(chance),
        RigKind::Sheet => crumpled(chance),
        RigKind::Boxes => boxes(chance),
        RigKind::Room => room(chance),
    }
}

/// The rig at the origin, looking down by `pitch` radians and slightly rolled.
fn view(pitch: f64, chance: &mut Chance) -> Similarity {
    let roll = chance.between([-0.06, 0.06]);
    let rotation =
        Rotation3::from_axis_angle(&Vector3::z_axis(), roll) * Rotation3::from_axis_angle(&Vector3::x_axis(), pitch);
    Similarity { rotation: rotation.into_inner(), ..Similarity::identity() }
}

fn at(rotation: Rotation3<f64>, translation: Vector3<f64>) -> Similarity {
    Similarity { scale: 1.0, rotation: rotation.into_inner(), translation }
}

fn yaw(angle: f64) -> Rotation3<f64> {
    Rotation3::from_axis_angle(&Vector3::y_axis(), angle)
}

fn any_turn(chance: &mut Chance) -> Rotation3<f64> {
    let axis = Vector3::from_fn(|_, _| chance.gaussian());
    Rotation3::from_axis_angle(&Unit::new_normalize(axis), chance.between([0.0, PI]))
}

impl Stage {
    fn put_patterned(&mut self, solid: &Solid, size: f64, placement: &Similarity, chance: &mut Chance) {
        self.put(solid, placement, Albedo::random(size, placement, chance));
    }

    /// A wall at `distance` in front of the rig, turned about the vertical by `angle`.
    fn put_wall(&mut self, distance: f64, angle: f64, chance: &mut Chance) {
        let side = 2.0 * WALL_REACH;
        let wall = Solid::face(Vector3::new(-WALL_REACH, -WALL_REACH, 0.0), side * Vector3::x(), side * Vector3::y());
        let placement = at(yaw(angle), Vector3::new(0.0, 0.0, distance));
        self.put_background(&wall, &placement, chance);
    }

    /// A floor this far below the rig, ending at z = `end`.
    fn put_floor(&mut self, below: f64, end: f64, chance: &mut Chance) {
        let side = 2.0 * WALL_REACH;
        let corner = Vector3::new(-WALL_REACH, 0.0, 0.0);
        let floor = Solid::face(corner, side * Vector3::x(), (end + 0.2) * Vector3::z());
        self.put_background(&floor, &at(yaw(0.0), Vector3::new(0.0, below, 0.0)), chance);
    }

    fn put_background(&mut self, solid: &Solid, placement: &Similarity, chance: &mut Chance) {
        let albedo = if chance.uniform() < 0.4 {
            Albedo::plain(placement, chance)
        } else {
            Albedo::random(0.8, placement, chance)
        };
        self.put(solid, placement, albedo);
    }
}

/// A body whose largest side is `size`, and half its height.
fn body(size: f64, chance: &mut Chance) -> (Solid, f64) {
    let [a, b] = [0; 2].map(|_| chance.between([0.5, 1.0]));
    let half = 0.5 * size;
    match chance.below(7) {
        0 => (Solid::cuboid(size * Vector3::new(a, b, 1.0)), half * b),
        1 => {
            let radius = half * chance.between([0.4, 0.8]);
            let cap = |y: f64| move |v: f64| [radius * v, y];
            let can = Solid::revolved(&[&cap(-half), &|v| [radius, size * (v - 0.5)], &cap(half)], [64, 16]);
            (can, half)
        }
        2 => {
            let [first, second] = [0; 2].map(|_| chance.between([0.03, 0.1]));
            let phase = chance.between([0.0, 6.0]);
            let ball = Solid::net([80, 40], |[u, v]| {
                let [(sin, cos), (up, out)] = [(2.0 * PI * u).sin_cos(), (PI * v).sin_cos()];
                let direction = Vector3::new(up * cos, -out, up * sin);
                let [x, y, z] = direction.into();
                let bumps = first * (4.0 * x + phase).sin() * (5.0 * y).cos() + second * (6.0 * z - 3.0 * x).sin() * up;
                half / 1.15 * (1.0 + bumps) * direction
            });
            (ball, half / 1.15)
        }
        3 => {
            let [waist, phase] = [chance.between([0.2, 0.45]), chance.between([-1.0, 2.0])];
            let outline = move |v: f64| {
                let radius = 0.55 * half * (1.0 + waist * (4.5 * v + phase).sin());
                [radius, size * (v - 0.5)]
            };
            let [foot, lip] = [outline(0.0), outline(1.0)];
            let vase = Solid::revolved(
                &[&outline, &move |v| [foot[0] * v, foot[1]], &move |v| [lip[0] * v, lip[1]]],
                [64, 40],
            );
            (vase, half)
        }
        4 => (icosahedron().stretched(half * Vector3::new(a, b, 1.0)), half * b),
        5 => {
            let corners = 3 + chance.below(4);
            (prism(corners).stretched(Vector3::new(half * a, size * b, half * a)), half * b)
        }
        _ => {
            let thickness = chance.between([0.3, 0.6]);
            let ring = torus(thickness).stretched(Vector3::repeat(half / (1.0 + 0.5 * thickness)));
            (ring, half * 0.5 * thickness / (1.0 + 0.5 * thickness))
        }
    }
}

/// Three to six bodies, floating or standing on a table, in front of a wall.
fn objects(chance: &mut Chance) -> Layout {
    let mut stage = Stage::default();
    let table = (chance.uniform() < 0.5).then(|| chance.between([0.25, 0.4]));
    let mut placed: Vec<(Vector3<f64>, f64)> = Vec::new();
    let count = 3 + chance.below(4);
    for _ in 0..ATTEMPTS {
        if placed.len() == count {
            break;
        }
        let size = chance.between(OBJECT_SIZE);
        let z = chance.between(OBJECT_DISTANCE);
        let [x, y] = [0.4, 0.27].map(|share| z * chance.between([-share, share]));
        let (solid, half_height) = body(size, chance);
        let turn = if table.is_some() { yaw(chance.between([0.0, 2.0 * PI])) } else { any_turn(chance) };
        let place = Vector3::new(x, table.map_or(y, |below| below - half_height), z);
        if placed.iter().any(|(other, radius)| (other - place).norm() < radius + 0.55 * size) {
            continue;
        }
        stage.put_patterned(&solid, size, &at(turn, place), chance);
        placed.push((place, 0.55 * size));
    }
    let farthest = placed.iter().map(|(place, radius)| place.z + radius).fold(0.0, f64::max);
    let angle = chance.between([-0.35, 0.35]);
    // The wall is nearer on one side, within the lateral reach of the objects.
    let distance = farthest + chance.between(BACKGROUND) + ASIDE * angle.abs().tan();
    stage.put_wall(distance, angle, chance);
    let pitch = match table {
        Some(below) => {
            stage.put_floor(below, distance + 1.5, chance);
            (below / 1.1).atan() + chance.between([-0.05, 0.05])
        }
        None => chance.between([-0.15, 0.15]),
    };
    let target = placed.iter().map(|(place, _)| place).sum::<Vector3<f64>>() / placed.len().max(1) as f64;
    Layout { stage, view: view(pitch, chance), target }
}

/// A crumpled sheet or a draped cloth in front of a wall.
fn crumpled(chance: &mut Chance) -> Layout {
    let mut stage = Stage::default();
    let sides = [chance.between([0.4, 0.7]), chance.between([0.35, 0.6])];
    let distance = chance.between([0.65, 1.1]);
    let solid = sheet(sides, chance);
    let turn = Rotation3::from_euler_angles(
        chance.between([-0.4, 0.4]),
        chance.between([-0.5, 0.5]),
        chance.between([-0.4, 0.4]),
    );
    let target = Vector3::new(chance.between([-0.1, 0.1]), chance.between([-0.06, 0.06]), distance);
    let placement = at(turn, target);
    // Users are advised to choose a sheet of one colour; some sheets are printed nevertheless.
    let albedo = if chance.uniform() < 0.6 {
        Albedo::plain(&placement, chance)
    } else {
        Albedo::random(0.4, &placement, chance)
    };
    stage.put(&solid, &placement, albedo);
    let angle = chance.between([-0.35, 0.35]);
    let farthest = stage.points.iter().map(|point| point.z).fold(0.0, f64::max);
    stage.put_wall(farthest + chance.between(BACKGROUND) + ASIDE * angle.abs().tan(), angle, chance);
    Layout { stage, view: view(chance.between([-0.1, 0.1]), chance), target }
}

/// Boxes on a table, some on top of others, in a room.
fn boxes(chance: &mut Chance) -> Layout {
    let mut stage = Stage::default();
    let pitch = chance.between([0.5, 0.85]);
    let distance = chance.between([0.8, 1.1]);
    let [below, ahead] = [distance * pitch.sin(), distance * pitch.cos()];
    let slab = Vector3::new(chance.between([1.0, 1.4]), 0.04, chance.between([0.7, 0.9]));
    let table = at(yaw(chance.between([-0.3, 0.3])), Vector3::new(0.0, below + 0.5 * slab.y, ahead + 0.1));
    stage.put_background(&Solid::cuboid(slab), &table, chance);
    stage.put_floor(below + 0.7, ahead + 2.0, chance);
    stage.put_wall(ahead + chance.between([0.8, 1.6]), chance.between([-0.3, 0.3]), chance);
    // Position on the table, radius, and height of the top.
    let mut piled: Vec<([f64; 2], f64, f64)> = Vec::new();
    for _ in 0..6 + chance.below(6) {
        let sides =
            Vector3::new(chance.between([0.08, 0.28]), chance.between([0.05, 0.2]), chance.between([0.06, 0.2]));
        let place = [chance.between([-0.32, 0.32]), ahead + chance.between([-0.2, 0.28])];
        let radius = 0.4 * sides.x.hypot(sides.z);
        let under = piled.iter().filter(|([x, z], r, _)| (x - place[0]).hypot(z - place[1]) < r + radius);
        let base = under.map(|(_, _, top)| *top).fold(0.0, f64::max);
        let middle = Vector3::new(place[0], below - base - 0.5 * sides.y, place[1]);
        let placement = at(yaw(chance.between([0.0, PI])), middle);
        stage.put_patterned(&Solid::cuboid(sides), sides.max(), &placement, chance);
        piled.push((place, radius, base + sides.y));
    }
    Layout { stage, view: view(pitch, chance), target: Vector3::new(0.0, below - 0.1, ahead) }
}

/// Floor, walls, and furniture 1.5 to 4 metres away.
fn room(chance: &mut Chance) -> Layout {
    let mut stage = Stage::default();
    let below = chance.between([1.1, 1.4]);
    let turn = yaw(chance.between([-0.5, 0.5]));
    let end = chance.between([3.2, 4.0]);
    let half = chance.between([1.6, 2.4]);
    let ceiling = below - 2.6;
    let (across, up, along) = (2.0 * half * Vector3::x(), 2.6 * Vector3::y(), 6.0 * Vector3::z());
    let [left, right] = [-half, half].map(|x| Vector3::new(x, ceiling, end - 6.0));
    let back = Vector3::new(-half, ceiling, end);
    let floor = Vector3::new(-half, below, end - 6.0);
    let placement = at(turn, Vector3::zeros());
    for (corner, a, b) in [(back, across, up), (left, along, up), (right, along, up), (floor, across, along)] {
        stage.put_background(&Solid::face(corner, a, b), &placement, chance);
    }
    stage.put(&Solid::face(left, across, along), &placement, Albedo::plain(&placement, chance));
    for _ in 0..5 + chance.below(5) {
        let sides = Vector3::new(chance.between([0.3, 1.1]), chance.between([0.35, 1.7]), chance.between([0.3, 0.6]));
        let z = chance.between([1.6, end - 0.2]);
        // Low things stand in front of high ones.
        let sides = if z < 2.3 { Vector3::new(sides.x, 0.5 * sides.y, sides.z) } else { sides };
        let place = Vector3::new(chance.between([-0.6, 0.6]) * z.min(half / 0.6), below - 0.5 * sides.y, z);
        let own = yaw(if chance.uniform() < 0.6 { 0.0 } else { chance.between([-0.8, 0.8]) });
        let put = |place: Vector3<f64>, own: Rotation3<f64>| at(turn * own, turn * place);
        stage.put_patterned(&Solid::cuboid(sides), sides.max(), &put(place, own), chance);
        let size = chance.between([0.15, 0.35]);
        let (thing, half_height) = body(size, chance);
        let top = Vector3::new(place.x, below - sides.y - half_height, place.z);
        stage.put_patterned(&thing, size, &put(top, yaw(chance.between([0.0, PI]))), chance);
    }
    Layout { stage, view: view(chance.between([0.1, 0.35]), chance), target: Vector3::new(0.0, 0.5, 2.5) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Smallest distance along z between the things in front of the wall and the wall, and the number of things.
    fn clearance(stage: &Stage) -> (f64, usize) {
        let corners = |albedo: usize| {
            let own = stage.triangles.iter().filter(move |triangle| triangle.albedo as usize == albedo);
            own.flat_map(|triangle| triangle.corners).map(|corner| corner as usize)
        };
        let reaches = |albedo: usize, axis: usize| corners(albedo).any(|corner| stage.points[corner][axis] < -2.5);
        let wall = (0..stage.albedos.len()).find(|&albedo| reaches(albedo, 1)).expect("a wall");
        let first = corners(wall).next().expect("a corner");
        let (point, normal) = (stage.points[first], stage.normals[first]);
        let things: Vec<usize> = (0..stage.albedos.len()).filter(|&albedo| !reaches(albedo, 0)).collect();
        let gap = |corner: usize| normal.dot(&(point - stage.points[corner])) / normal.z;
        let least = things.iter().flat_map(|&albedo| corners(albedo)).map(gap).fold(f64::INFINITY, f64::min);
        (least, things.len())
    }

    #[test]
    fn things_stand_off_the_wall() {
        for seed in 0..40 {
            let (gap, things) = clearance(&objects(&mut Chance::of_stream(seed, 0)).stage);
            assert!(gap >= BACKGROUND[0] && (3..=6).contains(&things), "{seed}: {gap} {things}");
            let (gap, things) = clearance(&crumpled(&mut Chance::of_stream(seed, 0)).stage);
            assert!(gap >= BACKGROUND[0] && things == 1, "{seed}: {gap} {things}");
        }
    }
}
