//! Nearest points of a surface, by kiddo's k-d tree.

use kiddo::{ImmutableKdTree, SquaredEuclidean};

use crate::view::Points;

/// Largest coordinate. The squared distances of larger ones overflow f32, so such points count as missing.
const LARGEST_COORDINATE: f32 = 1e15;

/// The points of one surface in a tree. Missing points never enter it, and a missing query has no neighbour.
///
/// The immutable tree takes any number of identical points; the mutable one panics beyond 32. NaN makes either panic.
#[derive(Default)]
pub(super) struct Neighbours {
    tree: Option<ImmutableKdTree<f32, 3>>,
    /// The points in the tree; kept so that the next build need not allocate.
    points: Vec<[f32; 3]>,
    /// The index of every point of the tree in the caller's order.
    original: Vec<u32>,
}

/// The nearest point to a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Neighbour {
    /// Index among the given points, including missing ones.
    pub index: usize,
    /// Distance in the points' unit.
    pub distance: f32,
}

impl Neighbours {
    /// Replaces the points by those of `points` that are not missing and for which `accept(index)` holds. Keeps all
    /// equal points; a query may return any of them.
    pub fn rebuild(&mut self, points: &Points, accept: impl Fn(usize) -> bool) {
        // Free the old tree before the new one takes memory.
        self.tree = None;
        self.points.clear();
        self.original.clear();
        for index in 0..points.len() {
            let point = points.get(index);
            if is_present(&point) && accept(index) {
                self.points.push(point);
                self.original.push(index as u32);
            }
        }
        // kiddo refuses more than 2^32 points; the largest view has 2^24.
        self.tree = if self.points.is_empty() { None } else { ImmutableKdTree::new_from_slice(&self.points).ok() };
    }

    /// Number of points held.
    #[must_use]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// The point nearest to `query` within `distance`; `None` also if the query is missing.
    #[must_use]
    pub fn nearest(&self, query: [f32; 3], distance: f32) -> Option<Neighbour> {
        let tree = self.tree.as_ref().filter(|_| is_present(&query))?;
        let found = tree.query(&query).nearest_one::<SquaredEuclidean<f32>>().execute();
        let index = *self.original.get(found.item as usize)? as usize;
        let neighbour = Neighbour { index, distance: found.distance.sqrt() };
        (neighbour.distance <= distance).then_some(neighbour)
    }
}

fn is_present(point: &[f32; 3]) -> bool {
    // This comparison also rejects NaN.
    point.iter().all(|value| value.abs() < LARGEST_COORDINATE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(vectors: impl IntoIterator<Item = [f32; 3]>) -> Points {
        let vectors: Vec<_> = vectors.into_iter().collect();
        let component = |axis: usize| vectors.iter().map(|vector| vector[axis]).collect();
        Points { x: component(0), y: component(1), z: component(2) }
    }

    #[test]
    fn missing_points_keep_their_number_and_are_never_found() {
        let mut neighbours = Neighbours::default();
        let given = points([[f32::NAN, 0.0, 0.0], [1.0, 0.0, 0.0], [f32::INFINITY; 3], [5.0, 0.0, 0.0]]);
        neighbours.rebuild(&given, |_| true);
        assert_eq!(neighbours.len(), 2);
        assert_eq!(neighbours.nearest([4.0, 0.0, 0.0], 2.0), Some(Neighbour { index: 3, distance: 1.0 }));
        assert_eq!(neighbours.nearest([3.0, 0.0, 0.0], 1.0), None);
        assert_eq!(neighbours.nearest([f32::NAN, 0.0, 0.0], 9.0), None);
        neighbours.rebuild(&given, |index| index != 3);
        assert_eq!(neighbours.nearest([4.0, 0.0, 0.0], 9.0).map(|found| found.index), Some(1));
    }

    #[test]
    fn a_thousand_equal_points_and_none_at_all() {
        let mut neighbours = Neighbours::default();
        assert_eq!(neighbours.nearest([0.0; 3], 1.0), None);
        neighbours.rebuild(&points([[1.0, 2.0, 3.0]; 1000]), |_| true);
        assert_eq!(neighbours.nearest([1.0, 2.0, 3.0], 0.0).map(|found| found.distance), Some(0.0));
        neighbours.rebuild(&points([]), |_| true);
        assert_eq!(neighbours.len(), 0);
        assert_eq!(neighbours.nearest([1.0, 2.0, 3.0], 1.0), None);
    }

    #[test]
    fn agrees_with_looking_at_every_point() {
        let point = |k: usize| [(k * 37 % 101) as f32, (k * 53 % 97) as f32, (k * 71 % 89) as f32];
        let mut neighbours = Neighbours::default();
        neighbours.rebuild(&points((0..500).map(point)), |_| true);
        for query in (0..200).map(|k| point(k * 7 + 3).map(|value| value + 0.4)) {
            let distance = |k: usize| (0..3).map(|axis| (point(k)[axis] - query[axis]).powi(2)).sum::<f32>().sqrt();
            let least = (0..500).map(distance).fold(f32::MAX, f32::min);
            let found = neighbours.nearest(query, f32::MAX).expect("the tree is not empty");
            assert!((found.distance - least).abs() < 1e-3);
        }
    }
}
