//! The files that a design reads while it is simulated, such as the words of a ROM.

use std::collections::BTreeSet;
use std::path::{Component, Path};

use tofsim::error::{Input, Result, read_bytes};
use tofsim::files::output::{create_directory, write_bytes};

use super::rtl::Rtl;
use super::rtl::mirror::unmarked;

/// Copies what a simulation in `work` has not found from beside the sources, or from the current
/// folder, and says whether there was anything.
///
/// # Errors
/// When a file that is there cannot be copied.
pub(super) fn bring(work: &Path, rtl: &Rtl, said: &str) -> Result<bool> {
    let beside: BTreeSet<_> =
        rtl.files.iter().chain(&rtl.vhdl).filter_map(|file| file.path.parent()).collect();
    let mut brought = false;
    for name in missing(said).map(Path::new).filter(|name| stays_inside(name)) {
        let to = work.join(name);
        let mut places =
            beside.iter().copied().chain([Path::new("")]).map(|place| place.join(name));
        if let Some(from) = places.find(|from| from.is_file() && !to.exists()) {
            create_directory(to.parent().unwrap_or(work))?;
            write_bytes(&to, unmarked(&read_bytes(&from)?))?;
            brought = true;
        }
    }
    Ok(brought)
}

/// Returns whether a design had all that it wanted to read.
///
/// # Errors
/// Names the first file that it had not.
pub(super) fn check(rtl: &Rtl, said: &str) -> Result<()> {
    let Some(name) = missing(said).next() else { return Ok(()) };
    let expected = "the design reads this file, which is neither beside its sources nor in the \
                    current folder";
    Err(Input::new(&rtl.source, expected).value(name).into())
}

/// The files that Icarus and Verilator say they have not found.
fn missing(said: &str) -> impl Iterator<Item = &str> {
    said.lines().filter_map(|line| {
        let icarus = || line.split_once(": Unable to open ")?.1.strip_suffix(" for reading.");
        let verilator = || {
            let (file, _) = line.split_once(":0: $readmem file not found")?;
            file.strip_prefix("%Warning: ")
        };
        icarus().or_else(verilator)
    })
}

fn stays_inside(name: &Path) -> bool {
    name.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_simulators_tell_what_they_have_not_found() {
        let said = "ERROR: a.v:1: $readmemh: Unable to open rom/w1.mem for reading.\n\
            %Warning: b.mem:0: $readmem file not found\ntb: PASS\n";
        assert_eq!(missing(said).collect::<Vec<_>>(), ["rom/w1.mem", "b.mem"]);
        assert!(stays_inside(Path::new("rom/w1.mem")) && !stays_inside(Path::new("../w1.mem")));
        assert!(!stays_inside(Path::new("/rom/w1.mem")));
    }
}
