//! Folders of pairs: one line for each pair, and the worst code of all.

use std::fs;

use serde_json::Value;

use crate::made::{Made, Ran, bust, copied, names, run};

fn run_folder(folder: &str, light: &Made, more: &[&str]) -> Ran {
    let light = light.path("light.csv");
    run(&[&[folder, "--light", &light, "--start", "identity", "--scale", "1"], more].concat())
}

#[test]
fn a_folder_is_one_line_each_and_a_broken_pair_costs_itself() {
    let made = bust();
    let folder = tempfile::TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    for number in ["0002", "0010"] {
        copied(&made, "image.png", at(&format!("color/{number}.png")));
        copied(&made, "depth.npy", at(&format!("depth/{number}.npy")));
    }
    fs::write(at("color/0003.png"), b"no picture").unwrap();
    copied(&made, "image.png", at("color/0004.png"));
    fs::write(at("depth/0004.npy"), b"\x93NUMPY").unwrap();
    fs::write(at("depth/notes.txt"), b"not a picture").unwrap();
    let out = at("out");

    let told = run_folder(folder.path().to_str().unwrap(), &made, &["--json", "--out", out.to_str().unwrap()]);
    assert_eq!(told.code, 3, "{}", told.err);
    let lines: Vec<Value> = told.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let said: Vec<_> = lines.iter().map(|line| (line["name"].as_str().unwrap(), line["status"].as_str())).collect();
    assert_eq!(said, [("2", Some("converged")), ("4", None), ("10", Some("converged"))]);
    assert_eq!(lines[1]["error"]["code"], "file");
    assert_eq!(names(&out), ["10", "2"]);

    // By now the folder also contains the results, which are not pairs.
    fs::remove_file(at("depth/0004.npy")).unwrap();
    let told = run_folder(folder.path().to_str().unwrap(), &made, &["--out", out.to_str().unwrap()]);
    let lone: Vec<_> =
        ["0003", "0004"].map(|name| told.err.contains(&format!("{name}.png: its name matches no other file"))).into();
    let [warnings, notes] =
        ["warning: ", "note: "].map(|kind| told.err.lines().filter(|line| line.starts_with(kind)).count());
    assert_eq!((told.code, lone, warnings, notes), (0, vec![true; 2], 2, 2), "{}", told.err);
    let lines: Vec<&str> = told.out.lines().collect();
    assert!(
        lines.len() == 2 && lines[0].starts_with("2: converged, alpha") && lines[1].contains("degrees"),
        "{}",
        told.out
    );
}

#[test]
fn what_is_to_be_a_picture_and_is_none_is_said() {
    let made = bust();
    let folder = tempfile::TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    copied(&made, "image.png", at("a_rgb.png"));
    copied(&made, "depth.npy", at("a_depth.npy"));
    fs::write(at("b_rgb.png"), b"no picture").unwrap();
    fs::write(at("b_depth.png"), b"").unwrap();
    let told = run_folder(folder.path().to_str().unwrap(), &made, &["--json"]);
    let lines: Vec<Value> = told.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!((told.code, lines.len()), (3, 2), "{}", told.err);
    assert_eq!((lines[1]["name"].as_str(), lines[1]["error"]["code"].as_str()), (Some("b"), Some("file")));
}

#[test]
fn time_stamps_pair_as_tum_lists_them() {
    let made = bust();
    let folder = tempfile::TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    copied(&made, "image.png", at("rgb/a.png"));
    copied(&made, "depth.npy", at("depth/b.npy"));
    fs::write(at("rgb.txt"), "# colour\n1.00 rgb/a.png\n9.00 rgb/lost.png\n").unwrap();
    fs::write(at("depth.txt"), "1.01 depth/b.npy\n9.01 ../escape.npy\n").unwrap();
    let told = run_folder(folder.path().to_str().unwrap(), &made, &["--json"]);
    let report = told.json();
    assert_eq!((told.code, report["name"].as_str()), (0, Some("1")));
    assert!(told.err.contains("1 of the 2 pairs"), "{}", told.err);
}

#[test]
fn a_folder_without_pairs_is_refused() {
    let made = bust();
    let told = run(&[made.folder.path().to_str().unwrap(), "--image-mask", "mask.png"]);
    assert_eq!((told.code, told.err.contains("belong to one pair")), (3, true));
    let empty = tempfile::TempDir::new().unwrap();
    let told = run(&[empty.path().to_str().unwrap()]);
    assert_eq!((told.code, told.err.contains("no pair")), (3, true), "{}", told.err);
    let told = run(&[empty.path().to_str().unwrap(), "--json"]);
    let error = &told.json()["error"];
    assert_eq!((told.code, error["code"].as_str()), (3, Some("file")), "{error}");
    assert!(error["message"].as_str().unwrap().contains("no pair"), "{error}");
}
