//! One column of a Parquet file, written and read whole.

use parquet::column::reader::get_typed_column_reader;
use parquet::data_type::DataType;
use parquet::errors::{ParquetError, Result as ParquetResult};
use parquet::file::reader::RowGroupReader;
use parquet::file::writer::SerializedRowGroupWriter;

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

/// Reads a column, counted from 0, of a group of rows. Fails where it lacks values.
pub(super) fn read_column<D: DataType>(group: &dyn RowGroupReader, column: usize) -> ParquetResult<Vec<D::T>> {
    let count = group.metadata().num_rows() as usize;
    let mut reader = get_typed_column_reader::<D>(group.get_column_reader(column)?);
    let mut values = Vec::with_capacity(count);
    reader.read_records(count, None, None, &mut values)?;
    if values.len() == count {
        return Ok(values);
    }
    let message = format!("column {column} holds {} values of {count}", values.len());
    Err(ParquetError::General(message))
}
