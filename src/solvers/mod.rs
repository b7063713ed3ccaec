//! Solvers: SI numbers in, SI numbers out.
