//! Files that a robot file names: the STL files of its bodies.

use funicular_study::robot_file::MAX_BYTES;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Reader of the files that a robot file in this folder names, for
/// [`with_meshes`](funicular_study::robot_file::with_meshes): no more than its limit, and one byte that shows that
/// there is more.
pub fn beside(folder: &Path) -> impl Fn(&str) -> io::Result<Vec<u8>> {
    move |name| {
        let mut bytes = Vec::new();
        File::open(folder.join(name))?.take(MAX_BYTES as u64 + 1).read_to_end(&mut bytes)?;
        Ok(bytes)
    }
}
