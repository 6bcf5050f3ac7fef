//! Solvers for trundle: robust least squares on manifolds and Schur bundle adjustment.
