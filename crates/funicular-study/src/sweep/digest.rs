//! Digests that identify a list of poses or a text.

use sha2::{Digest, Sha256};

/// SHA-256 of the bits of all poses, in hexadecimal digits.
pub(super) fn of_poses(poses: &[[f64; 6]]) -> String {
    let mut sha = Sha256::new();
    poses.iter().flatten().for_each(|value| sha.update(value.to_bits().to_le_bytes()));
    format!("{:x}", sha.finalize())
}

/// SHA-256 of a text, in hexadecimal digits.
pub(crate) fn of_text(text: &str) -> String {
    format!("{:x}", Sha256::digest(text.as_bytes()))
}
