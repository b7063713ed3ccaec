//! Metadata of the Parquet files of a run: the units of the columns, and what made the run.
//!
//! Each entry has a key that begins with `trackbed.`; pandas puts them all into the `attrs` of its table. No entry
//! depends on the clock or on the machine.

use super::Provenance;
use parquet::file::metadata::KeyValue;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// Units by the name of a column or of a quantity; `1` for a count or a ratio.
pub(super) type Units<'a> = BTreeMap<&'a str, &'static str>;

/// The key under which pandas keeps and looks for the attributes of a table.
const OF_PANDAS: &str = "PANDAS_ATTRS";

/// The entries of a file; none for a file of an unfinished run, such as a piece beside a checkpoint.
pub(super) fn entries(units: &Units<'_>, made_by: Option<&Provenance>) -> Option<Vec<KeyValue>> {
    let made_by = made_by?;
    let said = [
        ("program", json!(made_by.program)),
        ("version", json!(made_by.version)),
        ("file", json!(made_by.file)),
        ("overrides", json!(made_by.overrides)),
        ("seed", json!(made_by.seed)),
        ("source_sha256", json!(made_by.source_sha256)),
        ("source", json!(made_by.source)),
        ("units", json!(units)),
    ];
    // a text as it is, all else as JSON
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let entry = |(key, value): &(&str, Value)| KeyValue::new(format!("trackbed.{key}"), text(value));
    let attributes: Map<String, Value> = said.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
    let of_pandas = KeyValue::new(OF_PANDAS.to_owned(), Value::from(attributes).to_string());
    Some(said.iter().map(entry).chain([of_pandas]).collect())
}
