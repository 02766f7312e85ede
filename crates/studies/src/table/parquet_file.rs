//! Parquet tables, with the provenance in the metadata.

use std::path::Path;

use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};

use tofsim::error::Result;
use tofsim::files::output::OutputFile;
use tofsim_learn::dataset::parquet_table::ParquetTable;

use super::{Cell, Field, Kind, Row};

/// Begins a file with the given columns and metadata.
///
/// # Errors
/// If it cannot be written.
pub fn create(
    path: &Path,
    fields: &[Field],
    metadata: Vec<(&'static str, String)>,
) -> Result<ParquetTable<Row>> {
    let column = |field: &Field| {
        let name = &field.name;
        match field.kind {
            Kind::Whole => format!("optional int64 {name} (INTEGER(64,false)); "),
            Kind::Number => format!("optional double {name}; "),
            Kind::Text => format!("optional binary {name} (UTF8); "),
        }
    };
    let columns: String = fields.iter().map(column).collect();
    let schema = format!("message sweep {{ {columns} }}");
    let fields = fields.to_vec();
    let file = OutputFile::create(path)?;
    ParquetTable::create(file, &schema, metadata, move |group, rows: &[Row]| {
        for (place, field) in fields.iter().enumerate() {
            let cells = rows.iter().map(|row| &row.cells[place]);
            match field.kind {
                Kind::Whole => group.optional::<Int64Type>(cells.map(|cell| match cell {
                    Cell::Whole(number) => Some(*number as i64),
                    _ => None,
                }))?,
                Kind::Number => group.optional::<DoubleType>(cells.map(Cell::as_number))?,
                Kind::Text => group.optional::<ByteArrayType>(cells.map(|cell| match cell {
                    Cell::Text(text) => Some(ByteArray::from(text.as_str())),
                    _ => None,
                }))?,
            }
        }
        Ok(())
    })
}
