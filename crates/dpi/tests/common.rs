//! Benches with checkers, compiled and run with Verilator.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use tofsim::Setup;
use tofsim_rtl::checkers::{Checkers, blocks_of};
use tofsim_rtl::verify::simulator::QUICK_TO_COMPILE;

/// Returns the root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

/// Returns the folder of the library, which is that of the test executables.
pub fn library() -> PathBuf {
    let own = std::env::current_exe().unwrap();
    let folder = own.parent().unwrap().to_owned();
    assert!(folder.join("libtofsim_dpi.so").is_file(), "{}: no libtofsim_dpi.so", folder.display());
    folder
}

/// Returns the files of the design: all of rtl_ref except the board tops, which use vendor primitives.
pub fn design() -> Vec<PathBuf> {
    let files = std::fs::read_dir(root().join("rtl_ref")).unwrap().map(|file| file.unwrap().path());
    let is_board = |name: &str| ["kc705_top.v", "ecp5_top.v"].contains(&name);
    let mut files: Vec<_> = files
        .filter(|path| path.extension().is_some_and(|end| end == "v"))
        .filter(|path| !is_board(path.file_name().unwrap().to_str().unwrap()))
        .collect();
    files.sort();
    files
}

/// Writes the checkers of a scenario, for the given blocks or all.
pub fn write(folder: &Path, (scenario, set): (&str, &[&str]), blocks: Option<&[&str]>) {
    let setup = Arc::new(Setup::load(scenario, set).unwrap());
    let all: Vec<_> = blocks_of(&setup).iter().map(|spec| spec.name).collect();
    let told = [&[scenario], set].concat().join("\n");
    let names = blocks.map_or(all, <[_]>::to_vec);
    let checkers = Checkers::new(setup, told, names).unwrap();
    for (name, text) in checkers.files() {
        std::fs::write(folder.join(name), text).unwrap();
    }
    std::fs::write(folder.join("tofsim_vpi.v"), checkers.verilog()).unwrap();
}

/// Builds and runs the example's bench with a design, by the Makefile that `tofsim dpi` writes.
pub fn make(folder: &Path, target: &str, design: &[PathBuf], plusargs: &str) -> Run {
    let own = [
        ("crates/cli/src/verbs/dpi/bench.mk", "Makefile"),
        ("crates/dpi/vpi/tofsim_vpi.c", "tofsim_vpi.c"),
        ("crates/dpi/include/tofsim.h", "tofsim.h"),
    ];
    for (from, to) in own {
        std::fs::copy(root().join(from), folder.join(to)).unwrap();
    }
    let files = design.iter().map(|path| path.display().to_string());
    let files: Vec<_> = files.chain(["examples/bench/tb.sv".to_owned()]).collect();
    let run = Command::new("make")
        .arg("-f")
        .arg(folder.join("Makefile"))
        .args([
            target,
            "TOP=tb",
            &format!("DESIGN={}", files.join(" ")),
            &format!("ARGS={plusargs}"),
        ])
        .arg(format!("LIB={}", library().display()))
        .arg(format!("BUILD={}", folder.join("build").display()))
        .current_dir(root())
        .output()
        .expect("make: apt-get install make");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Run { text: text(&run.stdout) + &text(&run.stderr), is_fine: run.status.success() }
}

/// Output of a simulation, and whether it reached its end.
pub struct Run {
    pub text: String,
    pub is_fine: bool,
}

/// Compiles files with the checkers in a folder, and returns the program.
pub fn compile(folder: &Path, top: &str, files: &[PathBuf], options: &[&str]) -> PathBuf {
    let checkers =
        ["tofsim_pkg.sv", "tofsim_photons.sv", "tofsim_checkers.sv"].map(|name| folder.join(name));
    let rpath = format!("-Wl,-rpath,{}", library().display());
    let built = Command::new("verilator")
        .args([
            "--binary",
            "--timing",
            "-Wno-fatal",
            "-Wno-lint",
            "-Wno-style",
            "-Wno-TIMESCALEMOD",
        ])
        .args(QUICK_TO_COMPILE)
        .args(["--top-module", top, "-o", "bench", "--Mdir"])
        .arg(folder.join("build"))
        .args(options)
        .args(checkers)
        .args(files)
        .arg(folder.join("tofsim_bind.sv"))
        .arg(library().join("libtofsim_dpi.so"))
        .args(["-LDFLAGS", &rpath])
        .output()
        .expect("verilator: apt-get install verilator");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(built.status.success(), "{}{}", text(&built.stdout), text(&built.stderr));
    folder.join("build/bench")
}

/// Runs a program in a folder.
pub fn run(program: &Path, folder: &Path, plusargs: &[&str]) -> Run {
    let run = Command::new(program).args(plusargs).current_dir(folder).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Run { text: text(&run.stdout) + &text(&run.stderr), is_fine: run.status.success() }
}
