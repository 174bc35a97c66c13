//! Replays the corpus of the fuzz targets (`fuzz/`) on the stable toolchain: what they found, and small inputs that reach
//! most of what they reached. No panic, and every promise of `fuzz/bodies/` kept.

use std::fs;
use std::panic::catch_unwind;
use std::path::Path;

#[path = "../../fuzz/bodies/mod.rs"]
mod bodies;

/// Runs every file of one target's corpus, names those that fail, and says how many there were.
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

/// A corpus that has gone missing would pass.
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

/// A fuzzer that makes nothing but errors would find nothing else: with no bytes at all it makes a good pair.
#[test]
fn no_bytes_are_a_good_input() {
    for run in [bodies::estimator::run, bodies::worker::run, bodies::calibration::run, bodies::functions::run] {
        run(&[]);
    }
}
