//! Correspondences of the built-in bust at its true pose, where every answer is known.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::{
    Angles, ColourView, CorrespondenceProblem, Correspondences, DepthView, Points, Similarity, Size, scenes,
};
use nalgebra::Vector3;

struct Views {
    image: ColourView,
    depth: DepthView,
    image_points: Points,
    sample: scenes::Sample,
}

fn views(beta: f64) -> Views {
    let rotation = Angles { beta, ..Angles::default() }.rotation();
    let size = Size { width: 96, height: 96 };
    let request = scenes::SampleRequest { rotation, size, ..Default::default() };
    let sample = scenes::Scene::new(&scenes::surface("bust").unwrap()).unwrap().sample(&request).unwrap();
    let image = ColourView::new(sample.colour_image()).unwrap();
    let depth = DepthView::new(&sample.depth_map(), false).unwrap();
    let mut image_points = Points::missing(size.len());
    for index in 0..size.len() {
        let (column, row) = size.position(index);
        let z = f64::from(sample.truth.image_depth[index]);
        let point = sample.image.camera.point(size, [column as f64, row as f64], z);
        image_points.set(index, point.map(|value| value as f32));
    }
    Views { image, depth, image_points, sample }
}

fn update(views: &Views, pose: &Similarity, distance: Option<f64>) -> Correspondences {
    let mut found = Correspondences::new(&views.image, &views.depth);
    found.update(&CorrespondenceProblem {
        image: &views.image,
        depth: &views.depth,
        pose,
        depth_points: &views.depth.points,
        depth_normals: &views.depth.normals,
        image_points: &views.image_points,
        image_normals: &views.sample.truth.image_normals,
        distance,
        pixel_length: 1.0,
        spreads: 3.0,
    });
    found
}

fn vector(values: [f32; 3]) -> Vector3<f64> {
    values.map(f64::from).into()
}

#[test]
fn dropped_pairs_count_against_the_share_of_inliers() {
    let mut views = views(0.0);
    let placed: Vec<usize> =
        (0..views.image_points.len()).filter(|&index| views.image_points.is_valid(index)).collect();
    // Three medians of these distances exceed a pixel, and every fifth point of the surface lies far beyond them.
    for (k, &index) in placed.iter().enumerate() {
        let [x, y, z] = views.image_points.get(index);
        let off = if k % 5 == 0 { 30.0 } else { [-1.0, 1.0][k % 2] };
        views.image_points.set(index, [x, y, z + off]);
    }
    let found = update(&views, &views.sample.pose, None);
    assert!((found.inliers() - 0.8).abs() < 0.03, "{}", found.inliers());
    let near = update(&views, &views.sample.pose, Some(0.01));
    assert!((near.inliers() - 0.8).abs() < 0.03, "the accepted distance does not change it: {}", near.inliers());
}

#[test]
fn pairs_at_the_true_pose_are_the_same_place() {
    for beta in [0.0, 20.0, 40.0, -60.0, 80.0] {
        let views = views(beta);
        let pose = views.sample.pose;
        let found = update(&views, &pose, Some(1.0));
        let size = views.image.size;
        let [columns, rows] = found.position();
        let mut pairs = 0;
        for (pixel, &index) in found.depth_of_pixel().iter().enumerate() {
            let Ok(index) = usize::try_from(index) else { continue };
            pairs += 1;
            let transformed = pose.apply(vector(views.depth.points.get(index)));
            let gap = vector(views.image_points.get(pixel)) - transformed;
            let normal = vector(views.sample.truth.image_normals.get(pixel));
            assert!(gap.x.abs() < 0.51 && gap.y.abs() < 0.51 && gap.dot(&normal).abs() <= 1.0, "{beta}: {gap}");
            assert_eq!(size.nearest(columns[index], rows[index]), Some(pixel));
        }
        assert!(pairs > 0 && pairs <= found.count(), "{beta}: {pairs} {}", found.count());
        assert!(found.inliers() > 0.5);

        // Completeness: a depth point on the visible image surface, well inside, has a counterpart.
        let (mut expected, mut missed) = (0, 0);
        for index in (0..views.depth.size.len()).filter(|&index| views.depth.points.is_valid(index)) {
            let transformed = pose.apply(vector(views.depth.points.get(index)));
            let [column, row] = views.sample.image.camera.project(size, transformed.into()).unwrap();
            let Some(pixel) = size.nearest(column as f32, row as f32) else { continue };
            let turned = pose.rotation * vector(views.depth.normals.get(index));
            let gap = vector(views.image_points.get(pixel)) - transformed;
            if gap.norm() < 0.8 && turned.z < -0.5 {
                expected += 1;
                missed += usize::from(columns[index].is_nan());
            }
        }
        assert!(expected > 50 && missed * 50 <= expected, "{beta}: {missed} of {expected}");
    }
}

#[test]
fn nothing_corresponds_to_a_surface_far_behind() {
    let views = views(20.0);
    let mut pose = views.sample.pose;
    pose.translation.z += 60.0;
    let found = update(&views, &pose, Some(1.0));
    // At the occluding contour, where normals are nearly perpendicular to the line of sight, some points are still near their planes.
    assert!(found.count() * 20 < views.depth.valid(), "{} of {}", found.count(), views.depth.valid());
    pose.translation.x = 1e4;
    assert_eq!(update(&views, &pose, None).count(), 0);
}

#[test]
fn between_points_of_one_surface_normals_are_their_mean() {
    for beta in [20.0, 40.0, -60.0] {
        let views = views(beta);
        let (found, rotation) = (update(&views, &views.sample.pose, Some(1.0)), views.sample.pose.rotation);
        let (mut gaps, mut off) = (0, Vec::new());
        for (pixel, &index) in found.depth_of_pixel().iter().enumerate() {
            let normal = found.normal_at(pixel, &views.depth.normals).map(|normal| rotation * normal.cast::<f64>());
            if let Ok(index) = usize::try_from(index) {
                assert_eq!(normal, Some(rotation * vector(views.depth.normals.get(index))));
                continue;
            }
            let truth = vector(views.sample.truth.image_normals.get(pixel));
            let Some(normal) = normal.filter(|_| views.image.mask[pixel]) else { continue };
            assert!((normal.norm() - 1.0).abs() < 1e-5);
            gaps += 1;
            off.push(normal.angle(&truth).to_degrees());
        }
        off.sort_by(f64::total_cmp);
        let [median, most] = [off[off.len() / 2], off[off.len() * 95 / 100]];
        // The bust's curvature within half a pixel, plus the error of central differences at occluding contours.
        assert!(gaps > 50 && median < 4.0 && most < 20.0, "{beta}: {gaps} gaps, {median} and {most} degrees off");
    }
}

#[test]
fn what_the_depth_view_does_not_see_has_no_normal() {
    let views = views(60.0);
    let found = update(&views, &views.sample.pose, Some(1.0));
    let unseen = |pixel: &usize| views.image.mask[*pixel] && found.normal_at(*pixel, &views.depth.normals).is_none();
    let wide = (0..views.image.size.len()).filter(unseen).count();
    let inside = views.image.mask.iter().filter(|&&inside| inside).count();
    // At 60 degrees, about a quarter of the bust faces away from the depth camera.
    assert!(wide * 5 > inside, "{wide} of {inside}");
}
