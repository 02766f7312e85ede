//! The vectors of a block, and the files they become.

use std::io::Write;
use std::path::Path;

use tofsim::error::Result;
use tofsim::files::output::{create_directory, write_file};
use tofsim::kernel::Time;
use tofsim::network::mem::{Mem, lines};

use super::bench::Bench;
use super::block::{Parameter, Spec};
use super::cover::Cover;
use super::ports;
use super::table::Table;

/// What a block was given and what it did.
#[derive(Debug)]
pub struct Vectors {
    /// The block.
    pub spec: &'static Spec,
    /// Seed of the stimulus.
    pub seed: u64,
    /// Name of the scenario.
    pub source: String,
    /// Hidden neurons of the network.
    pub neurons: usize,
    /// Verilog parameters.
    pub parameters: Vec<(&'static str, Parameter)>,
    /// What goes in: line k is taken by edge k.
    pub stimulus: Table,
    /// What comes out: line k is seen just before edge k.
    pub expected: Table,
    /// Edge 0 [ps].
    pub first_edge_ps: u64,
    /// When `tdc_stop` changes; it starts low.
    pub stops: Vec<Time>,
    /// Memories that the Verilog loads.
    pub roms: Vec<Mem>,
    /// What the stimulus has reached.
    pub coverage: Vec<Cover>,
}

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
        for rom in &self.roms {
            write_file(&folder.join(rom.name), |file| file.write_all(rom.text.as_bytes()))?;
        }
        if !self.stops.is_empty() {
            let times = self.stops.iter().map(|at| at.fs().into());
            let text = lines(times, 16);
            write_file(&folder.join("tdc_stop.mem"), |file| file.write_all(text.as_bytes()))?;
        }
        let table =
            |table: &Table, name: &str| write_file(&folder.join(name), |file| table.write(file));
        table(&self.stimulus, "stimulus.mem")?;
        table(&self.expected, "expected.mem")?;
        let ports = ports::json(self);
        write_file(&folder.join("ports.json"), |file| writeln!(file, "{ports:#}"))?;
        let bench = bench.text();
        write_file(&folder.join(self.bench_name()), |file| file.write_all(bench.as_bytes()))
    }
}
