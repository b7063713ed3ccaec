//! The grammar, and a rule for each of its names.

use pest_derive::Parser;

#[derive(Parser)]
#[grammar = "../grammar/track.pest"]
pub(super) struct Grammar;
