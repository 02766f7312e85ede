//! Simulators that a killed run left behind.
//!
//! A run that is killed outright cannot end its children. Each works in the scratch folder of its run,
//! whose name has the run's process, so that the next run finds them. Linux only: elsewhere a simulator
//! ends by itself.

use std::fs;
use std::path::Path;

use tofsim::files::unfinished::{is_gone, process};

/// Ends every process that works in a scratch folder whose run is gone.
#[cfg(target_os = "linux")]
pub fn end() {
    use nix::sys::signal::{Signal, kill};
    use nix::unistd::Pid;
    for entry in fs::read_dir("/proc").into_iter().flatten().flatten() {
        let number = entry.file_name().to_str().and_then(|name| name.parse().ok());
        let Some(number) = number else { continue };
        // Whose folder cannot be seen is somebody else's; in a container numbers mean others than here.
        let Ok(folder) = fs::read_link(entry.path().join("cwd")) else { continue };
        let numbers = |process: &Path| fs::read_link(process.join("ns/pid")).ok();
        let is_ours = numbers(&entry.path()) == numbers(Path::new("/proc/self"));
        if is_ours && is_of_a_dead_run(&folder) {
            // One that has just ended by itself is as good.
            let _ = kill(Pid::from_raw(number), Signal::SIGKILL);
        }
    }
}

/// Ends nothing, since there is no telling who works where.
#[cfg(not(target_os = "linux"))]
pub fn end() {}

#[cfg_attr(not(target_os = "linux"), expect(dead_code))]
fn is_of_a_dead_run(folder: &Path) -> bool {
    // What the system says of a folder that has been removed.
    let folder = folder.to_string_lossy();
    let folder = Path::new(folder.strip_suffix(" (deleted)").unwrap_or(&folder));
    let runs = folder.iter().filter_map(process).flatten();
    runs.last().is_some_and(is_gone)
}

#[cfg(target_os = "linux")]
#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;

    #[test]
    fn a_simulator_whose_run_is_gone_is_ended_and_another_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let mut dead = Command::new("true").spawn().unwrap();
        dead.wait().unwrap();
        let at = |run: u32| folder.path().join(format!(".tofsim-{run}-abc.part/tdc"));
        let sleep = |run: u32| {
            fs::create_dir_all(at(run)).unwrap();
            Command::new("sleep").arg("60").current_dir(at(run)).spawn().unwrap()
        };
        let (mut stray, mut own) = (sleep(dead.id()), sleep(std::process::id()));
        let mut removed = sleep(dead.id());
        fs::remove_dir_all(at(dead.id())).unwrap();
        end();
        assert!(!stray.wait().unwrap().success() && !removed.wait().unwrap().success());
        assert!(own.try_wait().unwrap().is_none(), "its run lives");
        own.kill().unwrap();
        own.wait().unwrap();
    }
}
