//! Local contrast, used if the albedo varies in an orthographic image (docs/method/registration.md): from the poses of
//! the search, or around an initial pose.

use nalgebra::{Rotation3, Vector3};

use crate::diagnosis::{Alternative, Diagnosis};
use crate::estimator::decision::{Decision, Method};
use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::estimator::photometric::PhotometricRegistration;
use crate::options::Registration;
use crate::pose::{ContrastOutcome, ContrastReport, ContrastSearch, PhotometricReport, Similarity};
use crate::view::ColourView;

/// Largest angle, in degrees, between the ends of two registrations that agree: local contrast can be off by a few
/// degrees.
const SAME_POSE: f64 = 8.0;
/// Angle in degrees by whose multiples the starts around an initial pose are turned about the axes. Set on photographs
/// with initial poses 8 degrees off (docs/lab/thresholds.md).
const TURN: f64 = 5.0;
/// Largest multiple of that angle: 123 turns in all. Set on the same photographs.
const MOST_TURNS: i32 = 3;

/// Whether local contrast may take over if photometric residuals exceed noise: the image has a mask, and varying albedo
/// or shadows could explain them. With a pinhole camera, silhouettes decide instead. Under a known light, matching
/// surfaces determines what noisy normals cannot. Noisy normals leave as large residuals as varying albedo does, so
/// with them the image itself must show edges of albedo.
pub fn may_be_called_for(pair: &ViewPair, photometric: &PhotometricRegistration) -> bool {
    is_open(pair, None) && (photometric.has_clean_normals() || CleanedImage::new(pair).image.is_some())
}

/// The image in which contrast is compared, if the residuals of the best photometric registration also require local
/// contrast.
pub fn cleaned(
    pair: &ViewPair,
    photometric: &PhotometricRegistration,
    plain: Option<&PhotometricReport>,
) -> Option<CleanedImage> {
    let cleaned = is_open(pair, plain).then(|| CleanedImage::new(pair))?;
    Some(cleaned).filter(|cleaned| photometric.has_clean_normals() || cleaned.image.is_some())
}

/// Whether the options, the views and the registration allow for varying albedo.
fn is_open(pair: &ViewPair, plain: Option<&PhotometricReport>) -> bool {
    pair.options.registration == Registration::Joint
        && pair.known_light().is_none()
        && pair.image.camera.is_orthographic()
        && pair.image.mask.contains(&false)
        && plain.is_none_or(|plain| albedo_varies(pair, plain))
}

fn albedo_varies(pair: &ViewPair, plain: &PhotometricReport) -> bool {
    pair.residuals(plain).diagnose(Alternative::LocalContrast) == Diagnosis::VaryingAlbedo
}

/// Whether a photometric registration from the end of local contrast leaves only noise. Then the albedo does not vary,
/// and the photometric pose is the better one.
fn is_plain(pair: &ViewPair, plain: &PhotometricReport, contrast: &ContrastOutcome) -> bool {
    !albedo_varies(pair, plain) && plain.pose.degrees_to(&contrast.best.pose) < SAME_POSE
}

/// The image in which contrast is compared: without the albedo that shows at its edges, or unchanged.
pub struct CleanedImage {
    image: Option<Box<ColourView>>,
    /// Whether the chromaticity was blurred, as JPEG leaves it.
    was_soft: bool,
}

impl CleanedImage {
    /// Cleans a pair's image.
    pub fn new(pair: &ViewPair) -> Self {
        let sharp = pair.image.with_sharp_chromaticity();
        let image = sharp.as_ref().unwrap_or(&pair.image).without_albedo_steps().map(Box::new);
        Self { image, was_soft: sharp.is_some() }
    }

    /// The cleaned image, or the pair's own if nothing was removed.
    pub fn image<'a>(&'a self, pair: &'a ViewPair) -> &'a ColourView {
        self.image.as_deref().unwrap_or(&pair.image)
    }
}

/// The search in an image.
pub struct ByContrast {
    pub cleaned: CleanedImage,
    pub search: ContrastSearch,
}

/// Sizes of the starts relative to the units' scale, if the scale is free. With the middle one alone, objects about a
/// sixth larger or smaller are missed.
const SIZES: [f64; 3] = [0.84, 1.0, 1.19];

/// Each of these poses at every size that the scale may have.
pub fn of_all_sizes(pair: &ViewPair, poses: &[Similarity]) -> Vec<Similarity> {
    let middle = pair.depth.points.centroid();
    let held = gauge::held_scale(pair);
    let unit = gauge::unit_scale(pair);
    let scales = held.map_or_else(|| SIZES.map(|size| size * unit).to_vec(), |held| vec![held]);
    let rescaled = |pose: &Similarity, scale: f64| pose.turned_about(middle, scale, pose.rotation);
    poses.iter().flat_map(|pose| scales.iter().map(move |&scale| rescaled(pose, scale))).collect()
}

/// Poses around an initial one.
pub fn around(pair: &ViewPair, initial: &Similarity) -> Vec<Similarity> {
    let middle = pair.depth.points.centroid();
    let turned = |turn: Vector3<f64>| {
        initial.turned_about(middle, initial.scale, Rotation3::new(turn).into_inner() * initial.rotation)
    };
    // The turns within the ball inscribed in a cube of turns.
    let side = 2 * MOST_TURNS + 1;
    let turn =
        |at: i32| Vector3::new(at % side, at / side % side, at / side / side).map(|step| f64::from(step - MOST_TURNS));
    let is_near = |turn: &Vector3<f64>| turn.norm() <= f64::from(MOST_TURNS);
    let turns = (0..side * side * side).map(turn).filter(is_near);
    turns.map(|turn| turned(TURN.to_radians() * turn)).collect()
}

/// The method that a finished search leads to.
pub enum Conclusion {
    Photometric(Decision),
    /// The pose of local contrast, and its rivals.
    Contrast(Box<ContrastReport>, Vec<Similarity>),
}

/// The outcome of a finished search: the pose of local contrast or, if a photometric registration from there leaves
/// only noise, the photometric pose.
pub fn conclude(
    pair: &ViewPair,
    photometric: &PhotometricRegistration,
    cleaned: &CleanedImage,
    search: &mut ContrastSearch,
) -> Option<Conclusion> {
    let image = cleaned.image(pair);
    let problem = photometric.contrast_problem(pair, image);
    let mut contrast = search.outcome(&problem)?;
    let plain = photometric.register_in(pair, image, &contrast.best.pose);
    let is_less_reliable = cleaned.was_soft || !photometric.has_clean_normals();
    // With blurred chromaticity or noisy normals, contrast is less reliable if photometric registration ends elsewhere.
    if is_less_reliable {
        add_rival(&contrast.best, &mut contrast.rivals, plain.as_ref().map(|plain| plain.pose));
    }
    let is_believed = |plain: &PhotometricReport, search: &mut ContrastSearch| {
        is_plain(pair, plain, &contrast)
            && search.is_explained_by(&problem, &plain.pose)
            && (!is_less_reliable
                || plain.uncertainty.largest_rotation() <= contrast.best.uncertainty.largest_rotation())
    };
    Some(match plain {
        Some(plain) if is_believed(&plain, search) => {
            let by = Method::Photometric(Box::new(plain));
            Conclusion::Photometric(Decision { rivals: Some(Vec::new()), ..Decision::of(by) })
        }
        _ => Conclusion::Contrast(Box::new(contrast.best), contrast.rivals),
    })
}

/// Adds a photometric pose to the rivals of local contrast if the two differ.
pub fn add_rival(contrast: &ContrastReport, rivals: &mut Vec<Similarity>, photometric: Option<Similarity>) {
    rivals.extend(photometric.filter(|pose| pose.degrees_to(&contrast.pose) >= SAME_POSE));
}
