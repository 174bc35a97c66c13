//! Replays the corpus of the fuzz targets (`fuzz/`) on the stable toolchain: findings, and small inputs that reach most of
//! the code that the fuzzer reached. No input may panic or break a check of `fuzz/bodies/`.

use std::fs;
use std::panic::catch_unwind;
use std::path::Path;

#[path = "../../fuzz/bodies/mod.rs"]
mod bodies;

/// Runs every file of a target's corpus, names those that fail, and returns their number.
fn replay(target: &str, run: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target);
    let mut paths: Vec<_> =
        fs::read_dir(&folder).expect("a corpus").map(|entry| entry.expect("a file").path()).collect();
    paths.sort();
    let fails = |path: &&std::path::PathBuf| {
        let data = fs::read(path).expect("a file");
        catch_unwind(|| run(&data)).is_err()
    };
    let failed: Vec<_> = paths.iter().filter(fails).collect();
    assert!(failed.is_empty(), "{} of {} inputs fail: {failed:?}", failed.len(), paths.len());
    println!("{} inputs", paths.len());
    assert!(paths.len() >= FEWEST, "{} inputs in {}", paths.len(), folder.display());
}

/// Least number of files: a missing corpus would pass the other checks.
const FEWEST: usize = 10;

#[test]
fn estimators() {
    replay("estimator", bodies::estimator::run);
}

#[test]
fn workers() {
    replay("worker", bodies::worker::run);
}

#[test]
fn calibrations() {
    replay("calibration", bodies::calibration::run);
}

#[test]
fn functions() {
    replay("functions", bodies::functions::run);
}

/// A fuzzer that makes only invalid inputs would find little, so an empty input makes a valid pair.
#[test]
fn no_bytes_are_a_good_input() {
    for run in [bodies::estimator::run, bodies::worker::run, bodies::calibration::run, bodies::functions::run] {
        run(&[]);
    }
}
