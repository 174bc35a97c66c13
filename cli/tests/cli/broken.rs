//! Every invalid input exits with code 3 and names the file or the argument with the reason.

use std::fs;

use crate::made::{Made, Ran, SIDE, bust, run, write_png};

/// Checks that the program refuses these arguments, in words and as JSON.
fn refused(arguments: &[&str], parts: &[&str]) {
    let Ran { code, out, err } = run(arguments);
    assert_eq!((code, out.as_str()), (3, ""), "{arguments:?}: {err}");
    for part in parts {
        assert!(err.contains(part), "{arguments:?} should say {part:?}: {err}");
    }
}

#[test]
fn arguments() {
    let made = bust();
    let [image, depth] = ["image.png", "depth.npy"].map(|name| made.path(name));
    let pair = |more: &[&'static str]| [&[image.as_str(), depth.as_str()], more].concat();
    refused(&[], &["IMAGE"]);
    refused(&[&image], &["image.png", "both"]);
    refused(&["nowhere"], &["nowhere", "no such folder"]);
    refused(&pair(&["--colour"]), &["--colour"]);
    refused(&pair(&["third.png"]), &["third.png"]);
    refused(&pair(&["--image-camera", "500,500,24"]), &["fx,fy,cx,cy"]);
    refused(&pair(&["--depth-camera", "500,-1,24,24"]), &["fy", "above zero"]);
    refused(&pair(&["--depth-camera", "500,500,24,24,0,0,0,0,0,0"]), &["k3"]);
    refused(&pair(&["--start", "left"]), &["search, identity"]);
    refused(&pair(&["--scale", "0"]), &["above zero"]);
    refused(&pair(&["--depth-unit", "nan"]), &["above zero"]);
    refused(&pair(&["--max-iterations", "0"]), &["maxIterations"]);
    refused(&pair(&["--light", "nowhere.csv"]), &["nowhere.csv"]);
    refused(&pair(&["--light-prior", "nowhere.json"]), &["nowhere.json"]);
    refused(&pair(&["--registration", "magic"]), &["joint"]);
}

/// Checks a file with these bytes next to a valid one.
fn bad_file(made: &Made, name: &str, bytes: &[u8], parts: &[&str]) {
    let path = made.path(name);
    fs::write(&path, bytes).unwrap();
    let [image, depth] = ["image.png", "depth.npy"].map(|name| made.path(name));
    let parts = [&[name], parts].concat();
    refused(&[&path, &depth], &parts);
    refused(&[&image, &path], &parts);
}

fn npy(kind: &str, shape: &str, body: usize) -> Vec<u8> {
    let said = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({shape}), }}\n");
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((said.len() as u16).to_le_bytes());
    file.extend(said.bytes());
    file.extend(vec![0; body]);
    file
}

#[test]
fn files() {
    let made = bust();
    let [png, depth] = ["image.png", "depth.npy"].map(|name| fs::read(made.path(name)).unwrap());
    bad_file(&made, "empty.png", b"", &["empty"]);
    bad_file(&made, "text.png", b"no picture at all", &["neither a PNG"]);
    for length in [8, 20, 40, png.len() - 20] {
        bad_file(&made, "cut.png", &png[..length], &["PNG is damaged or cut off"]);
    }
    let mut flipped = png.clone();
    flipped[60] ^= 255;
    bad_file(&made, "flipped.png", &flipped, &["PNG is damaged or cut off"]);
    for length in [8, 11, 60] {
        bad_file(&made, "cut.npy", &depth[..length], &["cut off in its header"]);
    }
    bad_file(&made, "short.npy", &depth[..depth.len() - 1], &["cut off", "bytes"]);
    bad_file(&made, "huge.npy", &npy("<f4", "4000000000, 4000000000", 64), &["4096"]);
    bad_file(&made, "overflow.npy", &npy("<f8", "4294967296, 4294967296, 4", 64), &["4096"]);
    bad_file(&made, "axes.npy", &npy("<f4", "4, 4, 1, 1, 1", 64), &["5 axes"]);
    bad_file(&made, "sides.npy", &npy("<f4", "4, -4", 64), &["above zero"]);
    bad_file(&made, "nested.npy", &npy("<f4", &"(".repeat(5000), 64), &["axes"]);
    bad_file(&made, "kind.npy", &npy("<c16", "4, 4", 256), &["<c16", "float32"]);
    bad_file(&made, "half.jpg", b"\xff\xd8\xff\xe0\x00\x10JFIF", &["JPEG is cut off"]);
    bad_file(&made, "none.jpg", b"\xff\xd8\xff\xd9", &["JPEG is damaged"]);
}

#[test]
fn files_that_are_something_else() {
    let made = bust();
    let [image, depth] = ["image.png", "depth.npy"].map(|name| made.path(name));
    refused(&[&image, &image], &["image.png", "coloured", "swapped"]);
    refused(&["nowhere.png", &depth], &["nowhere.png", "No such file"]);
    let folder = made.folder.path().to_str().unwrap();
    refused(&[folder, &depth], &[folder]);

    let large = made.path("large.png");
    write_png(large.as_ref(), 5000, png::ColorType::Grayscale, png::BitDepth::Eight, &[9; 5000]);
    refused(&[&large, &depth], &["large.png", "5000x1", "4096"]);
    let zero = made.path("zero.png");
    write_png(zero.as_ref(), SIDE, png::ColorType::Grayscale, png::BitDepth::Sixteen, &[0; 2 * SIDE * SIDE]);
    refused(&[&image, &zero], &["zero.png", "no valid depth"]);
    refused(&[&zero, &depth], &["zero.png", "black"]);
    refused(&[&image, &depth, "--image-mask", &zero], &["zero.png", "mask is empty"]);
    let small = made.path("small.png");
    write_png(small.as_ref(), 8, png::ColorType::Grayscale, png::BitDepth::Eight, &[255; 64]);
    refused(&[&image, &depth, "--depth-mask", &small], &["small.png", "8x8", "48x48"]);
    let light = made.path("short.csv");
    fs::write(&light, "1 2 3").unwrap();
    refused(&[&image, &depth, "--light", &light], &["short.csv", "27"]);
    let prior = made.path("prior.json");
    for (text, part) in [
        ("{}", "mean"),
        (r#"{"mean": [1], "covariance": [1, 2]}"#, "prior.mean: needs 27 numbers, not 1"),
        (r#"{"mean": [1], "covariance": [[1, 2], "3"]}"#, "rows of numbers"),
    ] {
        fs::write(&prior, text).unwrap();
        refused(&[&image, &depth, "--light-prior", &prior], &["prior.json", part]);
    }
}

#[test]
fn errors_as_json_have_a_code_and_a_field() {
    let made = bust();
    let image = made.path("image.png");
    let told = run(&[&image, "nowhere.npy", "--json"]);
    assert_eq!(told.code, 3);
    let error = &told.json()["error"];
    assert_eq!((error["code"].as_str(), error["field"].as_str()), (Some("file"), Some("file")));
    assert!(error["message"].as_str().unwrap().contains("nowhere.npy"));
    // Errors that come before any pair is read name no files.
    for (arguments, words) in [
        (vec!["nowhere", "--json"], "no such folder"),
        (vec![image.as_str(), "depth.npy", "--json", "--light", "nowhere.csv"], "nowhere.csv"),
    ] {
        let told = run(&arguments);
        let report = told.json();
        assert_eq!((told.code, report.get("image")), (3, None));
        assert!(report["error"]["message"].as_str().unwrap().contains(words), "{report}");
    }
}

#[test]
fn results_that_cannot_be_written() {
    let made = bust();
    let [image, depth, light] = ["image.png", "depth.npy", "light.csv"].map(|name| made.path(name));
    // A file has the name of the folder to be made.
    let told =
        run(&[&image, &depth, "--light", &light, "--start", "identity", "--max-iterations", "1", "--out", &light]);
    assert_eq!((told.code, told.err.contains("light.csv")), (3, true), "{}", told.err);
}
