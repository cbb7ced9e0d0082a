//! Files that the program has read because another file names them, such as meshes and tables: no result replaces them.

use funicular_files::Guard;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Roles and paths of these files.
static NAMED: Mutex<Vec<(&str, PathBuf)>> = Mutex::new(Vec::new());

/// Notes a file that is read; `role` is its name in messages, such as "the mesh".
pub(crate) fn note(role: &'static str, path: &Path) {
    NAMED.lock().unwrap_or_else(PoisonError::into_inner).push((role, path.to_owned()));
}

/// Tells a guard all files that have been read.
pub(crate) fn tell(guard: &mut Guard) {
    for (role, path) in NAMED.lock().unwrap_or_else(PoisonError::into_inner).iter() {
        guard.reads(role, path);
    }
}
