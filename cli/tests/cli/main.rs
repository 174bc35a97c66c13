//! The built program as a script sees it: exit codes, what it prints, the files that it leaves.

mod broken;
mod cameras;
mod folder;
mod made;
mod pair;
