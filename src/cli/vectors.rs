//! `tofsim vectors`: the contents of the firmware's ROMs as files for a Verilog simulator.

use std::io::Write;
use std::path::PathBuf;

use crate::error::{Input, Result, nearest};
use crate::firmware::tdc_decoder::Calibration;
use crate::network::Network;
use crate::network::mem::{self, Mem};
use crate::output::{create_directory, write_file};

/// Write a block's ROMs for Verilog's $readmemh
///
/// Each block has a folder of its own: DIR/depth_estimator with w1.mem, b1.mem, w2.mem, b2.mem
/// and tansig.mem, DIR/tdc with tdc_cal.mem. Benches come with a later version.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// depth_estimator, or forward1, tansig, forward2 in it; tdc, or tdc_decoder in it; or all
    block: String,
    /// Directory to write to
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Built-in network (uniform, ideal) or network file
    #[arg(long, value_name = "NAME|FILE", default_value = Network::DEFAULT)]
    network: String,
    /// Delay chain of the TDC
    #[arg(long, value_name = "NAME", default_value = "uniform")]
    profile: String,
}

/// The firmware's modules.
const BLOCKS: &[&str] = &[
    "carry_chain",
    "coarse_counter",
    "code_preload",
    "control_sync",
    "ddr_output",
    "depth_estimator",
    "estimator_ctrl",
    "forward1",
    "forward2",
    "frame_ctrl",
    "histogram_builder",
    "histogram_preload",
    "lvds_output",
    "pll",
    "reset_sync",
    "spad_control",
    "tansig",
    "tdc",
    "tdc_decoder",
    "tdc_latch",
    "tof_top",
    "vcsel_driver",
];

/// Runs the verb.
pub fn run(args: &Args) -> Result<()> {
    let blocks = match args.block.as_str() {
        "all" => vec!["depth_estimator", "tdc"],
        block => vec![block],
    };
    let mut files = Vec::new();
    for block in blocks {
        files.push((block, roms(block, args)?));
    }
    for (block, roms) in files {
        let directory = args.output.join(block);
        create_directory(&directory)?;
        for rom in roms {
            write_file(&directory.join(rom.name), |file| file.write_all(rom.text.as_bytes()))?;
        }
    }
    Ok(())
}

/// The ROMs of a block and the blocks in it.
fn roms(block: &str, args: &Args) -> Result<Vec<Mem>> {
    let params = || Ok::<_, crate::error::Error>(Network::find(&args.network, None)?.params());
    Ok(match block {
        "depth_estimator" => mem::depth_estimator(&params()?),
        "forward1" => mem::forward1(&params()?.forward1).into(),
        "tansig" => vec![mem::tansig(&params()?.tansig)],
        "forward2" => mem::forward2(&params()?.forward2).into(),
        "tdc" | "tdc_decoder" => vec![mem::tdc_decoder(&*calibration(&args.profile)?)],
        _ => return Err(unknown(block).into()),
    })
}

fn unknown(block: &str) -> Input {
    let fault = |expected: String| Input::new("BLOCK", expected).value(block);
    if BLOCKS.contains(&block) {
        return fault("no ROM; benches are not available in this version".to_owned());
    }
    let near = nearest(block, BLOCKS.iter().copied());
    let hint = near.map_or(String::new(), |name| format!(" (did you mean {name}?)"));
    fault(format!("no such block{hint}; expected all or one of {}", BLOCKS.join(", ")))
}

/// The decoder's table for a chain.
fn calibration(profile: &str) -> Result<Box<Calibration>> {
    crate::scenario::chain::calibration(profile)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn args(block: &str, output: &Path) -> Args {
        let (block, output) = (block.to_owned(), output.to_owned());
        Args { block, output, network: "uniform".to_owned(), profile: "uniform".to_owned() }
    }

    #[test]
    fn the_list_of_blocks_is_the_firmware_s() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/firmware");
        let stems = std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
        let files = stems.filter(|path| path.is_file());
        let mut stems: Vec<_> =
            files.map(|p| p.file_stem().unwrap().display().to_string()).collect();
        stems.retain(|stem| stem != "mod");
        stems.sort();
        assert_eq!(stems, BLOCKS);
    }

    #[test]
    fn all_writes_the_estimator_s_and_the_tdc_s_roms_each_in_its_folder() {
        let directory = tempfile::tempdir().unwrap();
        run(&args("all", directory.path())).unwrap();
        let list = |block| {
            let files = std::fs::read_dir(directory.path().join(block)).unwrap();
            let mut names: Vec<_> = files.map(|file| file.unwrap().file_name()).collect();
            names.sort();
            names
        };
        let roms = ["b1.mem", "b2.mem", "tansig.mem", "w1.mem", "w2.mem"];
        assert_eq!(list("depth_estimator"), roms);
        assert_eq!(list("tdc"), ["tdc_cal.mem"]);
    }

    #[test]
    fn a_block_without_roms_and_an_unknown_one_are_told_apart() {
        let nowhere = Path::new("/nonexistent");
        let error = run(&args("pll", nowhere)).unwrap_err().to_string();
        assert_eq!(error, "BLOCK: pll: no ROM; benches are not available in this version");
        let error = run(&args("tdc_decodr", nowhere)).unwrap_err().to_string();
        assert!(error.contains("did you mean tdc_decoder?"), "{error}");
        assert!(error.contains("depth_estimator, estimator_ctrl"), "{error}");
    }
}
