//! A comparison for programs: `compare.json`.

use super::{Comparison, NumberRow, PointRow, Subject};
use serde_json::{Value, json};

impl Comparison {
    /// Everything that the tables hold, in one value; the same for equal directories.
    pub fn json(&self) -> Value {
        json!({
            "kind": self.kind.to_string(),
            "results": self.subjects.iter().map(subject).collect::<Vec<_>>(),
            "scenes": self.edits,
            "numbers": self.numbers.iter().map(number).collect::<Vec<_>>(),
            "seats": self.seats,
            "points": self.points.iter().map(point).collect::<Vec<_>>(),
        })
    }
}

fn subject(subject: &Subject) -> Value {
    let made = &subject.made;
    json!({
        "name": subject.name,
        "title": made.title,
        "file": made.file,
        "version": made.version,
        "source_sha256": made.sha256,
        "seed": made.seed,
    })
}

fn number(row: &NumberRow) -> Value {
    let value = |value: &Option<super::Number>| {
        value.map(
            |value| json!({ "value": value.value, "confidence": value.confidence, "from_first": value.from_first }),
        )
    };
    json!({ "name": row.name, "unit": row.unit, "values": row.values.iter().map(value).collect::<Vec<_>>() })
}

fn point(row: &PointRow) -> Value {
    json!({
        "point": row.point,
        "measured": row.measured,
        "unit": row.unit,
        "values": row.values,
        "from_first": row.from_first,
    })
}
