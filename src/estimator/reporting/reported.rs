//! The report of a run, in working units and in the caller's units.

use std::ops::{Deref, DerefMut};

use super::units;
use crate::report::StepReport;
use crate::view::WorkingSize;

/// A report that is kept in working units and given out in the caller's.
pub struct Reported {
    own: StepReport,
    /// The report in the caller's units, if these differ.
    out: Option<Box<StepReport>>,
}

impl Reported {
    pub const fn new(report: StepReport) -> Self {
        Self { own: report, out: None }
    }

    /// Updates the report that is given out.
    pub fn translate(&mut self, resizing: Option<&WorkingSize>) {
        self.out = resizing.map(|resizing| Box::new(units::report_out(resizing, &self.own)));
    }

    /// The report as of the last [`translate`](Self::translate).
    pub fn given_out(&self) -> &StepReport {
        self.out.as_deref().unwrap_or(&self.own)
    }
}

impl Deref for Reported {
    type Target = StepReport;

    fn deref(&self) -> &StepReport {
        &self.own
    }
}

impl DerefMut for Reported {
    fn deref_mut(&mut self) -> &mut StepReport {
        &mut self.own
    }
}
