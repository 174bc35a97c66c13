//! Performs parts of an estimator's work in another thread, with a separate instance of the module.

use crate::error::Result;
use crate::estimator::finder::initial_pose::TrustRegion;
use crate::estimator::finder::local_optima::RegisteredCandidate;
use crate::estimator::finder::{HalvedPair, search};
use crate::estimator::pair::ViewPair;
use crate::estimator::photometric::PhotometricRegistration;
use crate::options::Options;
use crate::pose::{ImageGrid, Search};
use crate::view::{ColourImage, DepthMap};

use super::refinement::RefinementWorker;
use crate::estimator::finder::task::{Finding, Found, Task, Work};

/// The views that are searched and whose candidates are registered.
enum Searched {
    Views(Box<PhotometricRegistration>),
    Halved(Box<HalvedPair>),
}

impl Searched {
    fn of(pair: &ViewPair) -> Self {
        match HalvedPair::of(pair) {
            Some(halved) => Self::Halved(Box::new(halved)),
            None => Self::Views(Box::new(PhotometricRegistration::new(pair))),
        }
    }

    /// The pair and its photometric registration.
    fn parts<'a>(&'a mut self, pair: &'a ViewPair) -> (&'a ViewPair, &'a mut PhotometricRegistration) {
        match self {
            Self::Views(photometric) => (pair, photometric),
            Self::Halved(halved) => (&halved.pair, &mut halved.photometric),
        }
    }
}

/// Performs tasks of the search, and later refinements, for an [`Estimator`](crate::Estimator) of the same pair and
/// options. Its findings do not depend on earlier ones, except that a refinement may start from the shape of the last
/// one.
pub struct Worker {
    pair: ViewPair,
    /// Memory of the search and of refinements; each is freed before the other is allocated.
    initialisation: Option<(Searched, Search)>,
    refinement: Option<RefinementWorker>,
}

impl Worker {
    /// A worker for one pair.
    ///
    /// # Errors
    /// The errors of [`Estimator::new`](crate::Estimator::new).
    pub fn new(image: ColourImage, depth: &DepthMap, options: Options) -> Result<Self> {
        Ok(Self::of(ViewPair::new(image, depth, options)?))
    }

    /// A worker for checked views.
    pub(in crate::estimator) const fn of(pair: ViewPair) -> Self {
        Self { pair, initialisation: None, refinement: None }
    }

    /// Performs one task of the search, however long it takes.
    ///
    /// # Errors
    /// The errors of the search.
    pub fn perform(&mut self, task: &Task) -> Result<Finding> {
        let Self { pair, initialisation, refinement } = self;
        *refinement = None;
        let (searched, search) = match initialisation {
            Some(memory) => memory,
            none => {
                let mut searched = Searched::of(pair);
                let (pair, photometric) = searched.parts(pair);
                let search = search(pair, ImageGrid::new(&pair.image)?, photometric)?;
                none.insert((searched, search))
            }
        };
        let (pair, photometric) = searched.parts(pair);
        Ok(Finding(match &task.0 {
            Work::Search(task) => Found::Search(search.perform(task)),
            Work::Register(index, start, is_near) => {
                let region = TrustRegion::of(pair).filter(|_| *is_near);
                photometric.keep_near(region.and_then(|region| region.prior(pair)));
                let report = photometric.register_candidate(pair, start);
                Found::Registered(*index, report.map(RegisteredCandidate::of))
            }
        }))
    }

    /// Performs a refinement. `load` fills the planes of its [`RefinementTask`](crate::RefinementTask); those of the
    /// shape initially hold the result of the last refinement. Returns refined depth and normals (x, y, z).
    ///
    /// # Errors
    /// [`ErrorKind::Size`](crate::ErrorKind::Size) if `numbers` are not those of a task.
    pub fn refine(&mut self, numbers: &[f64], load: impl FnOnce([&mut [f32]; 9])) -> Result<[&[f32]; 4]> {
        let Self { pair, initialisation, refinement } = self;
        *initialisation = None;
        let refinement = match refinement {
            Some(memory) => memory,
            none => none.insert(RefinementWorker::new(pair)?),
        };
        load(refinement.planes());
        refinement.refine(pair, numbers)
    }
}
