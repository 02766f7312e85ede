//! Tests of the contents of waveforms: every signal, with the values of the firmware.

pub(super) mod bench;
mod files;
pub(super) mod readback;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use wellen::simple::read;

use crate::firmware::carry_chain::TAPS;
use crate::firmware::tof_top::TofTop;
use crate::hierarchy::{entries, ram_entries};
use crate::kernel::Thermometer;
use crate::kernel::Time;

use super::writer::WaveFormat;
use bench::{Bench, SHOTS, params, with_delays};
use readback::{DerefIn, FORMATS, FRAME, assert_same, at, contents, create, extension, record};

#[test]
fn vcd_and_fst_hold_every_entry_and_the_same_changes() {
    let directory = tempfile::tempdir().unwrap();
    let params = params();
    let expected = [entries(&params), ram_entries(&Default::default())].concat();
    let paths = record(directory.path(), false, params);
    let [vcd, fst] = [0, 1].map(|k| contents(&mut read(&paths[k]).unwrap()));
    assert_eq!(vcd.len(), expected.len());
    for entry in &expected {
        let (path, width) = (entry.path(), entry.signal.width);
        assert_eq!(vcd[&path].0, width, "{path}");
    }
    assert_same(&vcd, &fst);
    let edges = &vcd["tof_top.start"].1;
    assert!(edges.len() > 2 * SHOTS as usize);
    assert_eq!(at(&vcd["tof_top.frame_done"].1, 8000 * FRAME), "0");
    assert!(vcd["tof_top.frame_done"].1.iter().any(|change| change.1 == "1"));
}

#[test]
fn values_are_those_that_the_firmware_had() {
    let directory = tempfile::tempdir().unwrap();
    let params = params();
    let paths = record(directory.path(), false, params.clone());
    let vcd = contents(&mut read(&paths[0]).unwrap());
    let mut bench = Bench::new(params);
    let word = |path: &str, now: Time| {
        u64::from_str_radix(at(&vcd[&format!("tof_top.{path}")].1, now.ps()), 2).unwrap()
    };
    for _ in 0..FRAME {
        bench.cycle(&mut |now, top| {
            let taps = at(&vcd["tof_top.tdc.carry_chain.taps"].1, now.ps());
            assert_eq!(taps.len(), TAPS);
            assert_eq!(taps.matches('1').count(), top.tdc.carry_chain.taps.ones(TAPS));
            assert_eq!(word("tdc_stop", now), top.pins.tdc_stop as u64);
            assert_eq!(word("depth", now), top.depth_estimator.forward2.depth.bits());
            assert_eq!(word("frame_ctrl.state", now), top.frame_ctrl.state() as u64);
            let bin = now.ps() as usize / 100 % 256;
            let hits = top.histogram_builder.ram[bin].get();
            assert_eq!(word(&format!("histogram_builder.ram_{bin}"), now), hits);
        });
    }
    let depth = &vcd["tof_top.depth"].1;
    assert!(depth.iter().any(|change| change.1.starts_with('1')), "a negative depth");
}

#[test]
fn aliases_share_one_identifier() {
    let directory = tempfile::tempdir().unwrap();
    for path in record(directory.path(), false, params()) {
        let wave = read(&path).unwrap();
        let variables = wave.hierarchy().all_vars().map(|var| var.deref_in(&wave));
        let signals: BTreeSet<_> = variables.map(|var| var.signal_ref().index()).collect();
        let ids: BTreeSet<_> = entries(&params()).iter().map(|entry| entry.id).collect();
        assert_eq!(signals.len(), ids.len() + 256);
    }
}

#[test]
fn both_formats_have_the_names_of_states() {
    let directory = tempfile::tempdir().unwrap();
    for path in record(directory.path(), false, params()) {
        let wave = read(&path).unwrap();
        let hierarchy = wave.hierarchy();
        let with_names = hierarchy.all_vars().filter_map(|var| {
            let var = var.deref_in(&wave);
            Some((var.full_name(hierarchy), var.enum_type(hierarchy)?.1))
        });
        let names = vec![("00", "Clear"), ("01", "Acquire"), ("10", "Drain"), ("11", "Estimate")];
        assert_eq!(Vec::from_iter(with_names), [("tof_top.frame_ctrl.state".to_owned(), names)]);
    }
}

#[test]
fn both_formats_have_units_and_an_fst_has_every_type() {
    let directory = tempfile::tempdir().unwrap();
    let paths = record(directory.path(), false, params());
    let [vcd, fst] = [0, 1].map(|k| {
        let wave = read(&paths[k]).unwrap();
        let (hierarchy, vars) = (wave.hierarchy(), wave.hierarchy().all_vars());
        let types = vars.map(|var| {
            let var = var.deref_in(&wave);
            let stated = var.vhdl_type_name(hierarchy).map(str::to_owned);
            (var.full_name(hierarchy), (stated, var.var_type()))
        });
        types.collect::<BTreeMap<_, _>>()
    });
    for (path, expected) in [
        ("depth", "signed/2^29[m]"),
        ("hist_count", "unsigned[hits]"),
        ("tdc_code", "unsigned[25_ps]"),
        ("tdc.tdc_decoder.t", "signed/2^4[25_ps]"),
        ("depth_estimator.forward1.l1_in_7", "signed/2^23"),
    ] {
        let path = format!("tof_top.{path}");
        assert_eq!(vcd[&path].0.as_deref(), Some(expected), "{path}");
        assert_eq!(vcd[&path], fst[&path]);
    }
    for entry in entries(&params()) {
        let (stated, kind) = &fst[&entry.path()];
        assert_eq!(stated.as_deref(), Some(&*entry.signal.type_text()), "{}", entry.path());
        assert_eq!(kind, &vcd[&entry.path()].1, "{}", entry.path());
        // GTKWave shows a type from its last dot on, and a VCD ends it at a blank.
        assert!(!entry.signal.type_text().contains(['.', ' ']), "{}", entry.path());
    }
    assert_eq!(vcd["tof_top.start"].0, None);
}

#[test]
fn a_scope_points_to_its_module_and_its_instance_in_the_verilog() {
    let directory = tempfile::tempdir().unwrap();
    for path in record(directory.path(), false, params()) {
        let wave = read(&path).unwrap();
        let hierarchy = wave.hierarchy();
        let scope = hierarchy.lookup_scope(&["tof_top", "tdc", "tdc_latch"]).unwrap();
        let scope = &hierarchy[scope];
        for scope in hierarchy.all_scopes().map(|scope| &hierarchy[scope]) {
            let (file, _) = scope.source_loc(hierarchy).unwrap();
            let name = scope.full_name(hierarchy);
            assert!(fs::exists(file).unwrap() && file.starts_with("rtl_ref/"), "{name}: {file}");
        }
        assert_eq!(scope.source_loc(hierarchy).unwrap().0, "rtl_ref/tdc_latch.v");
        let (file, line) = scope.instantiation_source_loc(hierarchy).unwrap();
        let text = fs::read_to_string(file).unwrap();
        assert_eq!(text.lines().nth(line as usize - 1).unwrap().trim(), ") tdc_latch (");
        let sync = &hierarchy[hierarchy.lookup_scope(&["tof_top", "reset_sync_sys"]).unwrap()];
        let is_fst = path.extension().is_some_and(|ending| ending == "fst");
        assert_eq!(sync.component(hierarchy), is_fst.then_some("reset_sync"));
    }
}

#[test]
fn taps_stand_in_their_physical_place() {
    let mut delays = [11_500; TAPS];
    delays[0] = 40_000;
    delays[1] = -20_000;
    let params = with_delays(&delays);
    assert_eq!(params.tdc.delays.order()[..4], [0, 2, 3, 1]);
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("run.vcd");
    let mut waves = create(&path, WaveFormat::Vcd, &entries(&params), &params);
    let mut top = TofTop::default();
    top.tdc.carry_chain.taps = Thermometer::new(true, [3]);
    waves.begin(Time::ZERO, &top);
    waves.finish(Time::from_ns(1)).unwrap();
    let vcd = contents(&mut read(&path).unwrap());
    assert!(at(&vcd["tof_top.tdc.carry_chain.taps"].1, 0).ends_with("0001101"));
}

#[test]
fn a_file_of_many_blocks_is_read_back_whole() {
    let directory = tempfile::tempdir().unwrap();
    let params = params();
    let all = [entries(&params), ram_entries(&Default::default())].concat();
    let paths =
        FORMATS.map(|format| directory.path().join("run").with_extension(extension(format)));
    let mut waves: Vec<_> = FORMATS
        .iter()
        .zip(&paths)
        .map(|(&format, path)| create(path, format, &all, &params))
        .collect();
    let mut bench = Bench::new(params);
    for waves in &mut waves {
        waves.begin(bench.now(), &bench.top);
    }
    bench.run(120 * FRAME, &mut waves);
    for waves in waves {
        waves.finish(bench.now()).unwrap();
    }
    let sections = fs::read(&paths[1]).unwrap()[65..73].iter().fold(0, |n, &b| n << 8 | b as u64);
    assert!(sections > 1, "{sections}");
    let [vcd, fst] = [0, 1].map(|k| contents(&mut read(&paths[k]).unwrap()));
    assert_same(&vcd, &fst);
}
