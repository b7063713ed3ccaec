//! What the store says of a directory, as a diagnostic.

use crate::diag::{Code, Diagnostic};
use crate::store::StoreError;

/// A directory that cannot be used, or not for this.
pub(super) fn diagnostic(error: &StoreError) -> Diagnostic {
    let code = if error.is_of_another() { Code::E0809 } else { Code::E0802 };
    Diagnostic::new(code, error.to_string()).help(error.help())
}
