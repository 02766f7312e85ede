//! CXXRTL, Yosys's simulator, with the carry chain and the count of its taps in C++.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::builds::Cache;
use crate::compilers::Sources;
use crate::contender::{Call, Contender, SHOTS, Work};
use crate::{Result, run};

/// Options of Yosys's `write_cxxrtl`.
pub const OPTIONS: &str = "-O6 -g0";
/// Options of the C++ compiler.
pub const OPT: &str = "-O3 -march=native -std=c++17 -w";

/// Builds it.
pub fn contender(root: &Path, cache: &Cache) -> Result<Contender> {
    let bench = root.join("benches/peer_simulators");
    let headers = headers()?;
    let verilog = Sources::Cxxrtl.files(root)?;
    let driver = bench.join("cxxrtl/driver.cpp");
    let mut all = verilog.clone();
    all.extend([driver.clone(), bench.join("protocol.h")]);
    let build = |folder: &Path| {
        let design = folder.join("design.cc");
        run::stdout(yosys(&verilog, &design)?.current_dir(root))?;
        let mut command = Command::new("g++");
        command.args(OPT.split_whitespace()).arg("-I").arg(&headers).arg("-I").arg(&bench);
        command.arg(format!("-DDESIGN=\"{}\"", design.display()));
        command.arg("-o").arg(folder.join("driver")).arg(&driver);
        run::stdout(&mut command).map(drop)
    };
    let flags = [OPTIONS.to_string(), OPT.to_string()];
    let folder = cache.get("cxxrtl", &all, &flags, build)?;
    Ok(Contender {
        simulator: "cxxrtl",
        variant: "tuned estimator, chain and count in C++",
        work: Work::Cycle,
        call: Call::Driver(folder.join("driver")),
        frames: 1,
        shots: SHOTS,
        is_slow: false,
        rtl: Sources::Cxxrtl.rtl(),
    })
}

fn yosys(verilog: &[PathBuf], design: &Path) -> Result<Command> {
    let files: Vec<_> = verilog.iter().map(|file| file.display().to_string()).collect();
    if files.iter().any(|file| file.contains(char::is_whitespace)) {
        return Err("Yosys takes no path with a space".into());
    }
    let script = format!(
        "read_verilog -sv -nosynthesis {}; hierarchy -top tof_top; write_cxxrtl {OPTIONS} {}",
        files.join(" "),
        design.display()
    );
    let mut command = Command::new("yosys");
    command.args(["-q", "-p", &script]);
    Ok(command)
}

/// Where `cxxrtl.h` is: in `YOSYS_INCLUDE`, or where Debian's yosys-dev puts it.
fn headers() -> Result<PathBuf> {
    let folder = env::var_os("YOSYS_INCLUDE")
        .map_or_else(|| PathBuf::from("/usr/share/yosys/include"), PathBuf::from);
    if folder.join("backends/cxxrtl/cxxrtl.h").is_file() {
        return Ok(folder);
    }
    let expected = "backends/cxxrtl/cxxrtl.h is missing; install yosys-dev, or set YOSYS_INCLUDE";
    Err(format!("{}: {expected}", folder.display()).into())
}
