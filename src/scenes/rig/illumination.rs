//! The light of a frame: a natural light of order 2, or part of one with one or two lamps that cast shadows.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::raster::{Hits, Rays};
use super::stage::Stage;
use crate::light::Light;
use crate::pose::Similarity;
use crate::scenes::flaws::Chance;
use crate::scenes::lights;
use crate::view::Size;

/// Share of frames with lamps.
const LAMP_SHARE: f64 = 0.5;
/// Range of the share of the natural light if there are lamps.
const AMBIENT: [f64; 2] = [0.15, 0.4];
/// Samples along a side of a shadow map, and the tangent of half of its field of view.
const MAP_SIDE: usize = 1536;
const MAP_REACH: f64 = 1.2;
/// A point lies in shadow if another one is nearer to the lamp by more than this share of its distance. The point is
/// first moved off its surface by [`SURFACE_STEP`].
const SHADOW_BIAS: f64 = 0.004;
/// Step off the surface before the shadow test, metres.
const SURFACE_STEP: f64 = 0.004;

/// The light of a stage.
pub struct Illumination {
    sky: Light,
    /// Rotation from normals of the world to normals of the natural light.
    turn: Matrix3<f64>,
    sky_share: f64,
    lamps: Vec<Lamp>,
}

struct Lamp {
    position: Vector3<f64>,
    /// Colour of the lamp at the distance of the scene's centre.
    colour: [f64; 3],
    distance: f64,
    placement: Similarity,
    rays: Rays,
    nearest: Hits,
}

impl Illumination {
    /// A light for a stage whose centre is `target`.
    pub fn random(stage: &Stage, target: Vector3<f64>, chance: &mut Chance) -> Self {
        let sky = [lights::COLOURFUL, lights::WINDOW, lights::OVERCAST][chance.below(3)];
        // Coloured lamps are taken at half their saturation, because whole scenes are rarely so colourful.
        let sky = if sky == lights::COLOURFUL { towards_grey(&sky) } else { sky };
        let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), chance.between([-1.0, 1.0])).into_inner();
        let lamps = if chance.uniform() < LAMP_SHARE { 1 + chance.below(2) } else { 0 };
        let sky_share = if lamps > 0 { chance.between(AMBIENT) } else { 1.0 };
        let lamps = (0..lamps).map(|_| Lamp::random(stage, target, chance)).collect();
        Self { sky, turn, sky_share, lamps }
    }

    /// A natural light as it is, or as half of the light of a stage that is also lit by a lamp.
    pub fn given(sky: Light, has_lamp: bool, stage: &Stage, target: Vector3<f64>, chance: &mut Chance) -> Self {
        let lamps: Vec<Lamp> = has_lamp.then(|| Lamp::random(stage, target, chance)).into_iter().collect();
        Self { sky, turn: Matrix3::identity(), sky_share: if has_lamp { 0.5 } else { 1.0 }, lamps }
    }

    /// Light of the sky on a surface with this normal.
    pub fn sky(&self, normal: Vector3<f64>) -> [f64; 3] {
        self.sky.shade((self.turn * normal).into()).map(|log| self.sky_share * log.exp())
    }

    /// Adds the light of the lamps at a point.
    pub fn add_lamps(&self, point: Vector3<f64>, normal: Vector3<f64>, light: &mut [f64; 3]) {
        for lamp in &self.lamps {
            let share = lamp.share(point, normal);
            light.iter_mut().zip(lamp.colour).for_each(|(sum, colour)| *sum += share * colour);
        }
    }

    /// Whether a point lies in the shadow of each lamp.
    #[cfg(test)]
    pub fn shadows(&self, point: Vector3<f64>, normal: Vector3<f64>) -> Vec<bool> {
        self.lamps.iter().map(|lamp| lamp.share(point, normal) <= 0.0).collect()
    }

    #[cfg(test)]
    pub fn lamp_positions(&self) -> Vec<Vector3<f64>> {
        self.lamps.iter().map(|lamp| lamp.position).collect()
    }
}

impl Lamp {
    /// The lamp is above and beside the rig, possibly behind it.
    fn random(stage: &Stage, target: Vector3<f64>, chance: &mut Chance) -> Self {
        let side = if chance.uniform() < 0.5 { -1.0 } else { 1.0 };
        let reach = target.norm();
        let position = Vector3::new(
            side * chance.between([0.2, 0.9]) * reach,
            -chance.between([0.2, 0.6]) * reach.min(1.6),
            chance.between([-0.4, 0.3]) * reach,
        );
        let forward = (target - position).normalize();
        let rotation = Rotation3::face_towards(&forward, &Vector3::y()).inverse().into_inner();
        let placement = Similarity { scale: 1.0, rotation, translation: -(rotation * position) };
        let size = Size { width: MAP_SIDE, height: MAP_SIDE };
        let rays = Rays::straight(0.5 * MAP_SIDE as f64 / MAP_REACH, size);
        let nearest = rays.meet(stage, &placement);
        let warmth = chance.between([-0.15, 0.15]);
        let colour = [1.0 + warmth, 1.0, 1.0 - warmth].map(|part| 0.8 * part);
        Self { position, colour, distance: (target - position).norm(), placement, rays, nearest }
    }

    /// Arriving light relative to that on a surface at the scene's centre that faces the lamp.
    fn share(&self, point: Vector3<f64>, normal: Vector3<f64>) -> f64 {
        let to_lamp = self.position - point;
        let cosine = normal.dot(&to_lamp) / to_lamp.norm();
        if cosine <= 0.0 || self.hides(point + SURFACE_STEP * normal) {
            return 0.0;
        }
        cosine * self.distance * self.distance / to_lamp.norm_squared()
    }

    fn hides(&self, point: Vector3<f64>) -> bool {
        let point = self.placement.apply(point);
        let Some([column, row]) = self.rays.position(point) else { return false };
        let Some(index) = self.rays.size.nearest(column as f32, row as f32) else { return false };
        f64::from(self.nearest.depth[index]) < point.z * (1.0 - SHADOW_BIAS)
    }
}

/// Moves each channel half-way to the mean of the channels.
fn towards_grey(light: &Light) -> Light {
    let [r, g, b] = light.0;
    Light(light.0.map(|channel| std::array::from_fn(|k| 0.5 * channel[k] + (r[k] + g[k] + b[k]) / 6.0)))
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix3;

    use super::*;
    use crate::scenes::rig::layout::{Layout, RigKind, layout};

    fn is_blocked(stage: &Stage, from: Vector3<f64>, to: Vector3<f64>) -> bool {
        stage.triangles.iter().any(|triangle| {
            let [a, b, c] = triangle.corners.map(|corner| stage.points[corner as usize]);
            let solution = Matrix3::from_columns(&[to - from, a - b, a - c]).lu().solve(&(a - from));
            solution.is_some_and(|solution| {
                let [t, u, v] = solution.into();
                t > 1e-6 && t < 1.0 - 1e-6 && u >= 0.0 && v >= 0.0 && u + v <= 1.0
            })
        })
    }

    /// Compares shadow maps with rays to the lamp through every triangle.
    #[test]
    fn shadows_lie_where_something_is_in_the_way() {
        let (mut same, mut dark, mut all) = (0, 0, 0);
        for seed in 0..6 {
            let Layout { stage, view, target } = layout(RigKind::Boxes, &mut Chance::of_stream(seed, 1));
            let light = Illumination::random(&stage, target, &mut Chance::of_stream(seed, 2));
            let rays = Rays::straight(30.0, Size { width: 40, height: 30 });
            let hits = rays.meet(&stage, &view);
            for index in (0..rays.size.len()).step_by(7) {
                let Some(hit) = rays.hit(&stage, &view, &hits, index) else { continue };
                let start = hit.point + 2.0 * SURFACE_STEP * hit.normal;
                for (position, found) in light.lamp_positions().into_iter().zip(light.shadows(hit.point, hit.normal)) {
                    let expected =
                        hit.normal.dot(&(position - hit.point)) <= 0.0 || is_blocked(&stage, start, position);
                    same += usize::from(found == expected);
                    dark += usize::from(expected);
                    all += 1;
                }
            }
        }
        // Borders of shadows differ because of the step off the surface and the samples of the map.
        assert!(all > 500 && dark > all / 20 && dark < all / 2, "{dark} of {all}");
        assert!(same as f64 > 0.97 * all as f64, "{same} of {all}");
    }
}
