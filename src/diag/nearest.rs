//! Nearest name.
