//! Who reads what: each part of the program that turns fields of a scene into a plan says which ones, and where it acts.

/// Fields that a part of the program reads, and where it acts.
#[derive(Debug, PartialEq, Eq)]
pub struct Reads {
    /// Fields as `kind.field`.
    pub fields: &'static [&'static str],
    /// Goes on after "they act only": `where trains run`.
    pub acts_where: &'static str,
}

/// What a part of the program reads, and whether it acted on a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reader {
    pub reads: &'static Reads,
    pub acted: bool,
}

impl Reads {
    /// Whether it reads a field, given as `kind.field`.
    pub fn has(&self, field: &str) -> bool {
        self.fields.contains(&field)
    }
}
