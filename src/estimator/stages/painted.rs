//! Local contrast in place of colours that are painted (docs/method.md, section 10): from what the search has seen, or
//! around a told pose.

use nalgebra::{Rotation3, Vector3};

use super::colours::ColourRegistration;
use super::outlines::LARGEST_PURE_NOISE;
use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::options::Registration;
use crate::pose::{ContrastOutcome, ContrastReport, ContrastSearch, PhotometricReport, Similarity};
use crate::view::ColourView;

/// Colours whose noise is at most so many times that of the image itself are noisy, not painted, unless it is more than
/// any camera's, log units: texture passes for an image's noise as well.
const NOISY: f64 = 1.25;
const LARGEST_IMAGE_NOISE: f64 = 0.06;
/// Both registrations have found one pose where their ends are this near, degrees: contrast may be off by a few.
const SAME_POSE: f64 = 8.0;
/// Hues are asked where they differ by this share of what the colours do, and decide where the contrast that they leave
/// unexplained is at most this share of what the colours leave: under three lamps 0.17 to 0.80 of it, in other photographs
/// 0.84 and more but for one frog.
const LEAST_HUES: f64 = 0.25;
const HUES_LEAVE: f64 = 0.8;
/// Around a told pose starts are turned by so many degrees about the axes and diagonals: from 8 degrees off registrations
/// of photographs mostly come home.
const TURN: f64 = 6.0;

/// Whether colours that leave so much have something else to be asked: paint, in an image whose object has an outline.
/// Behind a pinhole outlines in space decide; under a known light surfaces settle what noisy normals leave.
pub fn is_called_for(pair: &ViewPair, colours: &ColourRegistration, plain: Option<&PhotometricReport>) -> bool {
    pair.options.registration == Registration::Joint
        && pair.known_light().is_none()
        && colours.has_clean_normals()
        && pair.image.camera.is_orthographic()
        && pair.image.mask.contains(&false)
        && plain.is_none_or(|plain| plain.noise > LARGEST_PURE_NOISE)
}

/// Whether a registration by colours from where contrast ended leaves no more than noise: then there is no paint, and its
/// pose is the better one.
fn is_plain(pair: &ViewPair, noise: f64, pose: &Similarity, contrast: &ContrastOutcome) -> bool {
    noise <= LARGEST_PURE_NOISE.max((NOISY * pair.image.log_noise()).min(LARGEST_IMAGE_NOISE))
        && pose.degrees_to(&contrast.best.pose) < SAME_POSE
}

/// What contrast is compared in: the image without the paint that shows at its edges, or as it is.
pub struct CleanedImage(Option<Box<ColourView>>);

impl CleanedImage {
    /// Of a pair's image.
    pub fn new(pair: &ViewPair) -> Self {
        Self(pair.image.without_paint().map(Box::new))
    }

    /// The image.
    pub fn image<'a>(&'a self, pair: &'a ViewPair) -> &'a ColourView {
        self.0.as_deref().unwrap_or(&pair.image)
    }
}

/// Sizes that starts have where the scale is free, relative to the units' scale. With the middle one alone, of 60 painted
/// renders all that were 16 % larger or smaller were lost; with three, two are.
const SIZES: [f64; 3] = [0.84, 1.0, 1.19];

/// A search from these poses, at some sizes where the scale is free.
pub fn search(
    pair: &ViewPair,
    colours: &ColourRegistration,
    cleaned: &CleanedImage,
    poses: &[Similarity],
) -> ContrastSearch {
    let middle = pair.depth.points.centroid();
    let held = gauge::held_scale(pair);
    let unit = gauge::unit_scale(pair);
    let scales = held.map_or_else(|| SIZES.map(|size| size * unit).to_vec(), |held| vec![held]);
    let rescaled = |pose: &Similarity, scale: f64| pose.turned_about(middle, scale, pose.rotation);
    let starts = poses.iter().flat_map(|pose| scales.iter().map(move |&scale| rescaled(pose, scale))).collect();
    ContrastSearch::new(&colours.contrast_problem(pair, cleaned.image(pair)), starts)
}

/// The outcome of a search that is done: that of the colours from there, where they leave nothing more; contrast's; or that of
/// the hues, where they are explained better.
pub fn conclude(
    pair: &ViewPair,
    colours: &ColourRegistration,
    cleaned: &CleanedImage,
    search: &mut ContrastSearch,
) -> Option<Conclusion> {
    let image = cleaned.image(pair);
    let contrast = search.outcome(&colours.contrast_problem(pair, image))?;
    let plain = colours.register_in(pair, image, &contrast.best.pose);
    Some(match plain {
        Some(plain)
            if is_plain(pair, plain.noise, &plain.pose, &contrast)
                && search.is_explained_by(&colours.contrast_problem(pair, image), &plain.pose) =>
        {
            Conclusion::ByColours(Box::new(plain))
        }
        _ => Conclusion::ByContrast(Box::new(
            by_hues(pair, colours, image, search)
                .filter(|hues| hues.best.objective < HUES_LEAVE * contrast.best.objective)
                .unwrap_or(contrast),
        )),
    })
}

/// Contrast of the hues alone, from where that of the colours and registrations by hues from there have ended. Lamps of several
/// colours shade in hue, and paint that is brighter or darker has no part in that.
fn by_hues(
    pair: &ViewPair,
    colours: &ColourRegistration,
    image: &ColourView,
    search: &ContrastSearch,
) -> Option<ContrastOutcome> {
    let (hues, factor) = pair.image.hues_like(image, LEAST_HUES)?;
    let middle = pair.depth.points.centroid();
    let scale = gauge::held_scale(pair).unwrap_or_else(|| gauge::unit_scale(pair));
    let starts = search.ends().flat_map(|end| {
        let resized = end.turned_about(middle, scale, end.rotation);
        let registered = colours.register_in(pair, &hues, &resized).map(|found| found.pose);
        [*end, resized].into_iter().chain(registered)
    });
    let problem = colours.contrast_problem(pair, &hues);
    let mut search = ContrastSearch::new(&problem, starts.collect());
    while !search.advance(&problem) {}
    let mut outcome = search.outcome(&problem)?;
    if let Some(plain) = colours.register_in(pair, &hues, &outcome.best.pose)
        && is_plain(pair, plain.noise / factor, &plain.pose, &outcome)
    {
        outcome.best = ContrastReport { pose: plain.pose, uncertainty: plain.uncertainty, ..outcome.best };
        outcome.rivals.clear();
    }
    Some(outcome)
}

/// Which of the two has the pose.
pub enum Conclusion {
    ByColours(Box<PhotometricReport>),
    ByContrast(Box<ContrastOutcome>),
}

/// The pose around a told one.
pub fn near(pair: &ViewPair, colours: &ColourRegistration, told: &Similarity) -> Option<Conclusion> {
    let cleaned = CleanedImage::new(pair);
    let middle = pair.depth.points.centroid();
    let turned =
        |turn: Vector3<f64>| told.turned_about(middle, told.scale, Rotation3::new(turn).into_inner() * told.rotation);
    let sides = [-1.0, 0.0, 1.0];
    let turns = sides.iter().flat_map(|&x| sides.iter().flat_map(move |&y| sides.map(|z| Vector3::new(x, y, z))));
    let length = |turn: &Vector3<f64>| TURN.to_radians() / turn.norm().max(1.0);
    let starts = turns.map(|turn| turned(turn * length(&turn))).collect();
    let problem = colours.contrast_problem(pair, cleaned.image(pair));
    let mut search = ContrastSearch::new(&problem, starts);
    while !search.advance(&problem) {}
    conclude(pair, colours, &cleaned, &mut search)
}
