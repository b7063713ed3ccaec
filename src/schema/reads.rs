//! Fields that each part of the planner reads, and the scenes in which the part acts.

/// Fields that a part of the program reads, and the scenes in which it acts.
#[derive(Debug, PartialEq, Eq)]
pub struct Reads {
    /// Fields as `kind.field`.
    pub fields: &'static [&'static str],
    /// The end of the sentence "they act only ...": `where trains run`.
    pub acts_where: &'static str,
}

/// The fields that a part of the program reads, and whether it acted on a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reader {
    pub reads: &'static Reads,
    pub acted: bool,
}

impl Reads {
    /// Whether the part reads a field, given as `kind.field`.
    pub fn has(&self, field: &str) -> bool {
        self.fields.contains(&field)
    }
}
