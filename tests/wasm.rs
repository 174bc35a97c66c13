//! The numerics compiled to WebAssembly, in Node, in a page and in a worker: `npm test` runs this file in all three.
//! The bindings themselves are tested through the built package, in tests/contract.

#![cfg(target_arch = "wasm32")]

#[path = "common/agreement.rs"]
mod agreement;

use bimodal_stereo::scenes::{self, Sample, SampleRequest, Scene};
use bimodal_stereo::{Error, Estimator, LightSource, Options, Status};
use wasm_bindgen_test::wasm_bindgen_test;

fn bust() -> Result<Sample, Error> {
    let relief = scenes::surface("bust")?;
    Scene::new(&relief)?.sample(&SampleRequest { light: scenes::light("colourful")?, ..SampleRequest::default() })
}

fn estimator(sample: &Sample) -> Result<Estimator, Error> {
    let options = Options { light: LightSource::Known(sample.light), scale: Some(1.0), ..Options::paper() };
    Estimator::new(sample.colour_image(), &sample.depth_map(), options)
}

#[wasm_bindgen_test]
fn the_loop_finds_the_pose_of_the_bust() -> Result<(), Error> {
    let sample = bust()?;
    let mut estimator = estimator(&sample)?;
    assert_eq!(estimator.report().iteration, 0);
    while estimator.report().status == Status::Running {
        estimator.step();
    }
    let report = estimator.report();
    assert_eq!(report.status, Status::Converged, "{report:?}");
    assert!(report.pose.degrees_to(&sample.pose) < 1.0, "{report:?}");
    Ok(())
}

#[wasm_bindgen_test]
fn two_runs_agree_to_the_last_bit() -> Result<(), Error> {
    let sample = bust()?;
    let (mut first, mut second) = (estimator(&sample)?, estimator(&sample)?);
    for _ in 0..2 {
        assert_eq!(first.step(), second.step());
    }
    // As bits, because missing pixels are NaN, which equals nothing.
    let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(first.refined_depth()), bits(second.refined_depth()));
    assert_eq!(bits(&first.image_depth()), bits(&second.image_depth()));
    Ok(())
}

#[wasm_bindgen_test]
fn a_bad_option_is_an_error_and_no_panic() -> Result<(), Error> {
    let sample = bust()?;
    let options = Options { scale: Some(-1.0), ..Options::paper() };
    let error = Estimator::new(sample.colour_image(), &sample.depth_map(), options).err();
    assert_eq!(error.map(|error| error.field().to_owned()).as_deref(), Some("options.scale"));
    Ok(())
}

#[wasm_bindgen_test]
fn this_build_ends_where_the_native_one_does() {
    agreement::check();
}
