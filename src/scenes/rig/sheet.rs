//! A crumpled sheet of paper, and a cloth that hangs in folds.

use nalgebra::{Vector2, Vector3};

use super::solids::Solid;
use crate::scenes::flaws::Chance;

/// Number of cells along the longer side, each 4 mm on a sheet of 0.8 m.
const CELLS: usize = 192;
/// Range of the number of long creases of crumpled paper, and the largest bend at a crease in radians.
const CREASES: [f64; 2] = [4.0, 10.0];
const BEND: f64 = 0.5;
/// Facets between the short creases: range of their size in metres, and of the largest height of their corners relative
/// to it.
const FACET: [f64; 2] = [0.05, 0.11];
const STEEPNESS: [f64; 2] = [0.15, 0.35];
/// Number of corners along a side of the repeating lattice.
const CORNERS: usize = 32;
/// Range of the number of folds of a cloth, and their largest depth in metres.
const FOLDS: [f64; 2] = [5.0, 10.0];
const FOLD_DEPTH: f64 = 0.05;
/// Largest depth of both kinds, metres; a larger one would reach the background.
const DEPTH: f64 = 0.16;

/// A sheet of these sides in metres (width, height), about the plane z = 0.
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

/// Flat facets between short creases, added to long creases: a sum of bends a |n.p - c|, mountains and valleys.
fn crumpled(sides: [f64; 2], chance: &mut Chance) -> impl Fn(Vector2<f64>) -> f64 + use<> {
    let reach = 0.5 * sides[0].hypot(sides[1]);
    let facets = [1.0, 0.45].map(|share| facets(share * chance.between(FACET), chance));
    let creases: Vec<(Vector2<f64>, f64, f64)> = (0..chance.between(CREASES) as usize)
        .map(|_| {
            let (sin, cos) = chance.between([0.0, std::f64::consts::PI]).sin_cos();
            (Vector2::new(cos, sin), chance.between([-reach, reach]), 0.5 * chance.between([-BEND, BEND]))
        })
        .collect();
    move |place| {
        let long: f64 = creases.iter().map(|(normal, offset, bend)| bend * (normal.dot(&place) - offset).abs()).sum();
        long + facets.iter().map(|facets| facets(place)).sum::<f64>()
    }
}

/// Triangles between the corners of a rotated and bent lattice with random heights.
fn facets(cell: f64, chance: &mut Chance) -> impl Fn(Vector2<f64>) -> f64 + use<> {
    let (sin, cos) = chance.between([0.0, 1.5]).sin_cos();
    let phase = chance.between([0.0, 6.0]);
    let steepness = cell * chance.between(STEEPNESS);
    let heights: Vec<f64> = (0..CORNERS * CORNERS).map(|_| chance.between([-steepness, steepness])).collect();
    move |place| {
        let [x, y] = [(cos * place.x + sin * place.y) / cell, (cos * place.y - sin * place.x) / cell];
        let [x, y] = [x + 0.35 * (1.7 * y + phase).sin(), y + 0.35 * (1.3 * x - phase).sin()];
        let [column, row] = [x.floor(), y.floor()];
        let [u, v] = [x - column, y - row];
        let corner = |right: i64, down: i64| {
            let at = |part: f64, by: i64| (part as i64 + by).rem_euclid(CORNERS as i64) as usize;
            heights[CORNERS * at(row, down) + at(column, right)]
        };
        let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
        if (column as i64 + row as i64) & 1 == 0 {
            if u > v { a + u * (b - a) + v * (d - b) } else { a + v * (c - a) + u * (d - c) }
        } else if u + v < 1.0 {
            a + u * (b - a) + v * (c - a)
        } else {
            d + (1.0 - u) * (c - d) + (1.0 - v) * (b - d)
        }
    }
}

/// Round folds that run mostly downwards and widen on their way.
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
