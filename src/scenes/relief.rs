//! A height map from which a scene is made.

use crate::error::{Error, ErrorKind, Result};
use crate::text::Brief;
use crate::view::Size;

/// Smallest side of a relief in samples; a coarser mesh would show its triangles.
pub const SMALLEST_RELIEF: usize = 64;
/// Largest side of a relief in samples: half a million triangles, the most that a page renders without a wait.
pub const LARGEST_RELIEF: usize = 512;
/// Largest height in samples, eight times the largest side. It is far beyond any relief, and exact in f32.
const LARGEST_HEIGHT: f32 = 4096.0;

/// Side of the grid, in samples, for which the thresholds of the protocol (docs/lab/protocols.md) are stated.
const PROTOCOL_SIDE: f64 = 256.0;
/// Height above which a sample of a 256 grid belongs to the object, in samples (docs/lab/protocols.md), because the
/// scanned bust has a skirt of small values around it. On other grids it scales with the side.
const PROTOCOL_FLOOR: f64 = 5.0;

/// Heights over a grid. Larger is nearer; NaN, zero and everything up to [`floor`](Relief::floor) is background. The
/// unit of a height is the distance between neighbouring samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Relief {
    size: Size,
    heights: Vec<f32>,
}

impl Relief {
    /// A relief of `width * height` row-major heights.
    ///
    /// # Errors
    /// [`ErrorKind::Size`] if a side lies outside 64 .. 512 or the number of heights is wrong, [`ErrorKind::Range`] if
    /// a height is infinite or its magnitude exceeds 4096, [`ErrorKind::Empty`] if none belongs to the object.
    pub fn new(width: usize, height: usize, heights: Vec<f32>) -> Result<Self> {
        let sides = SMALLEST_RELIEF..=LARGEST_RELIEF;
        if !sides.contains(&width) || !sides.contains(&height) {
            let message =
                format!("sides must lie within {SMALLEST_RELIEF} .. {LARGEST_RELIEF} samples, not {width}x{height}");
            return Err(Error::new(ErrorKind::Size, "surface", message));
        }
        let size = Size { width, height };
        if heights.len() != size.len() {
            let message = format!("{width}x{height} samples need {} heights, not {}", size.len(), heights.len());
            return Err(Error::new(ErrorKind::Size, "surface.heights", message));
        }
        if let Some(index) = heights.iter().position(|height| height.abs() > LARGEST_HEIGHT) {
            return Err(Error::new(ErrorKind::Range, "surface.heights", "must be at most 4096 samples")
                .at(index)
                .value(f64::from(heights[index])));
        }
        let relief = Self { size, heights };
        if relief.object().any(|inside| inside) {
            return Ok(relief);
        }
        let message = format!("no height lies above the background, {} samples", Brief(relief.floor()));
        Err(Error::new(ErrorKind::Empty, "surface.heights", message))
    }

    /// The height at every sample centre of a `side` x `side` grid; `height_at` takes x (right) and y (down) from the
    /// centre of the grid in samples.
    pub(super) fn from_function(side: usize, height_at: impl Fn(f64, f64) -> f64) -> Self {
        let size = Size { width: side, height: side };
        let centre = (side as f64 - 1.0) / 2.0;
        let heights = (0..size.len())
            .map(|index| {
                let (column, row) = size.position(index);
                height_at(column as f64 - centre, row as f64 - centre).max(0.0) as f32
            })
            .collect();
        Self { size, heights }
    }

    /// Size of the grid in samples.
    #[must_use]
    pub const fn size(&self) -> Size {
        self.size
    }

    /// Row-major heights in samples.
    #[must_use]
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// Height in samples above which a sample belongs to the object: 5 on a 256 grid, proportional on others.
    #[must_use]
    pub fn floor(&self) -> f64 {
        PROTOCOL_FLOOR * self.size.width.max(self.size.height) as f64 / PROTOCOL_SIDE
    }

    /// For each sample, whether it belongs to the object.
    pub(super) fn object(&self) -> impl Iterator<Item = bool> {
        let floor = self.floor();
        self.heights.iter().map(move |&height| f64::from(height) > floor)
    }
}
