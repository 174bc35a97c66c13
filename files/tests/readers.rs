//! Calibrations in the formats of other programs, and damaged files.

use std::fs;
use std::path::{Path, PathBuf};

use bimodal_stereo::nalgebra::{Matrix3, Vector3};
use bimodal_stereo::{Lens, Pinhole};
use bimodal_stereo_files::{Calibration, FolderOptions, Result, read_calibration, read_corner, read_rig_folder};

fn read(text: &str) -> Result<Calibration> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rig.txt");
    fs::write(&path, text).unwrap();
    read_calibration(&path)
}

fn found(text: &str) -> Calibration {
    read(text).unwrap_or_else(|problem| panic!("{problem}: {text}"))
}

/// Checks a camera for these intrinsics and this lens.
fn camera(found: &Calibration, index: usize, numbers: [f64; 4], lens: Lens) {
    let [fx, fy, cx, cy] = numbers;
    assert_eq!(found.cameras[index].camera, Pinhole { fx, fy, cx, cy, lens });
}

/// A quarter turn about z and a shift, for which every order of the numbers gives a different result.
const TURN: Matrix3<f64> = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
const SHIFT: Vector3<f64> = Vector3::new(0.1, -0.2, 0.3);

fn pose(found: &Calibration, names: [Option<&str>; 2]) {
    let pose = &found.poses[0];
    assert_eq!([pose.names.from.as_deref(), pose.names.to.as_deref()], names);
    assert!((pose.pose.rotation - TURN).norm() < 1e-9 && (pose.pose.translation - SHIFT).norm() < 1e-9, "{pose:?}");
}

const BROWN: [f64; 8] = [0.1, -0.2, 0.001, 0.002, 0.05, 0.0, 0.0, 0.0];

#[test]
fn matrices() {
    pose(&found("0 -1 0 .1\n1 0 0 -.2\n0 0 1 .3\n0 0 0 1\n"), [None; 2]);
    pose(&found("[[0, -1, 0, 0.1],\n [1, 0, 0, -0.2],\n [0, 0, 1, 0.3]]"), [None; 2]);
    pose(&found("# ours\n0.1 -0.2 0.3 0 0 0.70710678118 0.70710678118"), [None; 2]);
    camera(&found("525 0 319.5\n0 525 239.5\n0 0 1\n"), 0, [525.0, 525.0, 319.5, 239.5], Lens::None);
    camera(
        &found("525 526 319.5 239.5 0.1 -0.2 0.001 0.002 0.05"),
        0,
        [525.0, 526.0, 319.5, 239.5],
        Lens::Brown(BROWN),
    );
    assert!(read("0 1 0 0\n-1 0 0 0\n0 0 1 0\n.1 -.2 .3 1").unwrap_err().to_string().contains("transposed"));
    assert!(read("1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1").unwrap_err().to_string().contains("mirrors"));
    let trajectory = found("1.5 .1 -.2 .3 0 0 .70710678118 .70710678118\n1.6 0 0 0 0 0 0 1");
    pose(&trajectory, [Some("camera"), Some("world")]);
    assert_eq!(trajectory.poses.len(), 2);
}

#[test]
fn json_of_open3d_and_realsense() {
    let open3d = r#"{"width": 640, "height": 480, "intrinsic_matrix": [525, 0, 0, 0, 526, 0, 319.5, 239.5, 1]}"#;
    camera(&found(open3d), 0, [525.0, 526.0, 319.5, 239.5], Lens::None);
    assert_eq!(found(open3d).cameras[0].size, Some([640, 480]));
    // Column by column.
    pose(
        &found(r#"{"depth_to_color": {"rotation": [0,1,0,-1,0,0,0,0,1], "translation": [0.1,-0.2,0.3]}}"#),
        [Some("depth"), Some("color")],
    );
    let by_hand = r#"{"rgb": {"fx": 525, "fy": 526, "cx": 1, "cy": 2, "dist_k1k2p1p2k3": [0.1,-0.2,0.001,0.002,0.05]},
        "R": [[0,-1,0],[1,0,0],[0,0,1]], "t": [0.1,-0.2,0.3], "other": NaN}"#;
    camera(&found(by_hand), 0, [525.0, 526.0, 1.0, 2.0], Lens::Brown(BROWN));
    assert_eq!(found(by_hand).cameras[0].name.as_deref(), Some("rgb"));
    pose(&found(by_hand), [None; 2]);
}

#[test]
fn yaml_of_opencv_kalibr_and_ros() {
    let matrix = |name: &str, rows: usize, cols: usize, data: &str| {
        format!("{name}: !!opencv-matrix\n   rows: {rows}\n   cols: {cols}\n   dt: d\n   data: [ {data} ]\n")
    };
    let opencv = format!(
        "%YAML:1.0\n---\n{}{}{}{}{}",
        matrix("cameraMatrix1", 3, 3, "525., 0., 319.5, 0., 526., 239.5, 0., 0., 1."),
        matrix("distCoeffs1", 1, 5, "0.1, -0.2, 0.001, 0.002, 0.05"),
        matrix("cameraMatrix2", 3, 3, "600., 0., 300., 0., 601.,\n     200., 0., 0., 1."),
        matrix("R", 3, 3, "0., -1., 0., 1., 0., 0., 0., 0., 1."),
        matrix("T", 3, 1, "1.0e-01, -2.0e-01, 3.0e-01")
    );
    let stereo = found(&opencv);
    camera(&stereo, 0, [525.0, 526.0, 319.5, 239.5], Lens::Brown(BROWN));
    camera(&stereo, 1, [600.0, 601.0, 300.0, 200.0], Lens::None);
    pose(&stereo, [Some("1"), Some("2")]);
    let kalibr = "cam0:\n  camera_model: pinhole\n  intrinsics: [525, 526, 319.5, 239.5]\n  distortion_model: equidistant\n  distortion_coeffs: [.1, .2, .3, .4]\n  resolution: [640, 480]\ncam1:\n  camera_model: pinhole\n  intrinsics: [600, 601, 300, 200]\n  distortion_model: radtan\n  distortion_coeffs: [0, 0, 0, 0]\n  T_cn_cnm1:\n  - [0, -1, 0, .1]\n  - [1, 0, 0, -.2]\n  - [0, 0, 1, .3]\n  - [0, 0, 0, 1]\n";
    camera(&found(kalibr), 0, [525.0, 526.0, 319.5, 239.5], Lens::Fisheye([0.1, 0.2, 0.3, 0.4]));
    pose(&found(kalibr), [Some("cam0"), Some("cam1")]);
    let info = "image_width: 640\nimage_height: 480\ncamera_name: rgb\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [525, 0, 319.5, 0, 526, 239.5, 0, 0, 1]\ndistortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [.1, -.2, .001, .002, .05]\n";
    camera(&found(info), 0, [525.0, 526.0, 319.5, 239.5], Lens::Brown(BROWN));
    let transform = "header:\n  frame_id: color\nchild_frame_id: depth\ntransform:\n  translation: {x: 0.1, y: -0.2, z: 0.3}\n  rotation: {x: 0, y: 0, z: 0.70710678118, w: 0.70710678118}\n";
    pose(&found(transform), [Some("depth"), Some("color")]);
    camera(&found("fx = 525\nfy = 526\ncx = 319.5\ncy = 239.5\n"), 0, [525.0, 526.0, 319.5, 239.5], Lens::None);
    let publisher = "ros2 run tf2_ros static_transform_publisher --x .1 --y -.2 --z .3 --yaw 1.57079632679 --frame-id color --child-frame-id depth";
    pose(&found(publisher), [Some("depth"), Some("color")]);
}

#[test]
fn xml_realsense_and_colmap() {
    let xml = "<?xml version=\"1.0\"?>\n<opencv_storage><K type_id=\"opencv-matrix\"><rows>3</rows><cols>3</cols><dt>d</dt><data>525. 0. 319.5\n 0. 526. 239.5 0. 0. 1.</data></K></opencv_storage>";
    camera(&found(xml), 0, [525.0, 526.0, 319.5, 239.5], Lens::None);
    assert!(read("<!DOCTYPE a [<!ENTITY b \"c\">]><a>&b;</a>").unwrap_err().to_string().contains("document type"));
    let streams = " Intrinsic of \"Color\" / 640x480 / {YUYV}\n  Width:      \t640\n  Height:     \t480\n  PPX:        \t319.5\n  PPY:        \t239.5\n  Fx:         \t525\n  Fy:         \t526\n  Distortion: \tInverse Brown Conrady\n  Coeffs:     \t0.1  -0.2  0.001  0.002  0.05\n\nExtrinsic from \"Depth\"\t  To\t  \"Color\" :\n Rotation Matrix:\n   0  -1  0\n   1  0  0\n   0  0  1\n\n Translation Vector: 0.1  -0.2  0.3\n";
    let realsense = found(streams);
    camera(&realsense, 0, [525.0, 526.0, 319.5, 239.5], Lens::Brown(BROWN));
    pose(&realsense, [Some("Depth"), Some("Color")]);
    assert_eq!(realsense.warnings.0[0].code, "lens-approximated");
    // COLMAP measures from the corner of the first pixel.
    camera(&found("# list\n1 PINHOLE 640 480 525 526 320 240\n"), 0, [525.0, 526.0, 319.5, 239.5], Lens::None);
}

#[test]
fn what_is_guessed_is_warned_of_by_a_code() {
    let codes = |text: &str| found(text).warnings.0.iter().map(|warning| warning.code).collect::<Vec<_>>();
    assert_eq!(codes("1 0 0 100\n0 1 0 -20\n0 0 1 3\n0 0 0 1"), ["translation-unit-guessed"]);
    assert_eq!(codes("1 .002 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1"), ["rotation-adjusted"]);
    assert_eq!(codes("fx: 0.8\nfy: 0.9\ncx: 0.5\ncy: 0.5"), ["focal-length-normalised", "pixels-not-square"]);
}

#[test]
fn other_formats_are_named_with_what_reads_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("depth.exr");
    fs::write(&path, b"\x76\x2f\x31\x01\x02\0\0\0").unwrap();
    let message = read_calibration(&path).unwrap_err().to_string();
    assert!(message.contains("OpenEXR") && message.contains("npx bimodal-stereo"), "{message}");
}

/// A folder with two pairs, the second of which has this colour image.
fn with_second(name: &str, bytes: &[u8]) -> Vec<(&'static str, String)> {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    let grey = |width: u32, colour: image::DynamicImage| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        assert_eq!(colour.width(), width);
        colour.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
        bytes.into_inner()
    };
    let depths = image::ImageBuffer::<image::Luma<u16>, _>::from_fn(8, 8, |x, _| image::Luma([1000 + x as u16]));
    let colours = image::RgbImage::from_fn(8, 8, |x, y| image::Rgb([x as u8 * 20, y as u8 * 20, 90]));
    for k in ["1", "2"] {
        put(&format!("depth_{k}.png"), &grey(8, depths.clone().into()));
    }
    put("color_1.png", &grey(8, colours.into()));
    put(name, bytes);
    let found =
        read_rig_folder(folder.path(), &FolderOptions { unit: Some(0.001), ..FolderOptions::default() }).unwrap();
    assert_eq!(found.frames.len(), 1);
    found.warnings.into_iter().map(|warning| (warning.code, warning.message)).collect()
}

#[test]
fn pictures_of_other_formats_and_lone_ones_are_left_out_and_said() {
    let webp = with_second("color_2.webp", b"RIFF\x24\0\0\0WEBPVP8 ");
    assert_eq!(webp[0].0, "file-left-out");
    assert!(webp[0].1.contains("color_2.webp") && webp[0].1.contains("WebP; save it as PNG"), "{webp:?}");
    let tiff = with_second("color_2.tif", b"II*\0\x08\0\0\0");
    assert!(tiff[0].1.contains("color_2.tif") && tiff[0].1.contains("TIFF"), "{tiff:?}");
    let alone = with_second("notes.txt", b"nothing");
    assert!(alone.iter().any(|(code, message)| *code == "file-alone" && message.contains("depth_2.png")), "{alone:?}");
}

#[test]
fn a_crop_has_its_place_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let place = |text: &str| {
        fs::write(folder.path().join("mug_1_loc.txt"), text).unwrap();
        read_corner(&folder.path().join("mug_1_depthcrop.png"))
    };
    assert_eq!(place("264,179").unwrap(), Some([263.0, 178.0]));
    assert!(place("264").is_err() && place("a,b").is_err());
    assert_eq!(read_corner(Path::new("mug_1.png")).unwrap(), None);
}

/// A minimal random generator, for the same mutations everywhere.
struct Random(u64);

impl Random {
    fn below(&mut self, most: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % most.max(1)
    }
}

/// Changes, removes, repeats or cuts off bytes.
fn mutated(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    const LETTERS: &[u8] = b"0-9.eE{}[]<>/:,\"'!&*#\n\t \xff\0";
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len());
        match random.below(5) {
            0 => bytes.truncate(at),
            1 if at < bytes.len() => bytes[at] = LETTERS[random.below(LETTERS.len())],
            2 => bytes.insert(at, LETTERS[random.below(LETTERS.len())]),
            3 => {
                let end = (at + random.below(40)).min(bytes.len());
                bytes.drain(at.min(end)..end);
            }
            _ => {
                let end = (at + random.below(40)).min(bytes.len());
                let piece = bytes[at.min(end)..end].to_vec();
                bytes.splice(at..at, piece);
            }
        }
    }
    bytes
}

fn fixtures() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures/rig");
    let mut files: Vec<PathBuf> =
        fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    files.sort();
    files
}

#[test]
fn damaged_files_are_refused_and_never_a_panic() {
    const ROUNDS: usize = 40;
    const LARGEST: u64 = 20_000;
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(1);
    let texts = [
        "%YAML:1.0\nK: !!opencv-matrix\n   rows: 3\n   cols: 3\n   data: [ 5, 0, 3, 0, 5, 2, 0, 0, 1 ]\n",
        "{\"a\": {\"fx\": 5, \"fy\": 6, \"cx\": 3, \"cy\": 2}, \"R\": [1,0,0,0,1,0,0,0,1], \"t\": {\"x\":1,\"y\":2,\"z\":3}}",
        "<a><b><_>1 2</_><_>3</_></b><K><rows>1</rows><cols>2</cols><data>1 2</data></K></a>",
        "static_transform_publisher 0 0 0 0 0 0 1 a b",
        "a: &a [1, 2]\nb: *a\nc: {<<: *a}\n",
        "1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n",
    ];
    let small = |path: &PathBuf| path.metadata().is_ok_and(|data| data.is_file() && data.len() < LARGEST);
    let files = fixtures().into_iter().filter(small).map(|path| fs::read(path).unwrap());
    let names = ["color_1.png", "depth_1.png"];
    for seed in texts.iter().map(|text| text.as_bytes().to_vec()).chain(files) {
        for _ in 0..ROUNDS {
            let bytes = mutated(&seed, &mut random);
            let path = folder.path().join("calib.yaml");
            fs::write(&path, &bytes).unwrap();
            let _ = read_calibration(&path);
            names.iter().for_each(|name| fs::write(folder.path().join(name), &bytes).unwrap());
            let _ = read_rig_folder(folder.path(), &FolderOptions::default());
        }
    }
}

#[test]
fn aliases_and_nesting_do_not_unfold() {
    let bomb: String =
        (1..30).map(|k| format!("a{k}: &a{k} [*a{0}, *a{0}, *a{0}, *a{0}, *a{0}, *a{0}, *a{0}]\n", k - 1)).collect();
    assert!(read(&format!("a0: &a0 [[1], [2]]\n{bomb}")).is_err());
    for (open, close) in [("[", "]"), ("{\"a\":", "}"), ("<a>", "</a>")] {
        assert!(read(&format!("{}{}", open.repeat(5000), close.repeat(5000))).is_err());
    }
}
