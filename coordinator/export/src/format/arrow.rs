//! The table of draws as an Arrow file (also known as Feather, version 2).

use std::collections::HashMap;
use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, Int64Array, RecordBatch};
use arrow_ipc::writer::FileWriter;
use arrow_schema::{DataType, Field, Schema};

use crate::draw_table::DrawTable;
use crate::error::ExportError;

/// Writes the table as a file; the metadata of each column state its unit.
///
/// # Errors
/// [`ExportError::Arrow`] if the library refuses the table.
pub fn arrow(table: &DrawTable) -> Result<Vec<u8>, ExportError> {
    let mut fields = Vec::new();
    let mut columns: Vec<ArrayRef> = Vec::new();
    for (name, values) in &table.numbers {
        fields.push(Field::new(name, DataType::Int64, false));
        columns.push(Arc::new(Int64Array::from(values.clone())));
    }
    for column in &table.columns {
        let unit = HashMap::from([("unit".to_owned(), column.unit.clone())]);
        fields.push(Field::new(&column.name, DataType::Float64, false).with_metadata(unit));
        columns.push(Arc::new(Float64Array::from(column.values.clone())));
    }
    let schema = Arc::new(Schema::new(fields));
    let batch = RecordBatch::try_new(schema.clone(), columns)?;
    let mut writer = FileWriter::try_new(Vec::new(), &schema)?;
    writer.write(&batch)?;
    Ok(writer.into_inner()?)
}
