//! Connected components of the pixels that edges join, and the level of components without anchors.
//!
//! Method: union-find over the edges in raster order, with the smallest index as root, so that a further ascending pass
//! turns parents into labels. Nearly linear in the number of pixels.

use super::terms::Edges;

/// Labels and sums of the components; memory for the worst case (pairs of pixels) is allocated once.
pub struct Components {
    /// Parents while joining, labels afterwards; a pixel without edges is a component by itself and gets [`ALONE`].
    labels: Vec<u32>,
    count: usize,
    sums: Vec<f64>,
    pixels: Vec<u32>,
    anchored: Vec<bool>,
}

/// Label of a pixel that no edge touches.
const ALONE: u32 = u32::MAX;

impl Components {
    pub fn new(length: usize) -> Self {
        // A component has at least two pixels.
        let most = length / 2 + 1;
        Self {
            labels: vec![ALONE; length],
            count: 0,
            sums: vec![0.0; most],
            pixels: vec![0; most],
            anchored: vec![false; most],
        }
    }

    /// Number of components with at least one edge.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Whether the pixel has an edge.
    pub fn is_joined(&self, index: usize) -> bool {
        self.labels[index] != ALONE
    }

    /// Labels the pixels of a raster of `width` columns, joined by the edges of positive weight.
    pub fn label(&mut self, width: usize, right: &Edges, down: &Edges) {
        for (index, parent) in self.labels.iter_mut().enumerate() {
            *parent = index as u32;
        }
        for index in 0..self.labels.len() {
            if right.weight[index] > 0.0 {
                self.join(index, index + 1);
            }
            if down.weight[index] > 0.0 {
                self.join(index, index + width);
            }
        }
        self.count = 0;
        for index in 0..self.labels.len() {
            let parent = self.labels[index] as usize;
            // Parents come first in raster order, so the parent's entry is already a label.
            self.labels[index] = if parent != index {
                self.labels[parent]
            } else if right.weight[index] > 0.0 || down.weight[index] > 0.0 {
                // This is the first pixel of its component, which has no edges from the left or from above.
                self.count += 1;
                self.count as u32 - 1
            } else {
                ALONE
            };
        }
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.labels[a.max(b)] = a.min(b) as u32;
    }

    fn root(&mut self, mut index: usize) -> usize {
        // The loop terminates, because a parent is never larger than its child.
        while self.labels[index] as usize != index {
            let parent = self.labels[index] as usize;
            self.labels[index] = self.labels[parent];
            index = parent;
        }
        index
    }

    /// Subtracts the mean from each component without an anchor of positive weight.
    pub fn level(&mut self, z: &mut [f32], anchor_weight: &[f32]) {
        let count = self.count;
        self.sums[..count].fill(0.0);
        self.pixels[..count].fill(0);
        self.anchored[..count].fill(false);
        for ((&label, &z), &weight) in self.labels.iter().zip(&*z).zip(anchor_weight) {
            if label != ALONE {
                let label = label as usize;
                self.sums[label] += f64::from(z);
                self.pixels[label] += 1;
                self.anchored[label] |= weight > 0.0;
            }
        }
        for (&label, z) in self.labels.iter().zip(z) {
            if label != ALONE && !self.anchored[label as usize] {
                let label = label as usize;
                *z = (f64::from(*z) - self.sums[label] / f64::from(self.pixels[label])) as f32;
            }
        }
    }
}
