//! Digest that identifies a list of poses.

use sha2::{Digest, Sha256};

/// SHA-256 of the bits of all poses, in hexadecimal digits.
pub(super) fn of_poses(poses: &[[f64; 6]]) -> String {
    let mut sha = Sha256::new();
    poses.iter().flatten().for_each(|value| sha.update(value.to_bits().to_le_bytes()));
    format!("{:x}", sha.finalize())
}
