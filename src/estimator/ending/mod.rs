//! How an iteration ends, and the run: the new solution is accepted or taken back, shapes settle, and the evidence gives a
//! verdict.
//!
//! | file | what it holds |
//! |---|---|
//! | `acceptance` | the comparison of the new solution with the last accepted one |
//! | `settling` | which shapes have settled |
//! | `evidence` | what the verdict is based on |
//! | `verdict` | the status and its reason, a pure function of the evidence |

mod acceptance;
mod evidence;
pub mod settling;
mod verdict;
