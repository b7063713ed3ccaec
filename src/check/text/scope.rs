//! The names that a file declares and brings in.

use crate::diag::FileId;
use crate::syntax::tree::Tree;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The main file, which is read first.
pub const MAIN_FILE: FileId = FileId(0);

/// Index of a scope: one file.
pub type ScopeId = usize;

/// One file with its names.
pub struct Scope {
    pub tree: Arc<Tree>,
    pub library: bool,
    /// Declarations and lets by name: indices of items.
    pub names: BTreeMap<String, usize>,
    pub modules: BTreeMap<String, ScopeId>,
    /// Modules that could not be loaded: their entries are not reported as unknown.
    pub broken: BTreeSet<String>,
}

/// An item of a scope.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ItemId {
    pub scope: ScopeId,
    pub item: usize,
}
