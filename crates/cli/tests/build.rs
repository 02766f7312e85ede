//! `tofsim build`: an instrument from one file, as its user meets it.

mod files;
mod page;
mod resumed;
mod walk;

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{empty, output};

/// Sixteen bins, two neurons, a chain of 24 taps, few shots.
pub const SMALL: &str = "description = \"A small <instrument> & its page\"\n\
    [target]\ndistance_m = 0.4\n[tdc]\nbins = 16\nbin_ps = 400\nprofile = \"./small_chain.toml\"\n\
    [firmware]\nshots_per_frame = 500\ncount_bits = 9\n\
    [training]\nneurons = 2\nrecipe = \"quick\"\n[training.grid]\n\
    \"target.distance_m\" = \"0.2..0.7:0.1\"\n\"target.reflectance\" = \"0.2,0.5\"\n";
const CHAIN: &str = "offset_ps = 2000\ntap_ps = 400\ntaps = 24\n";

/// All steps that call neither Yosys nor Icarus.
pub const ALONE: &str = "network,verilog,constraints,vectors,frame,accuracy,report";

/// A folder with the small instrument's files.
pub fn small() -> TempDir {
    let folder = empty();
    fs::write(folder.path().join("small.toml"), SMALL).unwrap();
    fs::write(folder.path().join("small_chain.toml"), CHAIN).unwrap();
    folder
}

/// A quick build with more options: its status, and what it said.
pub fn build(folder: &Path, more: &[&str]) -> (i32, String) {
    let args = [&["build", "small.toml", "-o", "out", "--quick"][..], more].concat();
    let done = output(folder, &args);
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(!said.contains("panicked"), "{said}");
    (done.status.code().unwrap(), said)
}

/// The journal of a build into the folder `out`.
pub fn journal(folder: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.join("out/build.json")).unwrap()).unwrap()
}

/// Asserts that a build with every step has counted cycles, proven them, and counted primitives.
pub fn is_whole(journal: &Value) {
    let steps = &journal["steps"];
    let counts = steps["cycles"]["result"]["counts"].as_array().unwrap();
    assert!(!counts.is_empty());
    for count in counts {
        assert_eq!(count["expected"], count["rtl"], "{count}");
        assert_eq!(count["proven"], true, "{count}");
    }
    for part in ["kintex7", "ecp5"] {
        let used = &steps["cost"]["result"]["parts"][part];
        let [lut, dsp] = ["lut", "dsp"].map(|what| used[what].as_u64().unwrap());
        assert!((100..20_000).contains(&lut) && dsp > 0, "{part}: {used}");
    }
}
