//! Modal assurance criterion (MAC) of two motions.

/// Modal assurance criterion (MAC) of two motions [-]: the squared cosine of the angle between them,
/// `(aᵀMb)²/((aᵀMa)(bᵀMb))`, where `inner(a, b)` is `aᵀMb`. It is 1 for motions that differ only in size or sign. It is
/// 0 for motions without kinetic energy in common, and if one of them is zero.
///
/// # Example
/// ```
/// # use funicular::modes::mac;
/// let inner = |a: &[f64; 2], b: &[f64; 2]| a[0] * b[0] + a[1] * b[1];
/// assert_eq!(mac(&[3.0, 0.0], &[-2.0, 0.0], inner), 1.0);
/// assert!((mac(&[1.0, 0.0], &[1.0, 1.0], inner) - 0.5).abs() < 1e-15);
/// ```
///
/// # References
/// R. J. Allemang, The modal assurance criterion: twenty years of use and abuse, Sound and Vibration 37 (2003).
pub fn mac<V: ?Sized>(a: &V, b: &V, inner: impl Fn(&V, &V) -> f64) -> f64 {
    let both = inner(a, a) * inner(b, b);
    // Rounding may take the cosine above 1.
    if both > 0.0 { (inner(a, b).powi(2) / both).min(1.0) } else { 0.0 }
}
