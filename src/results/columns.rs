//! One column of a Parquet file, written and read whole.

use super::ResultsError;
use parquet::column::reader::get_typed_column_reader;
use parquet::data_type::DataType;
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::reader::RowGroupReader;
use parquet::file::writer::SerializedRowGroupWriter;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Reads a file of columns. The library that reads columns panics on some damaged files; the panic becomes an error
/// like any other damage.
pub(super) fn undamaged<T>(path: &Path, read: impl FnOnce() -> Result<T, ResultsError>) -> Result<T, ResultsError> {
    let read = catch_unwind(AssertUnwindSafe(read));
    read.unwrap_or_else(|_| Err(ResultsError::malformed(path, "its columns do not match its footer")))
}

/// Values for which room is made before they are there.
const MOST_AT_ONCE: usize = 1 << 18;

/// Writes the next column of a group of rows.
pub(super) fn write_column<D: DataType, W: std::io::Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    values: Vec<D::T>,
) -> ParquetResult<()> {
    let Some(mut column) = group.next_column()? else {
        return Err(ParquetError::General("the schema has too few columns".to_owned()));
    };
    column.typed::<D>().write_batch(&values, None, None)?;
    column.close()
}

/// Reads a column, counted from 0, of a group of rows. Fails if it lacks values.
pub(super) fn read_column<D: DataType>(group: &dyn RowGroupReader, column: usize) -> ParquetResult<Vec<D::T>> {
    let rows = group.metadata().num_rows();
    let count =
        usize::try_from(rows).map_err(|_| ParquetError::General(format!("the file says that it has {rows} rows")))?;
    let mut reader = get_typed_column_reader::<D>(group.get_column_reader(column)?);
    // a damaged file may say more rows than it holds
    let mut values = Vec::with_capacity(count.min(MOST_AT_ONCE));
    reader.read_records(count, None, None, &mut values)?;
    if values.len() == count {
        return Ok(values);
    }
    let message = format!("column {column} holds {} values of {count}", values.len());
    Err(ParquetError::General(message))
}
