//! Rasters: their size, and fields of vectors over them as structure-of-arrays.

use crate::error::{Error, ErrorKind, Result};

/// Smallest side of a view: below it neither a normal nor a light is determined.
pub const SMALLEST_SIDE: usize = 4;
/// Largest side of a view: the buffers of two such views still fit a 32-bit memory.
pub const LARGEST_SIDE: usize = 4096;

/// Width and height of a raster in pixels; row-major, pixel (0, 0) top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl Size {
    /// A size within 4x4 .. 4096x4096.
    ///
    /// # Errors
    /// [`ErrorKind::Size`] naming `field` otherwise.
    pub fn new(field: &'static str, width: usize, height: usize) -> Result<Self> {
        for side in [width, height] {
            if !(SMALLEST_SIDE..=LARGEST_SIDE).contains(&side) {
                return Err(Error::new(
                    ErrorKind::Size,
                    field,
                    format!("sides must lie within {SMALLEST_SIDE} .. {LARGEST_SIDE} pixels, not {width}x{height}"),
                ));
            }
        }
        Ok(Self { width, height })
    }

    /// Number of pixels.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a size is never empty")]
    pub const fn len(self) -> usize {
        self.width * self.height
    }

    /// Index of the pixel at `column`, `row`.
    #[must_use]
    pub const fn index(self, column: usize, row: usize) -> usize {
        row * self.width + column
    }

    /// Column and row of the pixel at `index`.
    #[must_use]
    pub const fn position(self, index: usize) -> (usize, usize) {
        (index % self.width, index / self.width)
    }
}

/// Unit normals over a raster, NaN where there is none. They face the camera: z < 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Normals {
    /// x components (right).
    pub x: Vec<f32>,
    /// y components (down).
    pub y: Vec<f32>,
    /// z components (forward).
    pub z: Vec<f32>,
}

/// Points over a raster, NaN where there is none.
pub type Points = Normals;

impl Normals {
    /// `length` missing vectors.
    #[must_use]
    pub fn missing(length: usize) -> Self {
        Self { x: vec![f32::NAN; length], y: vec![f32::NAN; length], z: vec![f32::NAN; length] }
    }

    /// Number of vectors.
    #[must_use]
    pub fn len(&self) -> usize {
        self.z.len()
    }

    /// Whether there is no vector at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.z.is_empty()
    }

    /// The vector at `index`, NaN where missing.
    #[must_use]
    pub fn get(&self, index: usize) -> [f32; 3] {
        [self.x[index], self.y[index], self.z[index]]
    }

    /// Replaces the vector at `index`.
    pub fn set(&mut self, index: usize, vector: [f32; 3]) {
        [self.x[index], self.y[index], self.z[index]] = vector;
    }

    /// Whether there is a vector at `index`.
    #[must_use]
    pub fn is_valid(&self, index: usize) -> bool {
        !self.z[index].is_nan()
    }

    /// The vectors interleaved: x, y, z, x, y, z, ...
    #[must_use]
    pub fn interleaved(&self) -> Vec<f32> {
        (0..self.len()).flat_map(|index| self.get(index)).collect()
    }
}
