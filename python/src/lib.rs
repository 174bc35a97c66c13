//! Bindings for Python: thin, without mathematics, private to the package `bimodal_stereo` beside them.
//!
//! The package has made arrays contiguous and of the required types, and turned objects into dictionaries. Names and
//! types of single members are checked here ([`members`]), values by the crate, as for every other caller. Arrays are
//! copied both ways. Long calls run without the interpreter's lock, and a panic becomes an error ([`guard`]).

mod arrays;
mod calibration;
mod cameras;
mod error;
mod estimator;
mod files;
mod guard;
mod input;
mod lessons;
mod members;
mod options;
mod pairs;
mod report;
mod samples;
mod write;

#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    use super::calibration::{check_calibration, project_frame, sample_rig};
    #[pymodule_export]
    use super::error::spelled;
    #[pymodule_export]
    use super::estimator::Estimator;
    #[pymodule_export]
    use super::files::{check_command, read_calibration, read_depth, read_image, read_mask, read_rig_folder};
    #[pymodule_export]
    use super::lessons::{
        bas_relief, characteristic_strips, integrate_normals, pixel_landscape, second_order, shade_lamp, shade_normals,
        turn_light,
    };
    #[pymodule_export]
    use super::pairs::{sample_pair, suggest_mask};
    #[pymodule_export]
    use super::samples::{sample, sample_bound, sample_lights, sample_surfaces};
    #[pymodule_export]
    use super::write::{depth_png, matrix_text};

    /// Cause and remedy of every code, as JSON.
    #[pymodule_export]
    const CODES: &str = bimodal_stereo::CODES;

    /// Version of the bindings, equal to the package's.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
