//! Single functions of the public interface. If a function returns a `Result`, lengths may disagree and numbers are
//! arbitrary; otherwise lengths are right and numbers still arbitrary.

use std::hint::black_box;

use arbitrary::{Result, Unstructured};
use bimodal_stereo::nalgebra::SMatrix;
use bimodal_stereo::{
    AnchorWeight, Anchors, Angles, Camera, ColourView, DepthView, Icp, IcpOptions, IcpProblem, IntegrationOptions,
    Integrator, Light, LightFitter, LightPrior, Metric, Normals, Photometric, PhotometricOptions, PhotometricProblem,
    PixelLandscape, PosePrior, RansacOptions, Robustness, Search, SearchProblem, ShadingProblem, ShadingSolver,
    ShadingWeights, Similarity, Size, cubic_normals, exposure_step, first_exposure, gradients, normals, ransac,
    surface_of_normals,
};

use super::calibration::rig_camera;
use super::numbers::{light, number, odd, perhaps, points, pose, rarely, rotation, unit, vector};
use super::views::{Pair, camera, depth, image, pair, relief};
use super::{named, numbers};

/// Limit of the slices of a search and of the steps of a registration.
const MOST_SLICES: usize = 60;

pub fn run(data: &[u8]) {
    let u = &mut Unstructured::new(data);
    let calls = [
        consensus,
        similarities,
        lights,
        matching,
        integration,
        shading,
        lenses,
        views,
        searching,
        registering,
        slopes,
    ];
    // Exhausted bytes are an error of the fuzzer, not of the library.
    let _ = u.choose(&calls).and_then(|call| call(u));
}

fn passed<T>(result: bimodal_stereo::Result<T>) -> Option<T> {
    result.map_err(|error| named(&error)).ok()
}

fn is_similarity(pose: &Similarity) {
    assert!(pose.validate("pose").is_ok(), "no similarity: {pose:?}");
}

fn consensus(u: &mut Unstructured<'_>) -> Result<()> {
    let count = u.int_in_range(0..=40)?;
    let depth = points(u, count)?;
    let moved = pose(u)?;
    let mut image: Vec<_> = depth.iter().map(|&point| moved.apply(point)).collect();
    if let Some(last) = count.checked_sub(1) {
        for _ in 0..u.int_in_range(0..=3)? {
            image[u.int_in_range(0..=last)?] = vector(u, 5.0)?;
        }
    }
    if rarely(u, 16)? {
        image.pop();
    }
    let options = RansacOptions {
        threshold: number(u, 1.0)?,
        scale: perhaps(u, 1.0)?,
        most_iterations: u.int_in_range(0..=200)?,
        seed: u.arbitrary()?,
    };
    if let Some(found) = passed(ransac(&depth, &image, &options)) {
        is_similarity(&found.pose);
        assert!(found.inliers.iter().all(|&index| (index as usize) < count));
    }
    let mut weights = Vec::new();
    if u.arbitrary()? {
        for _ in 0..count {
            weights.push(number(u, 1.0)?);
        }
    }
    let given = (!weights.is_empty()).then_some(&weights[..]);
    if let Some(found) = passed(Similarity::fit(&depth, &image, given, perhaps(u, 1.0)?)) {
        is_similarity(&found);
    }
    Ok(())
}

fn similarities(u: &mut Unstructured<'_>) -> Result<()> {
    let (a, b, place) = (pose(u)?, pose(u)?, vector(u, 1.0)?);
    // These must not panic even if the similarity is invalid.
    let made = [a.inverse(), a.after(&b), a.towards(&b, number(u, 0.5)?, place), a.orthonormal()];
    black_box((a.degrees_to(&b), a.apply(place), Angles::of(&a.rotation).rotation()));
    let moderate = |pose: &Similarity| {
        pose.validate("pose").is_ok() && (1e-3..1e3).contains(&pose.scale) && pose.translation.norm() < 1e6
    };
    if moderate(&a) && moderate(&b) {
        is_similarity(&made[0]);
        is_similarity(&made[1]);
        is_similarity(&made[3]);
        assert!((0.0..=180.0).contains(&a.degrees_to(&b)));
    }
    let matrix = SMatrix::<f64, 3, 3>::from_fn(|_, _| 0.0);
    let mut matrix = if u.arbitrary()? { a.rotation } else { matrix };
    for entry in matrix.iter_mut() {
        *entry = number(u, *entry)?;
    }
    if let Some(nearest) = passed(Similarity::nearest(&matrix, place))
        && place.iter().all(|value| value.is_finite())
    {
        is_similarity(&nearest);
    }
    Ok(())
}

fn lights(u: &mut Unstructured<'_>) -> Result<()> {
    let light = light(u)?;
    let turned = light.turned(&rotation(u)?);
    black_box(turned.shade([unit(u)?, unit(u)?, unit(u)?]));
    let _ = passed(light.validate("light"));
    let mut numbers = light.flat().to_vec();
    if rarely(u, 8)? {
        numbers.truncate(u.int_in_range(0..=27)?);
    }
    if let Some(read) = passed(Light::from_slice("light", &numbers)) {
        assert!(read == light);
    }
    let prior = LightPrior::natural();
    black_box(prior.squared_distance(&turned));
    let mut covariance = SMatrix::identity();
    for _ in 0..u.int_in_range(0..=3)? {
        let (row, column) = (u.int_in_range(0..=26)?, u.int_in_range(0..=26)?);
        covariance[(row, column)] = number(u, 0.5)?;
    }
    let prior = passed(LightPrior::new(&light.flat(), &covariance)).unwrap_or(prior);

    let relief = relief(u)?;
    let Some(view) = passed(ColourView::new(image(u, &relief, &light)?)) else { return Ok(()) };
    let known = field(u, view.size)?;
    let log = view.log.each_ref().map(Vec::as_slice);
    black_box(first_exposure(&light, log));
    if let Some(fit) = passed(LightFitter::default().fit(&known, log, &prior, number(u, 1e-6)?)) {
        assert!(fit.light.flat().iter().all(|value| value.is_finite()) && fit.residual >= 0.0, "{fit:?}");
    }
    Ok(())
}

/// Normals over a raster, most of them of unit length.
fn field(u: &mut Unstructured<'_>, size: Size) -> Result<Normals> {
    let mut field = Normals::missing(size.len());
    for index in 0..size.len() {
        let [x, y] = [0.7 * unit(u)? as f32, 0.7 * unit(u)? as f32];
        field.set(index, [x, y, -(1.0 - x * x - y * y).max(0.01).sqrt()]);
    }
    for _ in 0..u.int_in_range(0..=3)? {
        let index = u.int_in_range(0..=size.len() - 1)?;
        field.set(index, [odd(u)? as f32, odd(u)? as f32, number(u, -1.0)? as f32]);
    }
    Ok(field)
}

fn matching(u: &mut Unstructured<'_>) -> Result<()> {
    let relief = relief(u)?;
    let (Some(a), Some(b)) = (
        passed(DepthView::new(&depth(u, &relief, [12, 12])?, u.arbitrary()?)),
        passed(DepthView::new(&depth(u, &relief, [12, 12])?, u.arbitrary()?)),
    ) else {
        return Ok(());
    };
    let image_size = if rarely(u, 16)? { a.size } else { b.size };
    let problem = IcpProblem {
        depth_points: &a.points,
        depth_normals: &a.normals,
        image_points: &b.points,
        image_normals: &b.normals,
        image_size,
        start: pose(u)?,
    };
    let options = IcpOptions {
        metric: *u.choose(&[Metric::PointToPlane, Metric::PointToPoint])?,
        scale_is_held: u.arbitrary()?,
        first_distance: perhaps(u, 10.0)?,
        final_distance: number(u, 2.0)?,
        most_iterations: u.int_in_range(0..=30)?,
    };
    let mut icp = Icp::new();
    if let Some(report) = passed(icp.register(&problem, &options)) {
        is_similarity(&report.pose);
        black_box(report.information.is_degenerate());
        black_box(report.information.uncertainty(number(u, 1.0)?.abs(), &report.pose, &b.camera));
    }
    let (mut from, mut to) = (Vec::new(), Vec::new());
    icp.paired_points(&problem, &mut from, &mut to, u.int_in_range(0..=50)?);
    assert_eq!(from.len(), to.len());
    Ok(())
}

fn numbers(u: &mut Unstructured<'_>, count: usize) -> Result<Vec<f32>> {
    let mut values = Vec::with_capacity(count);
    for _ in 0..count {
        values.push(unit(u)? as f32);
    }
    for _ in 0..u.int_in_range(0..=3)? {
        if let Some(last) = count.checked_sub(1) {
            values[u.int_in_range(0..=last)?] = odd(u)? as f32;
        }
    }
    if rarely(u, 32)? {
        values.pop();
    }
    Ok(values)
}

fn integration(u: &mut Unstructured<'_>) -> Result<()> {
    // The fields of `Size` are public, so bounds are not guaranteed here.
    let size = Size { width: u.int_in_range(0..=20)?, height: u.int_in_range(0..=20)? };
    let odds = u.int_in_range(0..=8)?;
    let mut mask = Vec::with_capacity(size.len());
    for _ in 0..size.len() {
        mask.push(odds == 0 || u.int_in_range(0..=8)? >= odds);
    }
    if rarely(u, 32)? {
        mask.pop();
    }
    let Some(mut integrator) = passed(Integrator::new(size, &mask)) else { return Ok(()) };
    for _ in 0..2 {
        let (p, q) = (numbers(u, size.len())?, numbers(u, size.len())?);
        let (heights, weights) = (numbers(u, size.len())?, numbers(u, size.len())?);
        let weight = if u.arbitrary()? {
            AnchorWeight::PerPixel(&weights)
        } else {
            AnchorWeight::Uniform(number(u, 0.3)? as f32)
        };
        let anchors = if u.arbitrary()? { Some(Anchors { height: &heights, weight }) } else { None };
        let options = IntegrationOptions {
            robustness: match u.int_in_range(0..=2)? {
                0 => Robustness::Off,
                1 => Robustness::Estimated,
                _ => Robustness::Scale(number(u, 1.0)?),
            },
            tolerance: number(u, 1e-5)?,
            max_iterations: u.int_in_range(0..=100)?,
            max_rounds: u.int_in_range(0..=5)?,
        };
        let mut z = vec![0.0; size.len()];
        let _ = passed(integrator.integrate(&p, &q, anchors, &options, &mut z));
        if u.arbitrary()? {
            integrator.reset();
        }
    }
    Ok(())
}

/// Sizes start at one pixel, because an empty size has no slopes and no surface.
fn slopes(u: &mut Unstructured<'_>) -> Result<()> {
    let size = Size { width: u.int_in_range(1..=20)?, height: u.int_in_range(1..=20)? };
    let known = field(u, size)?;
    let camera = camera(u, [size.width, size.height])?.map_or(Camera::Orthographic, Camera::Pinhole);
    let (mut p, mut q) = (vec![0.0; size.len()], vec![0.0; size.len()]);
    let mask = vec![true; size.len()];
    gradients(size, &camera, &known, &mask, &mut p, &mut q);
    let _ = passed(surface_of_normals(size, &known, u.arbitrary()?));
    let depths = numbers(u, size.len())?;
    let mut made = normals::of_depth(size, camera, &depths);
    let mut points = Normals::missing(size.len());
    normals::points_of_depth(size, &camera, &depths, &mut points);
    black_box(normals::of_cloud(size, &points));
    let mut errors = vec![f32::NAN; size.len()];
    cubic_normals::improve(size, &points, &mut made, &mut errors, u.arbitrary()?);
    Ok(())
}

fn shading(u: &mut Unstructured<'_>) -> Result<()> {
    let size = Size { width: u.int_in_range(1..=10)?, height: u.int_in_range(1..=10)? };
    let light = light(u)?;
    let (prior, mut found) = (field(u, size)?, field(u, size)?);
    let mut log = [(); 3].map(|()| vec![f32::NAN; size.len()]);
    for channel in &mut log {
        for value in channel.iter_mut() {
            *value = unit(u)? as f32;
        }
        if rarely(u, 4)? {
            channel[u.int_in_range(0..=size.len() - 1)?] = odd(u)? as f32;
        }
    }
    let log = log.each_ref().map(Vec::as_slice);
    let problem = ShadingProblem { log, prior: &prior, light: &light };
    let weights = ShadingWeights {
        prior: number(u, 0.05)? as f32,
        unit: number(u, 1.0)? as f32,
        robust: perhaps(u, 0.4)?.map(|scale| scale as f32),
    };
    let report = ShadingSolver::new().solve(problem, weights, &mut found);
    assert!(report.converged + report.stalled + report.capped + report.skipped >= size.len());
    black_box(exposure_step(problem, weights, &found, number(u, 0.0)?));
    let pixel = u.int_in_range(0..=size.len() - 1)?;
    let side = u.int_in_range(0..=40)?;
    let start = [number(u, 0.0)? as f32, number(u, 0.0)? as f32, number(u, -1.0)? as f32];
    let landscape = PixelLandscape::new(log.map(|log| log[pixel]), prior.get(pixel), &light, weights, start, side);
    assert_eq!(landscape.objective.len(), side * side);
    Ok(())
}

fn lenses(u: &mut Unstructured<'_>) -> Result<()> {
    let camera = rig_camera(u, [20, 20])?;
    let valid = passed(camera.validate("camera")).is_some();
    let pixel = [number(u, 4.0)?, number(u, 4.0)?];
    let ray = camera.ray(pixel);
    let point = vector(u, 1.0)?;
    black_box((camera.project(point.into()), camera.project_with_gradient(point.into())));
    if let (true, Some(ray)) = (valid, ray) {
        assert!(ray.iter().all(|value| value.is_finite()), "{ray:?}");
        let back = camera.project(ray);
        let apart = back.map_or(f64::INFINITY, |back| (back[0] - pixel[0]).hypot(back[1] - pixel[1]));
        let far = (pixel[0] - camera.cx).hypot(pixel[1] - camera.cy);
        assert!(apart <= 1e-6 * (1.0 + far), "{pixel:?} comes back as {back:?} by {camera:?}");
    }
    Ok(())
}

fn views(u: &mut Unstructured<'_>) -> Result<()> {
    let Pair { image, depth, options } = pair(u)?;
    if let Some(view) = passed(ColourView::new(image)) {
        let missing = |index: usize| view.log.iter().any(|channel| !channel[index].is_finite());
        assert!(
            (0..view.size.len()).all(|index| missing(index) != view.mask[index]),
            "a colour off the mask, or none on it"
        );
    }
    if let Some(view) = passed(DepthView::new(&depth, options.trim)) {
        let valid = || (0..view.size.len()).filter(|&index| view.points.is_valid(index));
        assert!(valid().all(|index| view.mask[index] && view.points.get(index).iter().all(|value| value.is_finite())));
    }
    let _ = passed(options.validate());
    Ok(())
}

fn searching(u: &mut Unstructured<'_>) -> Result<()> {
    let Pair { image, depth, options } = pair(u)?;
    let (Some(image), Some(depth)) = (passed(ColourView::new(image)), passed(DepthView::new(&depth, options.trim)))
    else {
        return Ok(());
    };
    let light = light(u)?;
    let given = if rarely(u, 4)? { field(u, depth.size)? } else { depth.normals.clone() };
    let problem = SearchProblem {
        image: &image,
        depth: &depth,
        normals: &given,
        light: if u.arbitrary()? { Some(&light) } else { None },
        scale: perhaps(u, 1.0)?,
        unit_scale: number(u, 1.0)?,
        seed: u.arbitrary()?,
    };
    let Some(mut search) = passed(Search::new(&problem)) else { return Ok(()) };
    for _ in 0..u.int_in_range(1..=MOST_SLICES)? {
        let share = search.advance().share;
        assert!((0.0..=1.0).contains(&share), "{share}");
    }
    search.swept_poses().iter().for_each(is_similarity);
    search.candidates().iter().for_each(|candidate| is_similarity(&candidate.pose));
    Ok(())
}

fn registering(u: &mut Unstructured<'_>) -> Result<()> {
    let Pair { image, depth, options } = pair(u)?;
    let (Some(image), Some(depth)) = (passed(ColourView::new(image)), passed(DepthView::new(&depth, options.trim)))
    else {
        return Ok(());
    };
    let light = numbers::light(u)?;
    let prior = LightPrior::natural();
    let errors = vec![number(u, 0.01)? as f32; depth.size.len()];
    let problem = PhotometricProblem {
        image: &image,
        depth_size: depth.size,
        points: &depth.points,
        normals: &depth.normals,
        normal_error: if u.arbitrary()? { Some(&errors) } else { None },
        depth_noise: depth.noise,
        light: if u.arbitrary()? { Some(&light) } else { None },
        prior: &prior,
        prior_weight: number(u, 1.0)?,
        scale_is_held: u.arbitrary()?,
        near: None,
    };
    let options = PhotometricOptions {
        first_level: u.int_in_range(0..=4)?,
        most_rounds: u.int_in_range(0..=10)?,
        most_points: if u.arbitrary()? { u.int_in_range(0..=300)? } else { usize::MAX },
        annealed_points: if u.arbitrary()? { u.int_in_range(0..=300)? } else { usize::MAX },
        annealing: u.arbitrary()?,
        jackknife: u.arbitrary()?,
        points_stay: false,
    };
    let mut registration = Photometric::new(&problem);
    let start = pose(u)?;
    let mut near = None;
    if rarely(u, 3)? {
        near = Some(PosePrior { pose: pose(u)?, rotation: unit(u)?, across: number(u, 0.1)?, along: unit(u)? });
    }
    let problem = PhotometricProblem { near, ..problem };
    let Some(()) = passed(registration.begin(&problem, &start, &options)) else { return Ok(()) };
    for _ in 0..MOST_SLICES {
        match passed(registration.step(&problem)) {
            Some(false) => {}
            Some(true) => break,
            None => return Ok(()),
        }
    }
    if let Some(report) = passed(registration.report(&problem)) {
        is_similarity(&report.pose);
        assert!((0.0..=1.0).contains(&report.inliers) && report.noise >= 0.0, "{report:?}");
        assert!(report.covariance.iter().all(|value| !value.is_nan()), "{report:?}");
    }
    Ok(())
}
