//! A crumpled sheet of paper, and a cloth that hangs in folds.

use nalgebra::{Vector2, Vector3};

use super::solids::Solid;
use crate::scenes::flaws::Chance;

/// Cells along the longer side: 4 mm of a sheet of 0.8 m.
const CELLS: usize = 192;
/// Creases of crumpled paper, at least and at most.
const CREASES: [f64; 2] = [16.0, 32.0];
/// Bend at a crease, radians at most.
const BEND: f64 = 1.2;
/// Folds of a cloth, at least and at most, and their depth in metres at most.
const FOLDS: [f64; 2] = [5.0, 10.0];
const FOLD_DEPTH: f64 = 0.05;
/// Depth of either in metres at most: more would reach the background.
const DEPTH: f64 = 0.16;

/// A sheet of that width and height in metres, about the plane z = 0.
pub fn sheet(sides: [f64; 2], chance: &mut Chance) -> Solid {
    let height: Box<dyn Fn(Vector2<f64>) -> f64> =
        if chance.uniform() < 0.5 { Box::new(crumpled(sides, chance)) } else { Box::new(draped(sides, chance)) };
    let longest = sides[0].max(sides[1]);
    let cells = sides.map(|side| (CELLS as f64 * side / longest).ceil() as usize);
    let at = |[u, v]: [f64; 2]| Vector2::new((u - 0.5) * sides[0], (v - 0.5) * sides[1]);
    let mut solid = Solid::net(cells, |uv| {
        let place = at(uv);
        Vector3::new(place.x, place.y, height(place))
    });
    let [low, high] = solid
        .points
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| [low.min(point.z), high.max(point.z)]);
    let shrink = (DEPTH / (high - low).max(f64::MIN_POSITIVE)).min(1.0);
    let middle = 0.5 * (low + high);
    solid.points.iter_mut().for_each(|point| point.z -= middle);
    solid.stretched(Vector3::new(1.0, 1.0, shrink))
}

/// Facets between straight creases: the sum of bends a |n.p - c|, mountains and valleys.
fn crumpled(sides: [f64; 2], chance: &mut Chance) -> impl Fn(Vector2<f64>) -> f64 + use<> {
    let reach = 0.5 * sides[0].hypot(sides[1]);
    let creases: Vec<(Vector2<f64>, f64, f64)> = (0..chance.between(CREASES) as usize)
        .map(|_| {
            let (sin, cos) = chance.between([0.0, std::f64::consts::PI]).sin_cos();
            (Vector2::new(cos, sin), chance.between([-reach, reach]), 0.5 * chance.between([-BEND, BEND]))
        })
        .collect();
    move |place| creases.iter().map(|(normal, offset, bend)| bend * (normal.dot(&place) - offset).abs()).sum()
}

/// Round folds that run mostly downwards and open on their way.
fn draped(sides: [f64; 2], chance: &mut Chance) -> impl Fn(Vector2<f64>) -> f64 + use<> {
    let folds: Vec<[f64; 5]> = (0..chance.between(FOLDS) as usize)
        .map(|_| {
            [
                chance.between([-0.5 * sides[0], 0.5 * sides[0]]),
                chance.between([-0.35, 0.35]),
                chance.between([0.02, 0.07]),
                chance.between([-FOLD_DEPTH, FOLD_DEPTH]),
                chance.between([0.3, 1.5]),
            ]
        })
        .collect();
    let top = 0.5 * sides[1];
    let tall = sides[1];
    move |place| {
        folds
            .iter()
            .map(|[column, lean, width, depth, opening]| {
                let down = (place.y + top) / tall;
                let width = width * (1.0 + opening * down);
                let off = (place.x - column - lean * place.y) / width;
                depth * (0.4 + 1.2 * down) * (-0.5 * off * off).exp()
            })
            .sum()
    }
}
