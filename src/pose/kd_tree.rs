//! The nearest of many points, by a k-d tree (Friedman, Bentley and Finkel 1977): cells are halved across their longest
//! side until few points are left in each.

use crate::numeric::quantile;

/// Points of a leaf, at most; with 4 or 32 a search takes longer.
const LEAF: usize = 12;
/// The axis of a leaf.
const NO_AXIS: u32 = 3;

/// Inner nodes are followed by all of their lower side.
struct Node {
    /// Which coordinate is compared with `split`.
    axis: u32,
    split: f32,
    /// Of an inner node where the upper side starts, of a leaf its points.
    range: [u32; 2],
}

/// Points in the order of their leaves, each with its number.
#[derive(Default)]
pub(super) struct KdTree {
    points: Vec<([f32; 3], u32)>,
    nodes: Vec<Node>,
    /// Coordinates of a cell, for their median.
    scratch: Vec<f32>,
}

impl KdTree {
    /// Forgets the points it held and takes others, of finite coordinates.
    pub fn rebuild(&mut self, points: impl Iterator<Item = ([f32; 3], u32)>) {
        self.points.clear();
        self.nodes.clear();
        self.points.extend(points);
        self.divide(0, self.points.len());
    }

    pub fn len(&self) -> usize {
        self.points.len()
    }

    fn divide(&mut self, start: usize, end: usize) {
        let points = &mut self.points[start..end];
        let mut sides = [[f32::INFINITY, f32::NEG_INFINITY]; 3];
        for (point, _) in points.iter() {
            for ([least, most], &value) in sides.iter_mut().zip(point) {
                (*least, *most) = (least.min(value), most.max(value));
            }
        }
        let longest = |a: usize, b: usize| if sides[b][1] - sides[b][0] > sides[a][1] - sides[a][0] { b } else { a };
        let axis = longest(longest(0, 1), 2);
        let here = self.nodes.len();
        // Equal points can't be told apart.
        if points.len() <= LEAF || sides[axis][0] == sides[axis][1] {
            self.nodes.push(Node { axis: NO_AXIS, split: 0.0, range: [start as u32, end as u32] });
            return;
        }
        self.scratch.clear();
        self.scratch.extend(points.iter().map(|(point, _)| point[axis]));
        // Both sides hold a point: the lower one the least coordinate, the upper one the largest.
        let median = quantile(&mut self.scratch, 0.5);
        let split = if median > sides[axis][0] { median } else { median.next_up() };
        let mut lower = 0;
        for k in 0..points.len() {
            if points[k].0[axis] < split {
                points.swap(lower, k);
                lower += 1;
            }
        }
        let middle = start + lower;
        self.nodes.push(Node { axis: axis as u32, split, range: [0; 2] });
        self.divide(start, middle);
        self.nodes[here].range[0] = self.nodes.len() as u32;
        self.divide(middle, end);
    }

    /// Number and squared distance of the nearest point to `query` whose squared distance is below `most`.
    pub fn nearest(&self, query: [f32; 3], most: f32) -> Option<(u32, f32)> {
        let mut best = (u32::MAX, most);
        if !self.points.is_empty() {
            self.search(0, query, [0.0; 3], &mut best);
        }
        (best.1 < most).then_some(best)
    }

    /// Searches a cell that is `offsets` away from the query along each axis.
    fn search(&self, node: u32, query: [f32; 3], offsets: [f32; 3], best: &mut (u32, f32)) {
        let Node { axis, split, range } = self.nodes[node as usize];
        if axis == NO_AXIS {
            for (point, number) in &self.points[range[0] as usize..range[1] as usize] {
                let squared = squared([query[0] - point[0], query[1] - point[1], query[2] - point[2]]);
                if squared < best.1 {
                    *best = (*number, squared);
                }
            }
            return;
        }
        let offset = query[axis as usize] - split;
        let [near, far] = if offset < 0.0 { [node + 1, range[0]] } else { [range[0], node + 1] };
        self.search(near, query, offsets, best);
        let mut offsets = offsets;
        offsets[axis as usize] = offset;
        if squared(offsets) < best.1 {
            self.search(far, query, offsets, best);
        }
    }
}

/// Sums in one order everywhere: a cell is then never farther than its points, not even by rounding.
fn squared([x, y, z]: [f32; 3]) -> f32 {
    x * x + y * y + z * z
}
