//! The files that golden vectors become.

use std::path::Path;

use tofsim::error::Result;
use tofsim::files::output::{create_directory, write_bytes, write_file};
use tofsim::network::mem::lines;

use super::bench::Bench;
use super::ports;
use super::spec::Vectors;

impl Vectors {
    /// File name of the bench.
    pub fn bench_name(&self) -> String {
        format!("tb_{}.v", self.spec.name)
    }

    /// Writes all files into a folder, which is made if it is not there.
    ///
    /// # Errors
    /// When one cannot be written.
    pub fn write(&self, folder: &Path) -> Result<()> {
        self.write_with(folder, &Bench::new(self))
    }

    /// The same with a bench that allows another implementation something.
    ///
    /// # Errors
    /// When one cannot be written.
    pub fn write_with(&self, folder: &Path, bench: &Bench) -> Result<()> {
        create_directory(folder)?;
        let text = |name: &str, text: &str| write_bytes(&folder.join(name), text);
        for memory in self.memories() {
            text(memory.name, &memory.text)?;
        }
        if !self.stops.is_empty() {
            text("tdc_stop.mem", &lines(self.stops.iter().map(|at| at.fs().into()), 16))?;
        }
        for (name, table) in [("stimulus.mem", &self.stimulus), ("expected.mem", &self.expected)] {
            write_file(&folder.join(name), |file| table.write(file))?;
        }
        text("ports.json", &format!("{:#}\n", ports::json(self)))?;
        text(&self.bench_name(), &bench.text())
    }
}
