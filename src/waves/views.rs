//! Viewer setups next to a waveform, which show the signals in order, with names and scales.
//!
//! `X.gtkw` is for GTKWave (`gtkwave X.gtkw`), which needs a file of names for each state machine of a VCD; an FST has them
//! itself. `X.sucl` is for Surfer (`surfer --command-file X.sucl X.vcd`). Files refer to each other by name only, so that
//! a folder can be moved.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use crate::error::Result;
use crate::files::output::write_file;
use crate::hierarchy::Entry;
use crate::kernel::signals::SignalFormat;

use super::layout::groups;
use super::marks::Marks;
use super::writer::WaveFormat;
use super::{gtkwave, surfer};

/// Writes the viewer setups for the waveform at `wave_path`, which contains `entries`, and returns their paths. No
/// setups are written for a waveform on a device or a pipe.
///
/// # Errors
/// If a file cannot be written.
pub fn write_views(
    wave_path: &Path,
    format: WaveFormat,
    entries: &[Entry],
    marks: &Marks,
) -> Result<Vec<PathBuf>> {
    let regular = fs::metadata(wave_path).is_ok_and(|found| found.is_file());
    let (Some(name), Some(stem)) = (text(wave_path.file_name()), text(wave_path.file_stem()))
    else {
        return Ok(Vec::new());
    };
    if !regular {
        return Ok(Vec::new());
    }
    let folder = wave_path.parent().unwrap_or(Path::new(""));
    let groups = groups(entries);
    let mut files = Vec::new();
    let rows = groups.iter().flat_map(|group| &group.rows).filter(|_| format == WaveFormat::Vcd);
    for row in rows {
        if let SignalFormat::State(states) = row.entry.signal.format {
            let width = row.entry.signal.width as usize;
            let path = folder.join(gtkwave::names_file(&stem, row));
            files.push((path, gtkwave::names(states, width)));
        }
    }
    let save = gtkwave::save_file((&name, format), &stem, &groups, marks);
    files.push((wave_path.with_extension("gtkw"), save));
    files.push((wave_path.with_extension("sucl"), surfer::commands(&groups, marks)));
    let mut paths = Vec::new();
    for (path, contents) in files {
        write_file(&path, |file| file.write_all(contents.as_bytes()))?;
        paths.push(path);
    }
    Ok(paths)
}

fn text(part: Option<&std::ffi::OsStr>) -> Option<String> {
    Some(part?.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::super::tests::bench::params;
    use super::super::tests::readback::extension;
    use super::*;
    use crate::hierarchy::{entries, ram_entries};
    use crate::kernel::Time;

    fn written(folder: &Path, format: WaveFormat, entries: &[Entry]) -> Vec<(String, String)> {
        let wave = folder.join("run").with_extension(extension(format));
        fs::write(&wave, "").unwrap();
        let marks = Marks {
            laser_edge: Some(Time::from_ns(2104)),
            spad_edge: None,
            algo_done: Some(Time::from_ns(5000)),
            from: Time::from_ns(2000),
            to: Time::from_ns(6000),
        };
        let paths = write_views(&wave, format, entries, &marks).unwrap();
        let read = |path: &PathBuf| fs::read_to_string(path).unwrap();
        let name = |path: &Path| path.strip_prefix(folder).unwrap().display().to_string();
        paths.iter().map(|path| (name(path), read(path))).collect()
    }

    fn file<'a>(files: &'a [(String, String)], name: &str) -> &'a str {
        &files.iter().find(|(other, _)| other == name).unwrap().1
    }

    #[test]
    fn a_save_file_lists_what_was_written_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let mut some = [entries(&params()), ram_entries(&Default::default())].concat();
        some.retain(|entry| !entry.scope.contains(".tdc"));
        let files = written(folder.path(), WaveFormat::Vcd, &some);
        let save = file(&files, "run.gtkw");
        let bare = |line: &str| line.split('[').next().unwrap().to_owned();
        let listed: BTreeSet<_> = (save.lines())
            .filter_map(|line| line.strip_prefix('+')?.split_once("} "))
            .map(|(_, path)| bare(path))
            .collect();
        let paths: BTreeSet<_> = some.iter().map(Entry::path).collect();
        let ids: BTreeSet<_> = some.iter().map(|entry| entry.id).collect();
        assert!(listed.is_subset(&paths));
        assert_eq!(listed.len(), ids.len());
        let commands = file(&files, "run.sucl").lines();
        let added: Vec<_> = commands.filter_map(|l| l.strip_prefix("variable_add ")).collect();
        assert!(!added.is_empty() && added.iter().all(|&path| paths.contains(path)));
    }

    #[test]
    fn marks_and_zoom_are_those_of_the_run() {
        let folder = tempfile::tempdir().unwrap();
        let files = written(folder.path(), WaveFormat::Vcd, &entries(&params()));
        let save = file(&files, "run.gtkw");
        assert!(save.contains("[timestart] 2000000\n"));
        assert!(save.contains(" 2104000 2104000 5000000 -1 "));
        assert!(save.contains("[markername] Alaser\n[markername] Bdone\n"));
        assert!(file(&files, "run.sucl").contains("marker_set done 5000000\n"));
    }

    #[test]
    fn states_of_a_vcd_have_names_in_a_file_and_those_of_an_fst_need_none() {
        let folder = tempfile::tempdir().unwrap();
        let files = written(folder.path(), WaveFormat::Vcd, &entries(&params()));
        let names = file(&files, "run.frame_ctrl.state.txt");
        assert_eq!(names, "00 Clear\n01 Acquire\n10 Drain\n11 Estimate\n");
        let (enumeration, shown) =
            ("@100000028\n", "+{frame_ctrl/state} tof_top.frame_ctrl.state[1:0]\n");
        let from_file = format!("\n@2028\n^1 run.frame_ctrl.state.txt\n{shown}");
        assert!(file(&files, "run.gtkw").contains(&from_file));
        let folder = tempfile::tempdir().unwrap();
        let files = written(folder.path(), WaveFormat::Fst, &entries(&params()));
        let paths: Vec<_> = files.iter().map(|(path, _)| path.as_str()).collect();
        assert_eq!(paths, ["run.gtkw", "run.sucl"]);
        assert!(file(&files, "run.gtkw").contains(&format!("\n{enumeration}{shown}")));
    }

    #[test]
    fn no_path_leads_out_of_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in written(folder.path(), WaveFormat::Fst, &entries(&params())) {
            assert!(!text.contains(&folder.path().display().to_string()), "{name}");
        }
    }

    #[test]
    fn groups_begin_and_end_in_turn() {
        let folder = tempfile::tempdir().unwrap();
        let files = written(folder.path(), WaveFormat::Vcd, &entries(&params()));
        let save = file(&files, "run.gtkw").lines();
        let bounds: Vec<_> = (save.filter_map(|line| line.strip_prefix('@')))
            .map(|flags| u64::from_str_radix(flags, 16).unwrap() >> 23 & 3)
            .filter(|bound| *bound > 0)
            .collect();
        assert!(bounds.chunks(2).all(|pair| pair == [1, 2]));
    }

    #[test]
    fn a_device_has_no_views() {
        let marks = Marks::default();
        let folder = tempfile::tempdir().unwrap();
        let null = crate::files::output::device(folder.path(), "null");
        let paths = write_views(&null, WaveFormat::Vcd, &[], &marks).unwrap();
        assert!(paths.is_empty());
    }
}
