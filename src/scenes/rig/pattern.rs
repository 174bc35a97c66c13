//! Albedo of things: patterns in the space of the thing, which need no parametrisation of its surface.

use nalgebra::{Matrix3, Vector3};

use crate::pose::Similarity;
use crate::scenes::flaws::Chance;

/// Share of things without a pattern.
const PLAIN_SHARE: f64 = 0.35;
/// Range of albedos before one or two channels are lowered.
const ALBEDO: [f64; 2] = [0.12, 0.85];
/// Range of the finest detail of a pattern relative to the size of its thing.
const DETAIL: [f64; 2] = [0.08, 0.3];
/// Finest detail in metres: at least three pixels at a distance of one metre.
const FINEST: f64 = 0.012;
/// Number of octaves of the noise from which prints are cut.
const OCTAVES: usize = 3;

/// A pattern of albedos.
#[derive(Clone, Copy, Debug)]
pub enum Pattern {
    Plain,
    Checks,
    Stripes,
    Marble,
    Print,
}

/// The albedo of one thing.
#[derive(Clone, Debug)]
pub struct Albedo {
    pattern: Pattern,
    colours: [[f64; 3]; 3],
    /// Rotation from the world to the cells of the pattern.
    rotation: Matrix3<f64>,
    offset: Vector3<f64>,
    seed: u32,
}

impl Albedo {
    /// A random albedo for a thing of this size in metres, which `placement` puts into the world.
    pub fn random(size: f64, placement: &Similarity, chance: &mut Chance) -> Self {
        let pattern = if chance.uniform() < PLAIN_SHARE {
            Pattern::Plain
        } else {
            [Pattern::Checks, Pattern::Stripes, Pattern::Marble, Pattern::Print][chance.below(4)]
        };
        Self::with(pattern, size, placement, chance)
    }

    /// A single albedo.
    pub fn plain(placement: &Similarity, chance: &mut Chance) -> Self {
        Self::with(Pattern::Plain, 1.0, placement, chance)
    }

    /// An albedo with this pattern.
    pub fn with(pattern: Pattern, size: f64, placement: &Similarity, chance: &mut Chance) -> Self {
        let cell = (size * chance.between(DETAIL)).max(FINEST);
        // Patterns are aligned with their thing; the shift keeps its faces off the borders between cells.
        let shift = Vector3::from_fn(|_, _| chance.between([0.0, 64.0]) + 64.0);
        let rotation = placement.rotation.transpose() / cell;
        Self {
            pattern,
            colours: std::array::from_fn(|_| colour(chance)),
            rotation,
            offset: shift - rotation * placement.translation,
            seed: chance.below(1 << 30) as u32,
        }
    }

    /// Albedo of R, G, B at a point of the world.
    pub fn albedo(&self, point: Vector3<f64>) -> [f64; 3] {
        let at = || self.rotation * point + self.offset;
        match self.pattern {
            Pattern::Plain => self.colours[0],
            Pattern::Checks => {
                let [x, y, z] = at().map(|part| part.floor() as i64).into();
                self.colours[((x + y + z) & 1) as usize]
            }
            Pattern::Stripes => {
                let place = at();
                let across = place.x + 0.6 * place.y + 0.3 * place.z;
                self.colours[[0, 1, 0, 2][across.floor() as i64 as usize & 3]]
            }
            Pattern::Marble => {
                let share = (1.6 * (self.noise(at()) - 0.5) + 0.5).clamp(0.0, 1.0);
                std::array::from_fn(|k| self.colours[0][k] + share * (self.colours[1][k] - self.colours[0][k]))
            }
            Pattern::Print => {
                let level = self.noise(at());
                self.colours[if level < 0.45 { 0 } else { 1 + usize::from(level > 0.6) }]
            }
        }
    }

    /// Smoothly interpolated values of lattice points at three scales; 0 to 1.
    fn noise(&self, place: Vector3<f64>) -> f64 {
        let (mut sum, mut weight, mut scale) = (0.0, 1.0, 0.25);
        let mut weights = 0.0;
        for octave in 0..OCTAVES {
            sum += weight * lattice(place * scale, self.seed.wrapping_add(octave as u32));
            weights += weight;
            weight *= 0.5;
            scale *= 2.0;
        }
        sum / weights
    }
}

fn colour(chance: &mut Chance) -> [f64; 3] {
    let level = chance.between(ALBEDO);
    let tint = chance.between([0.0, 0.6]);
    let hue = chance.below(6);
    std::array::from_fn(|k| {
        let lowered = if hue < 3 { k == hue } else { k != hue - 3 };
        if lowered { level * (1.0 - tint) } else { level }
    })
}

/// Trilinear, smoothed value noise.
fn lattice(place: Vector3<f64>, seed: u32) -> f64 {
    let base = place.map(f64::floor);
    let share = (place - base).map(|t| t * t * (3.0 - 2.0 * t));
    let [x, y, z] = base.map(|part| part as i32 as u32).into();
    let corner = |dx, dy, dz| hash(x.wrapping_add(dx), y.wrapping_add(dy), z.wrapping_add(dz), seed);
    let mix = |a: f64, b: f64, t: f64| a + t * (b - a);
    let edge = |dy, dz| mix(corner(0, dy, dz), corner(1, dy, dz), share.x);
    mix(mix(edge(0, 0), edge(1, 0), share.y), mix(edge(0, 1), edge(1, 1), share.y), share.z)
}

/// A number from 0 to 1 for a lattice point, the same on every machine.
fn hash(x: u32, y: u32, z: u32, seed: u32) -> f64 {
    let mut h = seed ^ x.wrapping_mul(0x8da6_b343) ^ y.wrapping_mul(0xd816_3841) ^ z.wrapping_mul(0xcb1a_b31f);
    // The finaliser of MurmurHash3.
    h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
    f64::from(h ^ (h >> 16)) / f64::from(u32::MAX)
}
