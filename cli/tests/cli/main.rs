//! The built program as a script sees it: exit codes, output, and written files.

mod broken;
mod cameras;
mod folder;
mod made;
mod pair;
