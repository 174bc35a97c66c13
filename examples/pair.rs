//! The smallest use: a rendered pair of views, the loop, the pose. Run it with `cargo run --example pair`.

use bimodal_stereo::{Angles, Estimator, LightSource, Options, Result, Status, scenes};

fn main() -> Result<()> {
    let sample = scenes::Scene::new(&scenes::surface("bust")?)?.sample(&scenes::SampleRequest::default())?;
    let options = Options { light: LightSource::Known(sample.light), ..Options::default() };
    let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), options)?;
    while estimator.report().status == Status::Running {
        estimator.step();
    }

    let report = estimator.report();
    let Angles { alpha, beta, gamma } = Angles::of(&report.pose.rotation);
    println!("{} after {} iterations", report.status.name(), report.iteration);
    println!("s {:.4}, alpha {alpha:.2}, beta {beta:.2}, gamma {gamma:.2} degrees", report.pose.scale);
    println!("rotation is {:.3} degrees off", report.pose.degrees_to(&sample.pose));
    Ok(())
}
