//! A value that cannot be used after a panic. Requires only the standard library, so that its tests run without Python.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;

/// The reason why a call returned nothing.
#[derive(Debug, PartialEq)]
pub enum BrokenOff {
    /// It panicked with this message.
    Now(String),
    /// An earlier call panicked, and the state that it left is suspect.
    Earlier,
}

/// Runs work that should never panic.
pub fn guarded<R>(work: impl FnOnce() -> R) -> Result<R, BrokenOff> {
    // Values that the work touched are not used afterwards: they are dropped, or behind a poisoned lock.
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| BrokenOff::Now(text(&*payload)))
}

fn text(payload: &(dyn Any + Send)) -> String {
    let literal = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
    literal.or_else(|| payload.downcast_ref().cloned()).unwrap_or_default()
}

/// One value shared by several threads, which wait for each other.
pub struct Guarded<T>(Mutex<T>);

impl<T> Guarded<T> {
    pub const fn new(value: T) -> Self {
        Self(Mutex::new(value))
    }

    /// Runs work on the value. The lock is taken inside, so that a panic poisons the lock.
    pub fn call<R>(&self, work: impl FnOnce(&mut T) -> R) -> Result<R, BrokenOff> {
        guarded(|| {
            let mut value = self.0.lock().map_err(|_| BrokenOff::Earlier)?;
            Ok(work(&mut value))
        })?
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_told_once_and_remembered() {
        let value = Guarded::new(1);
        assert_eq!(value.call(|value| *value + 1), Ok(2));
        assert_eq!(value.call(|_| panic!("index {}", 3)), Err::<(), _>(BrokenOff::Now("index 3".to_owned())));
        assert_eq!(value.call(|value| *value), Err(BrokenOff::Earlier));
        assert_eq!(Guarded::new(1).call(|value| *value), Ok(1));
    }

    #[test]
    fn a_panic_without_a_value_is_an_error_as_well() {
        assert_eq!(guarded(|| panic!("told")), Err::<(), _>(BrokenOff::Now("told".to_owned())));
        assert_eq!(guarded(|| 5), Ok(5));
    }
}
