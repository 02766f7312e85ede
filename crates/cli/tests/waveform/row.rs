//! The outputs of the row of SPADs in a waveform.

use crate::common;

use super::wave::Changes;
use super::{Wave, run};

#[test]
fn the_outputs_of_the_row_are_shown_and_the_or_of_those_on_the_tdc_is_tdc_stop() {
    for (keys, on_tdc) in [
        (["spad.on_tdc=3", "firmware.mode=0"], 14..17),
        (["spad.on_tdc=30", "firmware.mode=1"], 0..30),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let row = [
            "spad.row_outputs=30",
            "spad.crosstalk_probability=0.2",
            "firmware.shots_per_frame=40",
        ];
        let keys = [&keys[..], &row].concat();
        let set: Vec<_> = keys.iter().flat_map(|key| ["-s", *key]).collect();
        for format in ["vcd", "fst"] {
            run(
                folder.path(),
                &[&set[..], &["--waves", format, "--window", "shot:3..30"]].concat(),
            );
        }
        let path = |ending| folder.path().join("kc705").with_extension(ending);
        let [vcd, fst] = ["vcd", "fst"].map(|ending| Wave::open(&path(ending)));
        let names: Vec<_> = (0..30).map(|output| format!("spad_row.spad_out_{output}")).collect();
        let outputs: Vec<_> = names.iter().map(|name| vcd.changes(name)).collect();
        for (name, output) in names.iter().zip(&outputs) {
            assert_eq!(fst.changes(name), *output, "{name}");
            assert!(vcd.rises(name).len() > 3, "{name}");
        }
        let at = |changes: &Changes, time: u64| {
            let after = changes.partition_point(|(then, _)| *then <= time);
            changes[after - 1].1.clone()
        };
        let stop = vcd.changes("tdc_stop");
        let times = outputs.iter().chain([&stop]).flatten().map(|(time, _)| *time);
        for time in times {
            let levels = outputs[on_tdc.clone()].iter().map(|output| at(output, time));
            let levels: Vec<_> = levels.collect();
            let expected =
                ["1", "x", "0"].into_iter().find(|level| levels.iter().any(|l| l == level));
            assert_eq!(Some(&*at(&stop, time)), expected, "{time} ps: {levels:?}");
        }
        if keys[1] == "firmware.mode=0" {
            let unwired = vcd.rises(&names[2]).len() + vcd.rises(&names[28]).len();
            assert!(unwired > 10 && vcd.rises("tdc_stop").len() <= 27, "{unwired}");
        }
    }
}

#[test]
fn outputs_of_the_row_are_chosen_by_name_where_they_are_simulated() {
    let folder = tempfile::tempdir().unwrap();
    let some = ["--window", "shot:0..4", "--signals", "spad_out_1?", "--signals", "tdc_stop"];
    run(folder.path(), &[&["-s", "spad.row_outputs=30"], &some[..]].concat());
    let wave = Wave::open(&folder.path().join("kc705.vcd"));
    let row = wave.vars.keys().filter(|name| name.starts_with("spad_row."));
    assert_eq!(row.count(), 10);
    let views = std::fs::read_to_string(folder.path().join("kc705.gtkw")).unwrap();
    assert!(views.contains("-Row of SPADs\n") && views.contains(" spad_row.spad_out_15\n"));
    let error = common::refused(folder.path(), &[&["run"], &some[..]].concat());
    assert!(error.contains("spad_out_1?: matches no signal"), "{error}");
    run(folder.path(), &["--window", "shot:0..4", "-s", "spad.crosstalk_probability=0.5"]);
    let wave = Wave::open(&folder.path().join("kc705.vcd"));
    assert!(wave.vars.keys().all(|name| name.starts_with("tof_top.")));
}
