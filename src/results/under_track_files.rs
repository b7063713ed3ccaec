//! `grains.parquet` and `contacts.parquet`: the beds under a track at the recorded counts, one row a pebble and one a
//! contact.
//!
//! Columns that count are INT64, all others FLOAT, compressed with Snappy. The metadata of finished files hold units
//! and what made the run (`about.rs`). Equal rows make equal bytes.

use super::about::{self, Units};
use super::columns::{read_column, undamaged, write_column};
use super::error::check_finite;
use super::{BedsAtCount, Grain, Link, NamedBytes, Provenance, ResultsError};
use bytes::Bytes;
use parquet::basic::{Compression, Repetition, Type as Physical};
use parquet::data_type::{FloatType, Int64Type};
use parquet::errors::Result as ParquetResult;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::Arc;

const GRAINS: &str = "grains.parquet";
const CONTACTS: &str = "contacts.parquet";

/// Columns of whole numbers, then those of others with their units.
type Columns = (&'static [&'static str], &'static [(&'static str, &'static str)]);

const OF_GRAINS: Columns = (
    &["axles", "under_train", "body", "coordination"],
    &[
        ("x_m", "m"),
        ("y_m", "m"),
        ("z_m", "m"),
        ("radius_m", "m"),
        ("vx_m_s", "m/s"),
        ("vy_m_s", "m/s"),
        ("vz_m_s", "m/s"),
        ("dx_m", "m"),
        ("dy_m", "m"),
        ("dz_m", "m"),
        ("largest_force_N", "N"),
    ],
);
/// The second body of a contact with a wall is -1.
const OF_CONTACTS: Columns = (
    &["axles", "under_train", "first_body", "second_body"],
    &[
        ("from_x_m", "m"),
        ("from_y_m", "m"),
        ("from_z_m", "m"),
        ("to_x_m", "m"),
        ("to_y_m", "m"),
        ("to_z_m", "m"),
        ("force_x_N", "N"),
        ("force_y_N", "N"),
        ("force_z_N", "N"),
        ("normal_x", "1"),
        ("normal_y", "1"),
        ("normal_z", "1"),
        ("overlap_m", "m"),
    ],
);

/// The numbers of a row: whole ones, and others.
type Row = (Vec<i64>, Vec<f32>);

/// Rows that are held in columns at once.
const GROUP_ROWS: usize = 1 << 18;

/// Both files; none if no bed was recorded.
pub(super) fn files(
    beds: &[BedsAtCount],
    made_by: &Provenance,
    directory: &Path,
) -> Result<Vec<NamedBytes>, ResultsError> {
    if beds.is_empty() {
        return Ok(Vec::new());
    }
    let [grains, contacts] = encode(beds, Some(made_by), directory)?;
    Ok(vec![(GRAINS.to_owned(), grains), (CONTACTS.to_owned(), contacts)])
}

/// The bytes of both files, which say what made them where the run is finished.
pub(super) fn encode(
    beds: &[BedsAtCount],
    made_by: Option<&Provenance>,
    directory: &Path,
) -> Result<[Vec<u8>; 2], ResultsError> {
    let grains = beds.iter().flat_map(|bed| bed.grains.iter().map(|grain| of_grain(bed, grain)));
    let contacts = beds.iter().flat_map(|bed| bed.links.iter().map(|link| of_link(bed, link)));
    Ok([
        bytes((GRAINS, OF_GRAINS), &grains.collect::<Vec<_>>(), made_by, directory)?,
        bytes((CONTACTS, OF_CONTACTS), &contacts.collect::<Vec<_>>(), made_by, directory)?,
    ])
}

/// The beds of a directory; none if it has none.
pub(super) fn read(directory: &Path) -> Result<Vec<BedsAtCount>, ResultsError> {
    let [grains, contacts] = [GRAINS, CONTACTS].map(|name| directory.join(name));
    if !grains.exists() {
        return Ok(Vec::new());
    }
    let bytes = |path: &Path| fs::read(path).map_err(|cause| ResultsError::io(path, "read", cause));
    decode([bytes(&grains)?, bytes(&contacts)?], directory)
}

/// The beds that the bytes of both files hold; `directory` stands in messages only.
pub(super) fn decode([grains, contacts]: [Vec<u8>; 2], directory: &Path) -> Result<Vec<BedsAtCount>, ResultsError> {
    let mut beds: BTreeMap<(u64, bool), BedsAtCount> = BTreeMap::new();
    let [of_grains, of_contacts] = [GRAINS, CONTACTS].map(|name| directory.join(name));
    for row in undamaged(&of_grains, || rows(OF_GRAINS, grains, &of_grains))? {
        beds.entry(when(&row)).or_default().grains.push(to_grain(&row));
    }
    for row in undamaged(&of_contacts, || rows(OF_CONTACTS, contacts, &of_contacts))? {
        beds.entry(when(&row)).or_default().links.push(to_link(&row));
    }
    Ok(beds.into_iter().map(|((axles, under_train), bed)| BedsAtCount { axles, under_train, ..bed }).collect())
}

/// Count of a row, and whether it is under a train.
fn when((whole, _): &Row) -> (u64, bool) {
    (whole[0] as u64, whole[1] != 0)
}

fn of_grain(bed: &BedsAtCount, grain: &Grain) -> Row {
    let [x, y, z] = grain.place;
    let ([u, v, w], [dx, dy, dz]) = (grain.velocity, grain.displacement.unwrap_or_default());
    let numbers = [x, y, z, grain.radius, u, v, w, dx, dy, dz, grain.largest_force];
    (
        vec![bed.axles as i64, bed.under_train.into(), grain.body.into(), grain.coordination.into()],
        numbers.map(|n| n as f32).to_vec(),
    )
}

fn to_grain((whole, numbers): &Row) -> Grain {
    let three = |from: usize| [0, 1, 2].map(|c| f64::from(numbers[from + c]));
    Grain {
        place: three(0),
        radius: f64::from(numbers[3]),
        body: whole[2] as u32,
        velocity: three(4),
        displacement: Some(three(7)),
        coordination: whole[3] as u32,
        largest_force: f64::from(numbers[10]),
    }
}

fn of_link(bed: &BedsAtCount, link: &Link) -> Row {
    let second = link.bodies.1.map_or(-1, i64::from);
    let numbers = [link.from, link.to, link.force, link.normal].into_iter().flatten().chain([link.overlap]);
    (vec![bed.axles as i64, bed.under_train.into(), link.bodies.0.into(), second], numbers.map(|n| n as f32).collect())
}

fn to_link((whole, numbers): &Row) -> Link {
    let three = |from: usize| [0, 1, 2].map(|c| f64::from(numbers[from + c]));
    Link {
        from: three(0),
        to: three(3),
        bodies: (whole[2] as u32, u32::try_from(whole[3]).ok()),
        force: three(6),
        normal: three(9),
        overlap: f64::from(numbers[12]),
    }
}

fn bytes(
    (name, columns): (&str, Columns),
    rows: &[Row],
    made_by: Option<&Provenance>,
    directory: &Path,
) -> Result<Vec<u8>, ResultsError> {
    for (number, (_, values)) in rows.iter().enumerate() {
        for ((column, _), value) in columns.1.iter().zip(values) {
            check_finite(name, column, number + 1, f64::from(*value))?;
        }
    }
    write(columns, rows, made_by).map_err(|cause| ResultsError::unwritable(&directory.join(name), cause))
}

fn described((whole, others): Columns) -> impl Iterator<Item = (&'static str, Physical)> + Clone {
    let others = others.iter().map(|(name, _)| (*name, Physical::FLOAT));
    whole.iter().map(|name| (*name, Physical::INT64)).chain(others)
}

fn units((whole, others): Columns) -> Units<'static> {
    whole.iter().map(|name| (*name, "1")).chain(others.iter().copied()).collect()
}

fn write(columns: Columns, rows: &[Row], made_by: Option<&Provenance>) -> ParquetResult<Vec<u8>> {
    let column = |(name, physical)| {
        let builder = Type::primitive_type_builder(name, physical);
        builder.with_repetition(Repetition::REQUIRED).build().map(Arc::new)
    };
    let fields = described(columns).map(column).collect::<ParquetResult<Vec<_>>>()?;
    let schema = Arc::new(Type::group_type_builder("rows").with_fields(fields).build()?);
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(concat!("trackbed ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_key_value_metadata(about::entries(&units(columns), made_by))
        .build();
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties))?;
    for rows in rows.chunks(GROUP_ROWS) {
        let mut group = writer.next_row_group()?;
        for index in 0..columns.0.len() {
            write_column::<Int64Type, _>(&mut group, rows.iter().map(|row| row.0[index]).collect())?;
        }
        for index in 0..columns.1.len() {
            write_column::<FloatType, _>(&mut group, rows.iter().map(|row| row.1[index]).collect())?;
        }
        group.close()?;
    }
    writer.close()?;
    Ok(bytes)
}

fn rows(columns: Columns, bytes: Vec<u8>, path: &Path) -> Result<Vec<Row>, ResultsError> {
    let malformed = |cause: &dyn std::fmt::Display| ResultsError::malformed(path, cause);
    let reader = SerializedFileReader::new(Bytes::from(bytes)).map_err(|cause| malformed(&cause))?;
    let schema = reader.metadata().file_metadata().schema_descr();
    let names: Vec<&str> = described(columns).map(|(name, _)| name).collect();
    let mut pairs = schema.columns().iter().zip(described(columns));
    let alike = pairs.all(|(found, (name, physical))| found.name() == name && found.physical_type() == physical);
    if !alike || schema.columns().len() != names.len() {
        return Err(malformed(&format!("expected columns `{}`", names.join(", "))));
    }
    let mut all = Vec::new();
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group).map_err(|cause| malformed(&cause))?;
        read_group(columns, group.as_ref(), &mut all).map_err(|cause| malformed(&cause))?;
    }
    for (number, (_, values)) in all.iter().enumerate() {
        if let Some((column, _)) = columns.1.iter().zip(values).find(|(_, value)| !value.is_finite()) {
            return Err(ResultsError::read_not_finite(path, column.0, number + 1));
        }
    }
    Ok(all)
}

fn read_group(columns: Columns, group: &dyn RowGroupReader, rows: &mut Vec<Row>) -> ParquetResult<()> {
    let count = columns.0.len();
    let whole = (0..count).map(|c| read_column::<Int64Type>(group, c)).collect::<ParquetResult<Vec<_>>>()?;
    let others =
        (0..columns.1.len()).map(|c| read_column::<FloatType>(group, count + c)).collect::<ParquetResult<Vec<_>>>()?;
    let row = |r: usize| (whole.iter().map(|c| c[r]).collect(), others.iter().map(|c| c[r]).collect());
    rows.extend((0..group.metadata().num_rows() as usize).map(row));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::example;

    fn bed(axles: u64, under_train: bool) -> BedsAtCount {
        let grain = |body: u32| Grain {
            place: [-3.5, 0.75, -0.25 * f64::from(body)],
            radius: 0.03125,
            body,
            velocity: [0.0, 0.0, -0.5],
            displacement: Some([0.0, 0.0, -0.001953125]),
            coordination: 6,
            largest_force: 1500.0,
        };
        let link = |second: Option<u32>| Link {
            from: [-3.5, 0.75, 0.0],
            to: [-3.5, 0.75, -0.25],
            bodies: (0, second),
            force: [0.0, 0.5, 120.0],
            normal: [0.0, 0.0, 1.0],
            overlap: 0.0009765625,
        };
        let (grains, links) = (vec![grain(0), grain(1)], vec![link(Some(1)), link(None)]);
        BedsAtCount { axles, under_train, grains, links }
    }

    #[test]
    fn beds_come_back_from_their_files() {
        let directory = tempfile::tempdir().unwrap();
        let beds = vec![bed(0, false), bed(0, true), bed(40, false)];
        let provenance = example::transition().summary.provenance;
        let files = files(&beds, &provenance, directory.path()).unwrap();
        super::super::write_files(&files, directory.path()).unwrap();
        assert_eq!(read(directory.path()).unwrap(), beds);
        let mut wrong = bed(0, false);
        wrong.grains[1].place[2] = f64::NAN;
        let error =
            super::super::under_track_files::files(&[wrong], &provenance, directory.path()).unwrap_err().to_string();
        assert!(error.contains("column `z_m` of row 2"), "{error}");
    }

    #[test]
    fn a_damaged_file_is_told_by_name() {
        let directory = tempfile::tempdir().unwrap();
        assert!(read(directory.path()).unwrap().is_empty());
        let provenance = example::transition().summary.provenance;
        let files = files(&[bed(0, false)], &provenance, directory.path()).unwrap();
        super::super::write_files(&files, directory.path()).unwrap();
        fs::write(directory.path().join(CONTACTS), "PAR1 and nothing else").unwrap();
        let error = read(directory.path()).unwrap_err().to_string();
        assert!(error.contains("contacts.parquet"), "{error}");
    }
}
