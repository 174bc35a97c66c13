//! Native times of every stage and of the whole step on a built-in scene: `cargo bench --bench step -- '128x128/surface'`.
//!
//! For comparing versions. `npm run bench` compares with the browser, run by run.

mod common;

use std::hint::black_box;
use std::time::Duration;

use bimodal_stereo::scenes::{self, SampleRequest};
use bimodal_stereo::{Shading, Size, Stage};
use common::{Run, Scene, near, run};
use criterion::{Criterion, SamplingMode, criterion_group, criterion_main};

/// Width and height of the views.
const SIZES: [[usize; 2]; 5] = [[32, 32], [64, 64], [128, 128], [256, 256], [640, 480]];
/// A median of fewer samples is unreliable on a busy machine.
const SAMPLES: usize = 20;
/// Iterations until the surface has tried all of its initialisations; later ones are steady.
const WARMING: u32 = 3;
/// An unreachable limit of iterations, so that runs go to their end.
const TO_THE_END: u32 = 1000;
/// Noise of log S in the protocols.
const NOISE: f64 = 0.01;

/// Ripples, which cover half of their square, in window light, rotated by 20 degrees.
fn scene([width, height]: [usize; 2]) -> Scene {
    let request = SampleRequest {
        light: scenes::light("window").expect("a built-in light"),
        size: Size { width, height },
        noise: NOISE,
        ..SampleRequest::default()
    };
    let relief = scenes::surface("ripples").expect("a built-in surface");
    let sample = scenes::Scene::new(&relief).and_then(|scene| scene.sample(&request)).expect("a scene");
    Scene { image: sample.colour_image(), depth: sample.depth_map(), pose: sample.pose }
}

/// Runs a loop from the true pose to its end.
fn whole(scene: &Scene) -> Run {
    run(scene, near(scene), Shading::Surface, TO_THE_END).expect("the scene is sound")
}

/// Mean time of a stage in the steady iterations of a run, or in its last iteration if it ends earlier. The registration
/// computes only in the first iteration of a run; later iterations find that the pose no longer moves.
fn time_of(run: &Run, stage: Stage) -> Duration {
    let first = if stage == Stage::Registration { 0 } else { WARMING.min(run.iterations.saturating_sub(1)) };
    let counts = |iteration: u32| iteration >= first && (stage != Stage::Registration || iteration == 0);
    let times: Vec<f64> = run
        .stages
        .iter()
        .filter(|timed| timed.stage == stage && counts(timed.iteration))
        .map(|timed| timed.milliseconds)
        .collect();
    Duration::from_secs_f64(times.iter().sum::<f64>() / times.len().max(1) as f64 / 1e3)
}

/// The stages that make up one step.
fn stages(name: &str) -> Vec<Stage> {
    if name == "step" {
        Stage::ALL.to_vec()
    } else {
        Stage::ALL.into_iter().filter(|stage| stage.name() == name).collect()
    }
}

fn steps(criterion: &mut Criterion) {
    for size in SIZES {
        let scene = std::cell::LazyCell::new(|| scene(size));
        let mut group = criterion.benchmark_group(format!("{}x{}", size[0], size[1]));
        // A stage is part of a run, and each sample takes a whole run. A flat sampling mode avoids further runs per sample;
        // criterion warns about the duration.
        group.sample_size(SAMPLES).sampling_mode(SamplingMode::Flat);
        group.warm_up_time(Duration::from_millis(1)).measurement_time(Duration::from_millis(1));
        for name in ["light", "shading", "surface", "registration", "refinement", "step"] {
            let parts = stages(name);
            group.bench_function(name, |bencher| {
                bencher.iter_custom(|times| {
                    let once = |run: &Run| parts.iter().map(|&stage| time_of(run, stage)).sum::<Duration>();
                    (0..times).map(|_| once(&black_box(whole(&scene)))).sum()
                });
            });
        }
        group.finish();
    }
}

criterion_group!(benches, steps);
criterion_main!(benches);
