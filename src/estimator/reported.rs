//! The report of a run, in the units of what is worked on and in those of the caller.

use std::ops::{Deref, DerefMut};

use super::units;
use crate::report::StepReport;
use crate::view::WorkingSize;

/// A report that is worked on as itself, and given out in the caller's units.
pub struct Reported {
    own: StepReport,
    /// Where they are others.
    out: Option<Box<StepReport>>,
}

impl Reported {
    pub const fn new(report: StepReport) -> Self {
        Self { own: report, out: None }
    }

    /// Brings what is given out up to date.
    pub fn translate(&mut self, way: Option<&WorkingSize>) {
        self.out = way.map(|way| Box::new(units::report_out(way, &self.own)));
    }

    /// As it was when it was last [translated](Self::translate).
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
