//! ICP on the built-in bust: its range of convergence, and its report where the geometry does not determine the pose.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::{
    Angles, Camera, ErrorKind, Icp, IcpOptions, IcpProblem, IcpReport, Metric, Normals, Points, RansacOptions, Result,
    Similarity, Size, ransac, scenes,
};
use nalgebra::{Matrix3, Vector3};

/// Points and normals over a raster.
#[derive(Clone)]
struct Surface {
    size: Size,
    points: Points,
    normals: Normals,
}

impl Surface {
    /// `vectors(column, row)` gives a point and its normal.
    fn new(side: usize, vectors: impl Fn(f64, f64) -> Option<(Vector3<f64>, Vector3<f64>)>) -> Self {
        let size = Size { width: side, height: side };
        let mut surface = Self { size, points: Points::missing(size.len()), normals: Normals::missing(size.len()) };
        let half = (side as f64 - 1.0) / 2.0;
        for index in 0..size.len() {
            let (column, row) = size.position(index);
            if let Some((point, normal)) = vectors(column as f64 - half, row as f64 - half) {
                surface.set(index, point, normal);
            }
        }
        surface
    }

    /// The built-in bust as seen after a rotation.
    fn bust(side: usize, rotation: &Matrix3<f64>) -> Self {
        let scene = scenes::Scene::new(&scenes::surface("bust").unwrap()).unwrap();
        let size = Size { width: side, height: side };
        let view = scene.view(rotation, 1.0, size, Camera::Orthographic);
        let mut surface = Self { size, points: Points::missing(size.len()), normals: Normals::missing(size.len()) };
        for index in (0..size.len()).filter(|&index| view.is_valid(index)) {
            surface.set(index, view.point(index), view.normals[index]);
        }
        surface
    }

    fn set(&mut self, index: usize, point: Vector3<f64>, normal: Vector3<f64>) {
        self.points.set(index, point.map(|value| value as f32).into());
        self.normals.set(index, normal.map(|value| value as f32).into());
    }

    fn valid(&self) -> impl Iterator<Item = usize> {
        (0..self.size.len()).filter(|&index| self.points.is_valid(index))
    }

    fn point(&self, index: usize) -> Vector3<f64> {
        self.points.get(index).map(f64::from).into()
    }

    fn normal(&self, index: usize) -> Vector3<f64> {
        self.normals.get(index).map(f64::from).into()
    }

    fn centroid(&self) -> Vector3<f64> {
        self.valid().map(|index| self.point(index)).sum::<Vector3<f64>>() / self.valid().count() as f64
    }

    /// The central share of the valid columns.
    fn cut(mut self, share: f64) -> Self {
        let columns = self.valid().map(|index| self.size.position(index).0);
        let (first, last) = columns.fold((usize::MAX, 0), |(low, high), column| (low.min(column), high.max(column)));
        let margin = ((last - first + 1) as f64 * (1.0 - share) / 2.0).round() as usize;
        for index in 0..self.size.len() {
            let column = self.size.position(index).0;
            if column < first + margin || column + margin > last {
                self.points.set(index, [f32::NAN; 3]);
                self.normals.set(index, [f32::NAN; 3]);
            }
        }
        self
    }

    /// The typical errors of a surface from shading: stretched and bent, with normals off by a few degrees.
    fn distorted(mut self) -> Self {
        let side = self.size.width as f64;
        for index in self.valid().collect::<Vec<_>>() {
            let (mut p, mut n) = (self.point(index), self.normal(index));
            p.z = 1.03 * p.z + 0.01 * side * (9.0 * p.x / side).sin() + 0.1 * chance(index);
            n +=
                Vector3::new(0.05 * (8.0 * p.y / side).cos() + 0.05 * chance(3 * index), 0.05 * chance(7 * index), 0.0);
            self.set(index, p, n.normalize());
        }
        self
    }

    fn moved(mut self, pose: &Similarity) -> Self {
        for index in self.valid().collect::<Vec<_>>() {
            let (p, n) = (pose.apply(self.point(index)), pose.rotation * self.normal(index));
            self.set(index, p, n);
        }
        self
    }
}

/// A pseudo-random number in -1 .. 1.
fn chance(number: usize) -> f64 {
    (number.wrapping_mul(7919) % 1009) as f64 / 504.5 - 1.0
}

fn about_y(beta: f64) -> Matrix3<f64> {
    Angles { beta, ..Angles::default() }.rotation()
}

fn register(depth: &Surface, image: &Surface, start: Similarity, options: &IcpOptions) -> Result<IcpReport> {
    let problem = IcpProblem {
        depth_points: &depth.points,
        depth_normals: &depth.normals,
        image_points: &image.points,
        image_normals: &image.normals,
        image_size: image.size,
        start,
    };
    Icp::new().register(&problem, options)
}

/// Identity rotation, the given scale, and matching centroids.
fn first_pose(depth: &Surface, image: &Surface, scale: f64) -> Similarity {
    Similarity { scale, translation: image.centroid() - scale * depth.centroid(), ..Similarity::identity() }
}

fn error(report: &IcpReport, rotation: &Matrix3<f64>) -> f64 {
    report.pose.degrees_to(&Similarity { rotation: *rotation, ..Similarity::identity() })
}

/// One sigma of the rotation in degrees, all axes combined.
fn sigma(report: &IcpReport) -> f64 {
    let sigmas = report.information.uncertainty(report.rms, &report.pose, &Camera::Orthographic).rotation_degrees;
    sigmas.iter().map(|sigma| sigma * sigma).sum::<f64>().sqrt()
}

#[test]
fn a_bust_comes_home_from_sixty_degrees_with_free_scale() {
    let image = Surface::bust(64, &Matrix3::identity());
    for share in [1.0, 0.5] {
        for beta in [20.0, 40.0, 60.0, -20.0, -40.0, -60.0] {
            let rotation = about_y(beta);
            let depth = Surface::bust(64, &rotation.transpose()).cut(share);
            let found = register(&depth, &image, first_pose(&depth, &image, 1.0), &IcpOptions::default()).unwrap();
            assert!(error(&found, &rotation) < 0.03, "{share} {beta}: {}", error(&found, &rotation));
            assert!((found.pose.scale - 1.0).abs() < 1e-3 && found.rms < 0.02, "{found:?}");
            assert!(!found.information.is_degenerate());
        }
    }
}

#[test]
fn a_distorted_surface_costs_degrees_and_says_so() {
    let image = Surface::bust(64, &Matrix3::identity()).distorted();
    for beta in [20.0, 40.0, 60.0, -60.0] {
        let rotation = about_y(beta);
        let depth = Surface::bust(64, &rotation.transpose());
        let found = register(&depth, &image, first_pose(&depth, &image, 1.0), &IcpOptions::default()).unwrap();
        // The distortion tilts the surface by about two degrees, which no registration can detect.
        assert!(error(&found, &rotation) < 3.0, "{beta}: {}", error(&found, &rotation));
        assert!((0.1..3.0).contains(&sigma(&found)), "{}", sigma(&found));
    }
}

#[test]
fn point_to_plane_reaches_where_point_to_point_slides() {
    let image = Surface::bust(64, &Matrix3::identity());
    let rotation = about_y(60.0);
    let depth = Surface::bust(64, &rotation.transpose());
    let start = first_pose(&depth, &image, 1.0);
    let plain = IcpOptions { metric: Metric::PointToPoint, ..IcpOptions::default() };
    let [plane, point] =
        [IcpOptions::default(), plain].map(|options| register(&depth, &image, start, &options).unwrap());
    assert!(error(&plane, &rotation) < 0.1 && error(&point, &rotation) > 2.0);
}

#[test]
fn thirty_per_cent_outliers_near_the_start_and_metres_against_pixels() {
    let image = Surface::bust(64, &Matrix3::identity());
    let truth = Similarity {
        scale: 900.0,
        rotation: Angles { alpha: 10.0, beta: -15.0, gamma: 5.0 }.rotation(),
        translation: Vector3::new(30.0, -12.0, -500.0),
    };
    let mut depth = image.clone().moved(&truth.inverse());
    for index in image.valid().filter(|index| index % 10 < 3) {
        let wrong = Vector3::new(chance(index), chance(2 * index), chance(5 * index)) * 0.01;
        depth.set(index, depth.point(index) + wrong, depth.normal(index));
    }
    let off = Similarity { scale: 1.05, rotation: about_y(8.0), translation: Vector3::new(1.0, -1.0, 2.0) };
    let centred = Similarity { translation: -image.centroid(), ..Similarity::identity() };
    let start = centred.inverse().after(&off).after(&centred).after(&truth);
    for metric in [Metric::PointToPlane, Metric::PointToPoint] {
        let options = IcpOptions { metric, first_distance: Some(6.0), ..IcpOptions::default() };
        let found = register(&depth, &image, start, &options).unwrap();
        let moved = found.pose.apply(depth.centroid()) - truth.apply(depth.centroid());
        assert!(error(&found, &truth.rotation) < 0.01, "{metric:?} {}", error(&found, &truth.rotation));
        assert!((found.pose.scale / truth.scale - 1.0).abs() < 1e-3 && moved.norm() < 0.02, "{metric:?} {moved}");
        assert_eq!(found, register(&depth, &image, start, &options).unwrap(), "twice the same");
    }
    let held = IcpOptions { scale_is_held: true, ..IcpOptions::default() };
    let found = register(&depth, &image, Similarity { scale: 900.0, ..start }, &held).unwrap();
    assert_eq!(found.pose.scale, 900.0);
    let uncertainty = found.information.uncertainty(found.rms, &found.pose, &Camera::Orthographic);
    assert_eq!((uncertainty.scale, uncertainty.translation[2]), (None, None));
    assert!(uncertainty.translation[0].is_some_and(|sigma| sigma < 1.0));
}

#[test]
fn surfaces_that_slide_onto_themselves_are_never_a_silent_number() {
    let radius = 20.0;
    let round = |x: f64, y: f64| {
        let inside = radius * radius - x * x - y * y;
        (inside > 25.0).then(|| (Vector3::new(x, y, -inside.sqrt()), Vector3::new(x, y, -inside.sqrt()) / radius))
    };
    let plane = |x: f64, y: f64| Some((Vector3::new(x, y, 0.3 * x), Vector3::new(0.3, 0.0, -1.0).normalize()));
    let tube = |x: f64, y: f64| round(x, 0.0).map(|(p, n)| (p + Vector3::new(0.0, y, 0.0), n));
    let noisy = |x: f64, y: f64| {
        let number = ((x + 100.0) * 1000.0 + (y + 100.0) * 10.0) as usize;
        round(x, y).map(|(p, n)| {
            let n = n + Vector3::new(chance(number), chance(3 * number), chance(7 * number)) * 0.1;
            (p + Vector3::z() * 0.3 * chance(5 * number), n.normalize())
        })
    };
    let surfaces = [Surface::new(48, plane), Surface::new(48, round), Surface::new(48, tube), Surface::new(48, noisy)];
    for (number, image) in surfaces.iter().enumerate() {
        let depth = image.clone().moved(&Similarity { rotation: about_y(-4.0), ..Similarity::identity() });
        match register(&depth, image, Similarity::identity(), &IcpOptions::default()) {
            Err(error) => assert_eq!(error.kind(), ErrorKind::Degenerate),
            Ok(found) => {
                assert!(found.information.is_degenerate(), "{number}: {}", found.information.weakest());
                assert!(sigma(&found) > 90.0, "{number}");
            }
        }
    }
}

#[test]
fn bad_input_is_an_error_and_never_a_panic() {
    let image = Surface::bust(32, &Matrix3::identity());
    let kind = |depth: &Surface, image: &Surface, start: Similarity, options: &IcpOptions| {
        register(depth, image, start, options).map_err(|error| error.kind()).map(|_| ())
    };
    let (start, options) = (Similarity::identity(), IcpOptions::default());
    let nothing = Surface::new(32, |_, _| None);
    let spot = Surface::new(32, |_, _| Some((Vector3::new(1.0, 2.0, 30.0), -Vector3::z())));
    let mut few = nothing.clone();
    for index in image.valid().take(3) {
        few.set(index, image.point(index), image.normal(index));
    }
    for depth in [&nothing, &few] {
        assert_eq!(kind(depth, &image, start, &options), Err(ErrorKind::Degenerate));
        assert_eq!(kind(&image, depth, start, &options), Err(ErrorKind::Degenerate));
    }
    let one_point = register(&spot, &spot, start, &options);
    assert!(one_point.is_ok_and(|found| found.information.is_degenerate()));
    let far = Similarity { translation: Vector3::repeat(1e6), ..start };
    assert_eq!(kind(&image, &image, far, &options), Err(ErrorKind::Degenerate));
    let no_number = Similarity { scale: f64::NAN, ..start };
    assert_eq!(kind(&image, &image, no_number, &options), Err(ErrorKind::Range));
    let no_distance = IcpOptions { final_distance: 0.0, ..options };
    assert_eq!(kind(&image, &image, start, &no_distance), Err(ErrorKind::Range));
    let mut short = image.clone();
    short.normals.x.pop();
    assert_eq!(kind(&short, &image, start, &options), Err(ErrorKind::Size));
}

#[test]
fn consensus_of_the_pairs_confirms_the_pose() {
    let image = Surface::bust(64, &Matrix3::identity());
    let rotation = about_y(40.0);
    let depth = Surface::bust(64, &rotation.transpose());
    let problem = IcpProblem {
        depth_points: &depth.points,
        depth_normals: &depth.normals,
        image_points: &image.points,
        image_normals: &image.normals,
        image_size: image.size,
        start: first_pose(&depth, &image, 1.0),
    };
    let mut icp = Icp::new();
    icp.register(&problem, &IcpOptions::default()).unwrap();
    let (mut from, mut to) = (Vec::new(), Vec::new());
    icp.paired_points(&problem, &mut from, &mut to, usize::MAX);
    let found = ransac(&from, &to, &RansacOptions::default()).unwrap();
    // The points of a pair lie at pixels, not between them, which costs a tenth of a degree.
    assert!(found.pose.degrees_to(&Similarity { rotation, ..Similarity::identity() }) < 0.2);
    assert!(found.inliers.len() * 10 > from.len() * 9);
}
