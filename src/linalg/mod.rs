//! Systems of equations; knows no physics.
