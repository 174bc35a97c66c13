//! One pair, from its files to its answer.

use bimodal_stereo::{Estimator, Status};
use bimodal_stereo_files::pairs::Files;
use bimodal_stereo_files::write::Length;
use bimodal_stereo_files::{Problem, Result, Warning};

use crate::Task;
use crate::code::Code;
use crate::progress::Progress;
use crate::views;

/// The result of a pair.
pub struct Outcome {
    pub files: Files,
    pub estimator: Estimator,
    /// Units of the colour view and the pose, and of the depth view.
    pub image_length: Length,
    pub depth_length: Length,
    /// How the files were read.
    pub notes: Vec<String>,
    pub warnings: Vec<Warning>,
    /// The files that were written.
    pub written: Vec<String>,
}

impl Outcome {
    pub fn code(&self) -> Code {
        Code::of(self.estimator.report().status)
    }
}

/// Reads both views and runs the loop to its end.
pub fn estimate(files: &Files, task: &Task, progress: &Progress) -> Result<Outcome> {
    let views = views::read(files, &task.arguments, &task.cameras)?;
    let [image_length, depth_length] = [views.image.camera.is_some(), views.depth.camera.is_some()].map(Length::of);
    let mut estimator = Estimator::new(views.image, &views.depth, task.options.clone())
        .map_err(|error| Problem::of_pair(&error, &files.image, &files.depth))?
        .with_threads(task.arguments.workers());
    while estimator.report().status == Status::Running {
        progress.show(estimator.step());
    }
    Ok(Outcome {
        files: files.clone(),
        estimator,
        image_length,
        depth_length,
        notes: views.notes,
        warnings: views.warnings,
        written: Vec::new(),
    })
}
