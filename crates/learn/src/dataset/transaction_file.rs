//! Transactions of a run, as FTR or Parquet.
//!
//! FTR has a stream of each kind with one generator, times in picoseconds as a waveform has them, and a relation from
//! the transaction that another comes from, named after both. Parquet has a row for each transaction: `id`, `stream`,
//! `begin_ps`, `end_ps`, `origin` (the number of the transaction that it comes from; of an estimation, the first of its
//! counts), and a column for each attribute, null where a stream has none.

use std::path::{Path, PathBuf};

use parquet::data_type::{ByteArray, ByteArrayType, Int64Type};
use parquet::errors::Result as Written;

use tofsim::error::{Input, Result};
use tofsim::files::output::OutputFile;
use tofsim::sim::transactions::{Origin, Stream, Transaction};

use super::ftr::{FtrAttribute, FtrPlace, FtrWriter};
use super::parquet_table::{ParquetTable, RowGroup};
use super::transaction_columns::ATTRIBUTES;

/// Unit of times, as a power of ten [s].
const PICOSECONDS: i8 = -12;

/// The file under construction; nothing is left of it unless [`TransactionFile::finish`] is called.
pub struct TransactionFile {
    path: PathBuf,
    file: Format,
}

enum Format {
    Ftr(Box<FtrWriter>),
    Parquet(Box<ParquetTable<Transaction>>),
}

impl TransactionFile {
    /// Begins a file; its ending decides the format. `record` goes into the dictionary of FTR and into Parquet's
    /// metadata.
    ///
    /// # Errors
    /// When the ending is another, or the file cannot be written.
    pub fn create(path: &Path, record: &str) -> Result<Self> {
        let ending = path.extension().unwrap_or_default();
        let file = if ending == "ftr" {
            let streams = Stream::ALL.map(Stream::name);
            Format::Ftr(Box::new(FtrWriter::create(path, PICOSECONDS, &streams, record)?))
        } else if ending == "parquet" {
            let provenance = ("provenance", record.to_owned());
            let file = OutputFile::create(path)?;
            Format::Parquet(Box::new(ParquetTable::create(file, &schema(), [provenance], fill)?))
        } else {
            let expected = "expected a name that ends in .ftr or .parquet";
            return Err(Input::new("--transactions", expected).value(path.display()).into());
        };
        Ok(TransactionFile { path: path.to_owned(), file })
    }

    /// Adds a transaction.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&mut self, transaction: &Transaction) -> Result<()> {
        match &mut self.file {
            Format::Ftr(file) => write_ftr(file, transaction),
            Format::Parquet(table) => table.write(std::slice::from_ref(transaction)),
        }
    }

    /// Puts the file in place, and returns its path.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn finish(self) -> Result<PathBuf> {
        match self.file {
            Format::Ftr(file) => file.finish()?.commit()?,
            Format::Parquet(table) => table.finish()?.commit()?,
        }
        Ok(self.path)
    }
}

fn write_ftr(file: &mut FtrWriter, transaction: &Transaction) -> Result<()> {
    let attributes = ATTRIBUTES.iter().filter_map(|(name, known, values)| {
        values.ftr(transaction).map(|value| (*name, *known, value))
    });
    let attributes: Vec<FtrAttribute> = attributes.collect();
    let sink = Origin { stream: transaction.stream(), id: transaction.id };
    let times = [transaction.begin, transaction.end].map(|at| at.ps());
    file.transaction(place(sink), times, &attributes)?;
    for source in transaction.origins() {
        let name = format!("{} of {}", sink.stream.name(), source.stream.name());
        file.relation(&name, place(source), place(sink))?;
    }
    Ok(())
}

fn place(transaction: Origin) -> FtrPlace {
    FtrPlace { stream: transaction.stream as usize, id: transaction.id }
}

fn schema() -> String {
    let attributes = ATTRIBUTES.iter().map(|(name, _, values)| values.declaration(name));
    format!(
        "message transactions {{ required int64 id; required binary stream (UTF8); \
         required int64 begin_ps; required int64 end_ps; optional int64 origin; {}}}",
        attributes.collect::<String>()
    )
}

fn fill(group: &mut RowGroup, rows: &[Transaction]) -> Written<()> {
    let all = || rows.iter();
    group.required::<Int64Type>(all().map(|row| row.id as i64))?;
    group.required::<ByteArrayType>(all().map(|row| ByteArray::from(row.stream().name())))?;
    group.required::<Int64Type>(all().map(|row| row.begin.ps() as i64))?;
    group.required::<Int64Type>(all().map(|row| row.end.ps() as i64))?;
    group.optional::<Int64Type>(all().map(|row| row.origin.map(|origin| origin.id as i64)))?;
    ATTRIBUTES.iter().try_for_each(|(_, _, values)| values.fill(group, rows))
}
