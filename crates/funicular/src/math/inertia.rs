//! Signs of the eigenvalues of a symmetric matrix.
