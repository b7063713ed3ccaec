//! `histories.parquet`: the long table of everything sampled along a passage, one row a value.
//!
//! Columns `axles` INT64, `time_s` DOUBLE, `quantity` UTF8, `id` UTF8, `x_m` DOUBLE, `value` DOUBLE, `train` UTF8;
//! dictionaries where values repeat, compressed with Snappy. The metadata of a finished file hold the units of its
//! quantities and what made the run (`about.rs`). Equal rows make equal bytes; the file does not depend on the clock.

use super::about::{self, Units};
use super::columns::{read_column, undamaged, write_column};
use super::error::check_finite;
use super::{HistoryRow, Provenance, ResultsError};
use crate::scenario::response::Response;
use bytes::Bytes;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::Result as ParquetResult;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{ChunkReader, FileReader, RowGroupReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{Type, TypePtr};
use std::fs::File;
use std::path::Path;
use std::sync::Arc;

pub(super) const HISTORIES: &str = "histories.parquet";

const COLUMNS: [(&str, Physical); 7] = [
    ("axles", Physical::INT64),
    ("time_s", Physical::DOUBLE),
    ("quantity", Physical::BYTE_ARRAY),
    ("id", Physical::BYTE_ARRAY),
    ("x_m", Physical::DOUBLE),
    ("value", Physical::DOUBLE),
    ("train", Physical::BYTE_ARRAY),
];

/// Rows that are held in columns at once while a file is written or read.
const GROUP_ROWS: usize = 1 << 18;

/// The bytes of the file that holds `rows`, and says what made them where the run is finished.
pub(super) fn encode(
    rows: &[HistoryRow],
    made_by: Option<&Provenance>,
    directory: &Path,
) -> Result<Vec<u8>, ResultsError> {
    for (index, row) in rows.iter().enumerate() {
        check_finite(HISTORIES, "time_s", index + 1, row.time_s)?;
        check_finite(HISTORIES, "x_m", index + 1, row.x_m)?;
        check_finite(HISTORIES, "value", index + 1, row.value)?;
    }
    write_groups(rows, made_by).map_err(|cause| ResultsError::unwritable(&directory.join(HISTORIES), cause))
}

/// The rows of a file.
pub(super) fn decode(path: &Path) -> Result<Vec<HistoryRow>, ResultsError> {
    let file = File::open(path).map_err(|cause| ResultsError::io(path, "read", cause))?;
    undamaged(path, || read_rows(file, path))
}

/// The rows of a file that is in memory; `path` stands in messages only.
pub(super) fn decode_bytes(bytes: Vec<u8>, path: &Path) -> Result<Vec<HistoryRow>, ResultsError> {
    undamaged(path, || read_rows(Bytes::from(bytes), path))
}

fn read_rows(file: impl ChunkReader + 'static, path: &Path) -> Result<Vec<HistoryRow>, ResultsError> {
    let reader = SerializedFileReader::new(file).map_err(|cause| ResultsError::malformed(path, cause))?;
    let schema = reader.metadata().file_metadata().schema_descr();
    let found = schema.columns().iter().map(|c| (c.name(), c.physical_type()));
    if !found.clone().eq(COLUMNS) {
        let name = |(name, physical): (&str, Physical)| format!("{name} {physical}");
        let expected = COLUMNS.map(name).join(", ");
        let found = found.map(name).collect::<Vec<_>>().join(", ");
        return Err(ResultsError::malformed(path, format!("expected columns `{expected}`, found `{found}`")));
    }
    let mut rows = Vec::new();
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group).map_err(|cause| ResultsError::malformed(path, cause))?;
        read_group(group.as_ref(), &mut rows).map_err(|cause| ResultsError::malformed(path, cause))?;
    }
    for (index, row) in rows.iter().enumerate() {
        let numbers = [("time_s", row.time_s), ("x_m", row.x_m), ("value", row.value)];
        if let Some((column, _)) = numbers.into_iter().find(|(_, value)| !value.is_finite()) {
            return Err(ResultsError::read_not_finite(path, column, index + 1));
        }
    }
    Ok(rows)
}

fn schema() -> ParquetResult<TypePtr> {
    let column = |(name, physical)| {
        let text = (physical == Physical::BYTE_ARRAY).then_some(LogicalType::String);
        let builder = Type::primitive_type_builder(name, physical);
        builder.with_repetition(Repetition::REQUIRED).with_logical_type(text).build().map(Arc::new)
    };
    let fields = COLUMNS.into_iter().map(column).collect::<ParquetResult<Vec<_>>>()?;
    Ok(Arc::new(Type::group_type_builder("histories").with_fields(fields).build()?))
}

/// Units of the columns, and of every quantity that occurs.
fn units(rows: &[HistoryRow]) -> Units<'_> {
    let columns = [("axles", "1"), ("time_s", "s"), ("x_m", "m")];
    columns
        .into_iter()
        .chain(rows.iter().filter_map(|row| Some((row.quantity.as_str(), unit(&row.quantity)?))))
        .collect()
}

/// The unit of a quantity. A quantity of a sleeper over a volume of grains has the name of its response.
fn unit(quantity: &str) -> Option<&'static str> {
    Response::of_name(quantity.strip_suffix("_on_grains").unwrap_or(quantity)).map(Response::unit)
}

fn write_groups(rows: &[HistoryRow], made_by: Option<&Provenance>) -> ParquetResult<Vec<u8>> {
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_dictionary_enabled(true)
        .set_created_by(concat!("trackbed ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_key_value_metadata(about::entries(&units(rows), made_by))
        .build();
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, schema()?, Arc::new(properties))?;
    for rows in rows.chunks(GROUP_ROWS) {
        let mut group = writer.next_row_group()?;
        let text = |value: &str| ByteArray::from(value);
        write_column::<Int64Type, _>(&mut group, rows.iter().map(|r| r.axles as i64).collect())?;
        write_column::<DoubleType, _>(&mut group, rows.iter().map(|r| r.time_s).collect())?;
        write_column::<ByteArrayType, _>(&mut group, rows.iter().map(|r| text(&r.quantity)).collect())?;
        write_column::<ByteArrayType, _>(&mut group, rows.iter().map(|r| text(&r.id)).collect())?;
        write_column::<DoubleType, _>(&mut group, rows.iter().map(|r| r.x_m).collect())?;
        write_column::<DoubleType, _>(&mut group, rows.iter().map(|r| r.value).collect())?;
        write_column::<ByteArrayType, _>(&mut group, rows.iter().map(|r| text(&r.train)).collect())?;
        group.close()?;
    }
    writer.close()?;
    Ok(bytes)
}

fn read_group(group: &dyn RowGroupReader, rows: &mut Vec<HistoryRow>) -> ParquetResult<()> {
    let axles = read_column::<Int64Type>(group, 0)?;
    let time = read_column::<DoubleType>(group, 1)?;
    let quantity = read_column::<ByteArrayType>(group, 2)?;
    let id = read_column::<ByteArrayType>(group, 3)?;
    let x = read_column::<DoubleType>(group, 4)?;
    let value = read_column::<DoubleType>(group, 5)?;
    let train = read_column::<ByteArrayType>(group, 6)?;
    for row in 0..axles.len() {
        rows.push(HistoryRow {
            axles: axles[row] as u64,
            time_s: time[row],
            quantity: quantity[row].as_utf8()?.into(),
            id: id[row].as_utf8()?.into(),
            x_m: x[row],
            value: value[row],
            train: train[row].as_utf8()?.into(),
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::{History, InVolume};
    use crate::results::example;
    use std::collections::BTreeMap;

    #[test]
    fn a_file_says_its_units_and_what_made_it() {
        let run = example::transition();
        let made_by = &run.summary.provenance;
        let said = |made_by: Option<&Provenance>| -> BTreeMap<String, String> {
            let bytes = encode(&run.histories, made_by, Path::new("out")).unwrap();
            let reader = SerializedFileReader::new(Bytes::from(bytes)).unwrap();
            let entries = reader.metadata().file_metadata().key_value_metadata().cloned().unwrap_or_default();
            entries.into_iter().map(|entry| (entry.key, entry.value.unwrap())).collect()
        };
        let told = said(Some(made_by));
        let units: BTreeMap<String, String> = serde_json::from_str(&told["trackbed.units"]).unwrap();
        assert_eq!((units["time_s"].as_str(), units["rail_seat_load"].as_str()), ("s", "N"));
        assert!(run.histories.iter().all(|row| units.contains_key(row.quantity.as_str())), "{units:?}");
        assert_eq!(told["trackbed.source_sha256"], made_by.source_sha256);
        assert_eq!(told["trackbed.overrides"], "[\"ore.speed = 190 km/h\"]");
        let of_pandas: serde_json::Value = serde_json::from_str(&told["PANDAS_ATTRS"]).unwrap();
        assert_eq!(of_pandas["units"], serde_json::json!(units));
        assert!(said(None).is_empty(), "pieces of a run are of no run yet");
    }

    #[test]
    fn every_quantity_has_a_unit() {
        let names = History::ALL.into_iter().map(History::name);
        let in_volumes =
            [InVolume::BallastStress, InVolume::SleeperVelocity, InVolume::SleeperAcceleration, InVolume::SleeperForce];
        let found: Vec<_> =
            names.chain(in_volumes.into_iter().map(InVolume::name)).map(|name| (name, unit(name))).collect();
        assert!(found.iter().all(|(_, unit)| unit.is_some()), "{found:?}");
        assert!(found.contains(&("contact_force_on_grains", Some("N"))), "{found:?}");
    }
}
