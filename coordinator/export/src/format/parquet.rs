//! The table of draws as a Parquet file.

use std::sync::Arc;

use parquet::basic::{Repetition, Type as Kind};
use parquet::data_type::{DoubleType, Int64Type};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{Type, TypePtr};

use crate::draw_table::DrawTable;
use crate::error::ExportError;

/// Writes the table as a file of one row group; the metadata state the unit of each column as `unit.COLUMN`.
///
/// # Errors
/// [`ExportError::Parquet`] if the library refuses the table.
pub fn parquet(table: &DrawTable) -> Result<Vec<u8>, ExportError> {
    let numbers = table.numbers.iter().map(|(name, _)| field(name, Kind::INT64));
    let columns = table
        .columns
        .iter()
        .map(|column| field(&column.name, Kind::DOUBLE));
    let fields = numbers
        .chain(columns)
        .collect::<Result<Vec<TypePtr>, ExportError>>()?;
    let schema = Type::group_type_builder("draws").with_fields(fields).build()?;
    let units = table
        .columns
        .iter()
        .map(|column| KeyValue::new(format!("unit.{}", column.name), column.unit.clone()))
        .collect();
    let properties = WriterProperties::builder()
        .set_key_value_metadata(Some(units))
        .build();
    let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties))?;
    let mut rows = writer.next_row_group()?;
    for (_, values) in &table.numbers {
        if let Some(mut column) = rows.next_column()? {
            column.typed::<Int64Type>().write_batch(values, None, None)?;
            column.close()?;
        }
    }
    for draws in &table.columns {
        if let Some(mut column) = rows.next_column()? {
            column
                .typed::<DoubleType>()
                .write_batch(&draws.values, None, None)?;
            column.close()?;
        }
    }
    rows.close()?;
    Ok(writer.into_inner()?)
}

fn field(name: &str, kind: Kind) -> Result<TypePtr, ExportError> {
    let field = Type::primitive_type_builder(name, kind).with_repetition(Repetition::REQUIRED);
    Ok(Arc::new(field.build()?))
}
