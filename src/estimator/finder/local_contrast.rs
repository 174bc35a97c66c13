//! Local contrast, where the albedo varies before an orthographic image (docs/method/registration.md): from what the search has seen, or around
//! an initial pose.

use nalgebra::{Rotation3, Vector3};

use crate::diagnosis::{Alternative, Diagnosis};
use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::estimator::stages::ColourRegistration;
use crate::options::Registration;
use crate::pose::{ContrastOutcome, ContrastSearch, PhotometricReport, Similarity};
use crate::view::ColourView;

/// Both registrations have found one pose where their ends are this near, degrees: contrast may be off by a few.
const SAME_POSE: f64 = 8.0;
/// Around a told pose starts are turned by multiples of so many degrees about the axes, up to so many of them: 123 turns. Of
/// forty photographs told 8 degrees off, 27 turns by 6 degrees find 32 natively, these 36.
const TURN: f64 = 5.0;
const MOST_TURNS: i32 = 3;

/// Whether colours that leave more than noise have something else to be asked: paint or shadows, in an image whose object
/// has an outline.
/// Behind a pinhole outlines in space decide; under a known light surfaces settle what noisy normals leave. Noisy normals
/// leave as much as paint does, so there the image itself has to show edges of paint.
pub fn may_be_called_for(pair: &ViewPair, colours: &ColourRegistration) -> bool {
    is_open(pair, None) && (colours.has_clean_normals() || CleanedImage::new(pair).image.is_some())
}

/// The image that contrast is compared in, where the best registration by colours calls for it likewise.
pub fn cleaned(
    pair: &ViewPair,
    colours: &ColourRegistration,
    plain: Option<&PhotometricReport>,
) -> Option<CleanedImage> {
    let cleaned = is_open(pair, plain).then(|| CleanedImage::new(pair))?;
    Some(cleaned).filter(|cleaned| colours.has_clean_normals() || cleaned.image.is_some())
}

/// Whether pair and colours leave room for paint.
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

/// Whether a registration by colours from where contrast ended leaves no more than noise: then there is no paint, and its
/// pose is the better one.
fn is_plain(pair: &ViewPair, plain: &PhotometricReport, contrast: &ContrastOutcome) -> bool {
    !albedo_varies(pair, plain) && plain.pose.degrees_to(&contrast.best.pose) < SAME_POSE
}

/// What contrast is compared in: the image without the paint that shows at its edges, or as it is.
pub struct CleanedImage {
    image: Option<Box<ColourView>>,
    /// Whether hues were blurred, as JPEG leaves them.
    was_soft: bool,
}

impl CleanedImage {
    /// Of a pair's image.
    pub fn new(pair: &ViewPair) -> Self {
        let sharp = pair.image.with_sharp_hues();
        let image = sharp.as_ref().unwrap_or(&pair.image).without_paint().map(Box::new);
        Self { image, was_soft: sharp.is_some() }
    }

    /// The image.
    pub fn image<'a>(&'a self, pair: &'a ViewPair) -> &'a ColourView {
        self.image.as_deref().unwrap_or(&pair.image)
    }
}

/// Sizes that starts have where the scale is free, relative to the units' scale. With the middle one alone, of 60 painted
/// renders all that were 16 % larger or smaller were lost; with three, two are.
const SIZES: [f64; 3] = [0.84, 1.0, 1.19];

/// These poses at each of the sizes that the scale may have.
pub fn of_all_sizes(pair: &ViewPair, poses: &[Similarity]) -> Vec<Similarity> {
    let middle = pair.depth.points.centroid();
    let held = gauge::held_scale(pair);
    let unit = gauge::unit_scale(pair);
    let scales = held.map_or_else(|| SIZES.map(|size| size * unit).to_vec(), |held| vec![held]);
    let rescaled = |pose: &Similarity, scale: f64| pose.turned_about(middle, scale, pose.rotation);
    poses.iter().flat_map(|pose| scales.iter().map(move |&scale| rescaled(pose, scale))).collect()
}

/// The poses around an initial one.
pub fn around(pair: &ViewPair, initial: &Similarity) -> Vec<Similarity> {
    let middle = pair.depth.points.centroid();
    let turned = |turn: Vector3<f64>| {
        initial.turned_about(middle, initial.scale, Rotation3::new(turn).into_inner() * initial.rotation)
    };
    // A cube of turns, of which the ball in it is taken.
    let side = 2 * MOST_TURNS + 1;
    let turn =
        |at: i32| Vector3::new(at % side, at / side % side, at / side / side).map(|step| f64::from(step - MOST_TURNS));
    let is_near = |turn: &Vector3<f64>| turn.norm() <= f64::from(MOST_TURNS);
    let turns = (0..side * side * side).map(turn).filter(is_near);
    turns.map(|turn| turned(TURN.to_radians() * turn)).collect()
}

/// The outcome of a search that is done: contrast's, or that of the colours from there, where they leave nothing more.
pub fn conclude(
    pair: &ViewPair,
    colours: &ColourRegistration,
    cleaned: &CleanedImage,
    search: &mut ContrastSearch,
) -> Option<Conclusion> {
    let image = cleaned.image(pair);
    let problem = colours.contrast_problem(pair, image);
    let mut contrast = search.outcome(&problem)?;
    let plain = colours.register_in(pair, image, &contrast.best.pose);
    let is_coarse = cleaned.was_soft || !colours.has_clean_normals();
    // Contrast of blurred hues or noisy normals is less to be believed where the colours without paint point elsewhere.
    if is_coarse {
        rival(&mut contrast, plain.as_ref().map(|plain| plain.pose));
    }
    let is_believed = |plain: &PhotometricReport, search: &mut ContrastSearch| {
        is_plain(pair, plain, &contrast)
            && search.is_explained_by(&problem, &plain.pose)
            && (!is_coarse || plain.uncertainty.largest_rotation() <= contrast.best.uncertainty.largest_rotation())
    };
    Some(match plain {
        Some(plain) if is_believed(&plain, search) => Conclusion::ByColours(Box::new(plain)),
        _ => Conclusion::ByContrast(Box::new(contrast)),
    })
}

/// A pose by the colours, if it is another one, beside contrast's.
pub fn rival(contrast: &mut ContrastOutcome, by_colours: Option<Similarity>) {
    let best = contrast.best.pose;
    contrast.rivals.extend(by_colours.filter(|pose| pose.degrees_to(&best) >= SAME_POSE));
}

/// Which of the two has the pose.
pub enum Conclusion {
    ByColours(Box<PhotometricReport>),
    ByContrast(Box<ContrastOutcome>),
}
