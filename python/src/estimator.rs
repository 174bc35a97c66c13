//! The loop for Python.

use std::path::PathBuf;
use std::time::Instant;

use bimodal_stereo::{Estimator as Native, Options, Stage, Status, StepReport, Surface};
use bimodal_stereo_files::write;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::arrays::{array, triples};
use crate::error::{failure, outcome, unbroken};
use crate::guard::{Guarded, guarded};
use crate::{files, input, options, report};

/// An estimator, the options for a reset without options, and the wall time of the stages that ran last, because the
/// numerics have no clock.
struct Loop {
    native: Native,
    options: Options,
    workers: usize,
    milliseconds: Vec<(&'static str, f64)>,
    /// Whether anything has run since the start, and the number of slices of the search.
    begun: bool,
    slices: usize,
}

impl Loop {
    fn step(&mut self) {
        self.milliseconds.clear();
        if self.workers > 1 && !self.native.is_searching() {
            // The stages run in parallel in the threads.
            return self.timed(Some("iteration"), Native::step);
        }
        let before = self.native.report().iteration;
        loop {
            let is_searching = self.native.is_searching();
            self.timed_stage();
            let report = self.native.report();
            if is_searching || report.iteration != before || report.status != Status::Running {
                return;
            }
        }
    }

    fn step_stage(&mut self) {
        self.milliseconds.clear();
        self.timed_stage();
    }

    /// A stage, or a step of the search, which is a round of the threads if there are several.
    fn timed_stage(&mut self) {
        let work = if self.native.is_searching() { Native::step } else { Native::step_stage };
        self.timed(None, work);
    }

    /// Measures some work under a name, or under that of the stage at its end.
    fn timed(&mut self, name: Option<&'static str>, work: fn(&mut Native) -> &StepReport) {
        let start = Instant::now();
        let stage = work(&mut self.native).stage;
        self.begun = true;
        self.slices += usize::from(stage == Stage::Search);
        let spent = 1000.0 * start.elapsed().as_secs_f64();
        let name = name.unwrap_or_else(|| stage.name());
        match self.milliseconds.iter_mut().find(|(known, _)| *known == name) {
            Some((_, sum)) => *sum += spent,
            None => self.milliseconds.push((name, spent)),
        }
    }

    fn reset(&mut self, options: Option<Options>) -> bimodal_stereo::Result<()> {
        let options = options.unwrap_or_else(|| self.options.clone());
        self.native.reset(options.clone())?;
        self.options = options;
        self.milliseconds.clear();
        (self.begun, self.slices) = (false, 0);
        Ok(())
    }

    fn state(&self) -> (StepReport, Vec<(&'static str, f64)>) {
        (self.native.report().clone(), self.milliseconds.clone())
    }

    /// All results of a run except the times. Floats as text are the shortest that read back as the same bits.
    fn found(&self) -> Vec<u8> {
        let mut bytes = format!("{:?}", self.native.report()).into_bytes();
        bytes.extend(self.native.light().flat().iter().flat_map(|value| value.to_le_bytes()));
        bytes.extend(self.native.image_depth().iter().flat_map(|value| value.to_le_bytes()));
        bytes.extend(self.native.refined_depth().iter().flat_map(|value| value.to_le_bytes()));
        bytes
    }
}

/// The loop. Threads that call it at the same time wait for each other, without holding the interpreter's lock.
#[pyclass(frozen, module = "bimodal_stereo._native")]
pub struct Estimator {
    own: Guarded<Loop>,
    /// Rows and columns of both views.
    image: [usize; 2],
    depth: [usize; 2],
    workers: usize,
}

type Array<'py> = PyResult<Bound<'py, PyAny>>;

impl Estimator {
    fn call<R: Send>(&self, py: Python<'_>, work: impl FnOnce(&mut Loop) -> R + Send) -> PyResult<R> {
        unbroken(py.detach(|| self.own.call(work)))
    }

    /// The report after some work.
    fn after<'py>(&self, py: Python<'py>, work: fn(&mut Loop)) -> PyResult<Bound<'py, PyDict>> {
        let (state, milliseconds) = self.call(py, |own| {
            work(own);
            own.state()
        })?;
        report::step(py, &state, &milliseconds)
    }

    /// A raster of one view, with one or three numbers for each pixel.
    fn raster<'py, T: numpy::Element + Send>(
        &self,
        py: Python<'py>,
        [height, width]: [usize; 2],
        read: impl FnOnce(&Native) -> Vec<T> + Send,
    ) -> Array<'py> {
        let values = self.call(py, |own| read(&own.native))?;
        if values.len() == height * width {
            array(py, values, [height, width])
        } else {
            array(py, values, [height, width, 3])
        }
    }
}

#[pymethods]
impl Estimator {
    #[new]
    fn new(
        py: Python<'_>,
        image: &Bound<'_, PyAny>,
        depth: &Bound<'_, PyAny>,
        keywords: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let (image, depth, options) = (input::image(image)?, input::depth(depth)?, options::options(keywords)?);
        let sizes = [[image.height, image.width], [depth.height, depth.width]];
        let workers = options::workers(keywords)?.unwrap_or(1);
        let kept = options.clone();
        let make = || Native::new(image, &depth, options).map(|native| native.with_threads(workers));
        let native = outcome(py.detach(|| guarded(make)))?;
        let own = Loop { native, options: kept, workers, milliseconds: Vec::new(), begun: false, slices: 0 };
        Ok(Self { own: Guarded::new(own), image: sizes[0], depth: sizes[1], workers })
    }

    fn step<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.after(py, Loop::step)
    }

    fn step_stage<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.after(py, Loop::step_stage)
    }

    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.after(py, |_| ())
    }

    fn reset(&self, py: Python<'_>, keywords: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let workers = keywords.map(options::workers).transpose()?.flatten();
        if workers.is_some_and(|count| count != self.workers) {
            let message = "cannot change after the estimator was made; make a new one";
            return Err(failure("option", "workers", message));
        }
        let options = keywords.map(options::options).transpose()?;
        outcome(py.detach(|| self.own.call(|own| own.reset(options))))
    }

    /// Writes the results into a folder; returns their paths with descriptions.
    fn write_results(&self, py: Python<'_>, folder: PathBuf) -> PyResult<Vec<String>> {
        let written = self.call(py, |own| write::results(&folder, &own.native, Vec::new()))?;
        written.map_err(|problem| files::refused(&problem))
    }

    fn image_normals<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.raster(py, self.image, |native| native.image_normals().interleaved())
    }

    fn image_depth<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.raster(py, self.image, |native| native.image_depth().into_owned())
    }

    fn depth_normals<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.raster(py, self.depth, |native| native.depth_normals().interleaved())
    }

    fn refined_depth<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.raster(py, self.depth, |native| native.refined_depth().to_vec())
    }

    fn correspondence<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.raster(py, self.image, |native| native.correspondence().into_owned())
    }

    fn residual<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.raster(py, self.image, |native| native.residual().into_owned())
    }

    fn albedo<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.raster(py, self.image, Native::albedo)
    }

    fn shading<'py>(&self, py: Python<'py>) -> Array<'py> {
        self.raster(py, self.image, Native::shading)
    }

    fn light<'py>(&self, py: Python<'py>) -> Array<'py> {
        array(py, self.call(py, |own| own.native.light().flat().to_vec())?, [3, 9])
    }

    /// How far the run has come, and the result of `Loop::found` at the same moment.
    fn reached<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyDict>, Bound<'py, PyBytes>)> {
        let (report, begun, slices, found) =
            self.call(py, |own| (own.native.report().clone(), own.begun, own.slices, own.found()))?;
        let dict = PyDict::new(py);
        dict.set_item("begun", begun)?;
        dict.set_item("stage", report.stage.name())?;
        dict.set_item("iteration", report.iteration)?;
        dict.set_item("slices", slices)?;
        dict.set_item("ended", report.status != Status::Running)?;
        Ok((dict, PyBytes::new(py, &found)))
    }

    /// Points of the depth view or the image; the package has checked the word.
    fn points<'py>(&self, py: Python<'py>, of_depth: bool) -> Array<'py> {
        let surface = if of_depth { Surface::Depth } else { Surface::Image };
        triples(py, self.call(py, |own| own.native.points(surface))?)
    }
}
