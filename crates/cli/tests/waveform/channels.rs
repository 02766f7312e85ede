//! The firmware of an array: each column's converter sees what it sees of its pixel alone.

use std::path::Path;

use crate::common;

use super::Wave;

const ARRAY: [&str; 7] =
    ["array", "-s", "array.rows=2", "-s", "array.columns=4", "-s", "firmware.shots_per_frame=200"];

fn traced(folder: &Path, options: &[&str]) {
    common::stdout(folder, &[&["image"], &ARRAY[..], options].concat());
}

#[test]
fn a_channel_of_the_first_row_is_the_pixel_alone() {
    assert_channels_are_pixels(&[]);
}

#[test]
fn a_channel_of_a_row_that_crosstalk_joins_is_the_pixel_alone() {
    assert_channels_are_pixels(&["-s", "spad.crosstalk_probability=0.3"]);
}

fn assert_channels_are_pixels(set: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    // Shorter than the row's acquisition.
    let window = [&["--window", "0us..11us"], set].concat();
    traced(folder.path(), &[&window[..], &["--waves", "vcd", "-o", "all"]].concat());
    let all = Wave::open(&folder.path().join("all/array.vcd"));
    for column in 0..4 {
        let (place, out) = (format!("0,{column}"), format!("column_{column}"));
        let pixel = ["--pixel", &place, "-o", &out, "--no-second-opinion"];
        common::stdout(folder.path(), &[&["run"], &ARRAY[..], &window, &pixel].concat());
        let alone = Wave::open(&folder.path().join(out).join("array.vcd"));
        let mut compared = 0;
        let outputs: Vec<_> =
            alone.vars.keys().filter(|name| name.starts_with("spad_row.")).collect();
        assert_eq!(outputs.len(), if set.is_empty() { 0 } else { 4 });
        for name in outputs {
            let output: usize = name.strip_prefix("spad_row.spad_out_").unwrap().parse().unwrap();
            let stop = if output == 0 {
                "tdc_stop".to_owned()
            } else {
                format!("channel_{output}.tdc_stop")
            };
            assert_eq!(alone.changes(name), all.changes(&stop), "{name} of column {column}");
        }
        for name in alone.vars.keys().filter_map(|name| name.strip_prefix("tof_top.")) {
            let module = name.split('.').next().unwrap();
            let own = match module {
                _ if column == 0 && all.vars.contains_key(&format!("tof_top.{name}")) => {
                    name.to_owned()
                }
                "tdc" | "tdc_stop" => format!("channel_{column}.{name}"),
                // What it shows is no signal of one histogram in an array.
                "histogram_builder" if !name.ends_with(".count") => {
                    name.replacen(module, &format!("channel_{column}.bank_0"), 1)
                }
                "clk_in" | "clk_sys" | "clk_laser" | "frame_ctrl" | "vcsel_driver" => {
                    name.to_owned()
                }
                _ => continue,
            };
            assert_eq!(all.changes(&own), alone.changes(name), "{own} of column {column}");
            compared += 1;
        }
        assert!(compared > 60, "{compared} signals of column {column}");
        let code = |column: usize| all.changes(&format!("channel_{column}.code"));
        assert!(column < 2 || code(column) != code(1), "column {column}");
        assert!(alone.rises("tdc.tdc_decoder.tdc_valid").len() > 3, "column {column}");
    }
}

#[test]
fn chosen_channels_are_the_same_in_both_formats_up_to_the_last_row() {
    let folder = tempfile::tempdir().unwrap();
    let chosen = ["--signals", "channel_2.*", "--signals", "frame_ctrl.*"];
    for format in ["vcd", "fst"] {
        let windows = ["--window", "shot:0..4", "--window", "estimation", "--waves", format];
        traced(folder.path(), &[&chosen[..], &windows, &["-o", "out"]].concat());
    }
    let [vcd, fst] = ["vcd", "fst"]
        .map(|ending| Wave::open(&folder.path().join("out/array").with_extension(ending)));
    assert!(vcd.vars.keys().eq(fst.vars.keys()));
    assert!(
        vcd.vars.keys().all(|name| name.starts_with("tof_top.channel_2.")
            || name.starts_with("tof_top.frame_ctrl."))
    );
    for name in vcd.vars.keys() {
        assert_eq!(vcd.changes(name), fst.changes(name), "{name}");
    }
    // Both banks have been filled, and the last row has been estimated.
    for bank in ["bank_0", "bank_1"] {
        assert!(vcd.rises(&format!("channel_2.{bank}.counting")).len() > 3, "{bank}");
    }
    assert_eq!(vcd.rises("frame_ctrl.frame_done").len(), 2);
    for file in ["out/array.vcd", "out/array.fst", "out/image.json"] {
        let text = common::stdout(folder.path(), &["rerun", file]);
        assert!(text.contains("the same"), "{file}: {text}");
    }
    let views = common::files(&folder.path().join("out"));
    assert!(views.contains(&"array.gtkw".to_owned()) && views.contains(&"array.sucl".to_owned()));
}

#[test]
fn it_ends_with_the_last_window() {
    let folder = tempfile::tempdir().unwrap();
    // In the second row, since shots are those of all rows.
    let window = ["--window", "shot:202..205", "--waves", "vcd", "-o", "."];
    traced(folder.path(), &window);
    let wave = Wave::open(&folder.path().join("array.vcd"));
    let begun = wave.rises("start");
    assert_eq!(begun.len(), 3);
    assert!(wave.changes("frame_ctrl.row").iter().any(|(_, row)| row == "000001"));
    let last = *wave.waveform.time_table().last().unwrap();
    assert!(last < begun[2] + 100_000, "{last} ps after {begun:?}");
}

#[test]
fn what_no_waveform_of_an_array_has_is_refused() {
    let folder = common::empty();
    let refused = |options: &[&str]| {
        common::refused(folder.path(), &[&["image"], &ARRAY[..], options].concat())
    };
    let wave = ["--waves", "vcd"];
    for (options, said) in [
        (&["--signals", "channel_4.*"][..], "channel_4.*: matches no signal; near it: channel_"),
        (&["--window", "shot:0..401"], "shot:0..401: past the end: the run has 400 shots"),
        (&["--window", "0us..1s"], "0us..1000000us: past the end: the run ends at"),
        (&["-s", "array.rows=41"], "array.rows = 41: expected at most 40 for the firmware"),
        (&["-s", "pll.jitter_rms_ps=5"], "pll.jitter_rms_ps"),
        (&["--pixel", "0,0"], "the waveform of a pixel is that of `run --pixel`"),
    ] {
        let text = refused(&[&wave[..], options].concat());
        assert!(text.contains(said), "{options:?}: {text}");
    }
    let text = refused(&["--window", "shot:0"]);
    assert!(text.contains("--window: expected --waves vcd or fst"), "{text}");
    assert!(common::files(folder.path()).is_empty());
}
