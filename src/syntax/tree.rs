//! The syntax tree: the parts of a file with their places, without the meaning of words.

use crate::diag::{FileId, Span};

/// One file as read; unreadable parts are reported and left out, or are [`ValueKind::Error`].
#[derive(Debug, Clone, PartialEq)]
pub struct Tree {
    pub file: FileId,
    pub items: Vec<Item>,
}

#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    Use(Use),
    Let(Let),
    Declaration(Declaration),
}

impl Item {
    /// The whole item.
    pub fn span(&self) -> Span {
        match self {
            Item::Use(used) => used.span,
            Item::Let(binding) => binding.span,
            Item::Declaration(declaration) => declaration.span,
        }
    }

    /// The `///` lines above it.
    pub fn docs(&self) -> &[String] {
        match self {
            Item::Use(_) => &[],
            Item::Let(binding) => &binding.docs,
            Item::Declaration(declaration) => &declaration.docs,
        }
    }
}

/// `use site.gravel as stone`
#[derive(Debug, Clone, PartialEq)]
pub struct Use {
    pub path: Path,
    pub alias: Option<Name>,
    pub span: Span,
}

/// `let first = 0.10 N/mm^3`
#[derive(Debug, Clone, PartialEq)]
pub struct Let {
    pub name: Name,
    pub value: Value,
    /// The `///` lines above it, without the slashes.
    pub docs: Vec<String>,
    pub span: Span,
}

/// `kind name : base { fields }`
#[derive(Debug, Clone, PartialEq)]
pub struct Declaration {
    pub kind: Name,
    pub name: Option<Name>,
    pub base: Option<Path>,
    pub fields: Vec<Field>,
    pub docs: Vec<String>,
    pub span: Span,
}

/// `path = value`
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    pub path: Path,
    pub value: Value,
    pub docs: Vec<String>,
    pub span: Span,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Name {
    pub text: String,
    pub span: Span,
}

/// One or more names joined by dots.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    pub names: Vec<Name>,
    pub span: Span,
}

impl Path {
    pub fn text(&self) -> String {
        self.names.iter().map(|n| n.text.as_str()).collect::<Vec<_>>().join(".")
    }
}

#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    pub kind: ValueKind,
    pub span: Span,
}

#[derive(Debug, Clone, PartialEq)]
pub enum ValueKind {
    Number {
        value: f64,
        unit: Option<UnitText>,
    },
    Text(String),
    /// `?`
    Hole,
    /// `[entries] unit`
    List {
        entries: Vec<Entry>,
        unit: Option<UnitText>,
    },
    /// `word(arguments)`
    Call {
        word: Name,
        arguments: Vec<Argument>,
    },
    /// `base { fields }`
    Object {
        base: Option<Path>,
        fields: Vec<Field>,
    },
    Path(Path),
    /// `a .. b`
    Range(Box<Value>, Box<Value>),
    /// `value per basis`
    Per(Box<Value>, Name),
    Binary(Box<Value>, BinaryOp, Box<Value>),
    Negate(Box<Value>),
    /// `a < b <= c`: one more operand than operators.
    Compare {
        operands: Vec<Value>,
        operators: Vec<Comparison>,
    },
    /// Could not be read and is already reported.
    Error,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    pub key: Option<Value>,
    pub value: Value,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Argument {
    pub name: Option<Name>,
    pub value: Value,
}

/// A unit as written, not yet looked up.
#[derive(Debug, Clone, PartialEq)]
pub struct UnitText {
    pub text: String,
    pub span: Span,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum BinaryOp {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

impl BinaryOp {
    pub fn symbol(self) -> &'static str {
        match self {
            BinaryOp::Add => "+",
            BinaryOp::Subtract => "-",
            BinaryOp::Multiply => "*",
            BinaryOp::Divide => "/",
            BinaryOp::Power => "^",
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Comparison {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

impl Comparison {
    pub fn symbol(self) -> &'static str {
        match self {
            Comparison::Less => "<",
            Comparison::LessOrEqual => "<=",
            Comparison::Greater => ">",
            Comparison::GreaterOrEqual => ">=",
        }
    }
}
