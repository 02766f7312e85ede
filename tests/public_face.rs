//! The crate's page: a frame in one line, cycles with signals by name, and a doc comment on every item.

use std::fs;
use std::ops::ControlFlow;

use tofsim::{Error, Result, Run};

use crate::common::setup;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Return value of a step that continues the run.
const GO_ON: Result<ControlFlow<()>> = Ok(ControlFlow::Continue(()));

#[test]
fn what_is_read_cycle_by_cycle_is_what_the_frame_has() {
    let setup = setup("kc705", &["firmware.shots_per_frame=500"]);
    let frame = Run::new(&setup).frames(1).unwrap().remove(0);
    let (mut cycles, mut histogram, mut depth) = (0, [0; 256], None);
    let signals = ["tof_top.tdc_valid", "tdc.tdc_decoder.tdc_code", "algo_done", "tof_top.depth"];
    let outcome = Run::new(&setup)
        .step_cycles(1, signals, |cycle, [tdc_valid, tdc_code, algo_done, word]| {
            let begin = setup.pll().clk_sys.rise(cycles);
            assert_eq!((cycle.number, cycle.begin), (cycles, begin));
            cycles += 1;
            if tdc_valid == 1 {
                histogram[tdc_code as usize] += 1;
            }
            if algo_done == 1 {
                depth = Some(word);
            }
            GO_ON
        })
        .unwrap();
    assert_eq!(outcome.cycles, cycles);
    assert_eq!(frame.histogram, histogram);
    assert!(frame.hits() > 50);
    assert_eq!(depth, Some(frame.depth().to_bits()));
}

#[test]
fn words_have_their_sign_states_their_code_and_taps_their_number_of_ones() {
    let setup = setup("kc705", &["firmware.shots_per_frame=100"]);
    let signals = ["depth_estimator.forward1.l1_in_0", "frame_ctrl.state", "tdc.carry_chain.taps"];
    let (mut lowest, mut states, mut most) = (0, [false; 4], 0);
    let step = |_, [sum, state, taps]: [i64; 3]| {
        (lowest, most) = (sum.min(lowest), taps.max(most));
        states[state as usize] = true;
        GO_ON
    };
    Run::new(&setup).step_cycles(1, signals, step).unwrap();
    assert!((-(1 << 35)..0).contains(&lowest), "{lowest}");
    assert_eq!(states, [true; 4]);
    assert!((1..=800).contains(&most), "{most}");
}

#[test]
fn a_step_may_end_the_run() {
    let setup = setup("kc705", &[]);
    let stops = |last, end: fn() -> Result<ControlFlow<()>>| {
        let mut seen = 0;
        let step = |_, []: [i64; 0]| {
            seen += 1;
            if seen == last { end() } else { GO_ON }
        };
        let done = Run::new(&setup).step_cycles(1, [], step);
        (done.map(|outcome| outcome.cycles).map_err(|error| error.to_string()), seen)
    };
    assert_eq!(stops(7, || Ok(ControlFlow::Break(()))), (Ok(7), 7));
    assert_eq!(stops(9, || Err(Error::Interrupted)), (Err("interrupted".into()), 9));
}

#[test]
fn an_unknown_signal_is_refused_with_a_name_that_is_near() {
    let setup = setup("kc705", &[]);
    let refused = |name: &str| {
        let done = Run::new(&setup).step_cycles(1, [name], |_, _| GO_ON);
        done.unwrap_err().to_string()
    };
    let near = |name: &str| {
        let text = refused(name);
        let hint = text.strip_prefix(&format!("signal: {name}: there is none of that name"));
        hint.unwrap_or_else(|| panic!("{text}")).to_owned()
    };
    assert_eq!(near("tof_top.tdc_cod"), "; did you mean `tdc_code`?");
    assert_eq!(near("xyzzy"), "");
    assert_eq!(near("tof_top.frame.clear_addr"), "; did you mean `clear_addr`?");
}

#[test]
fn a_waveform_is_written_of_the_signals_that_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vcd");
    let setup = setup("kc705", &["firmware.shots_per_frame=20"]);
    let waves = setup.waves(&path, tofsim::WaveFormat::Vcd, &["tdc_code", "depth"]).unwrap();
    let windows = setup.windows(&[], 1).unwrap();
    let observers = tofsim::Observers { waves: Some((waves, windows)), ..Default::default() };
    let outcome = Run::new(&setup).observe(1, observers).unwrap();
    assert!(outcome.marks.algo_done.is_some());
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains("scenario kc705") && text.contains("tdc_code"), "{text}");
    assert!(!text.contains("laser_pulse"));
}

/// rustc asks for no doc comments below a module that is not shown, though it has items of the page.
#[test]
fn every_public_item_in_the_files_of_the_page_has_a_doc_comment() {
    let page = fs::read_to_string(format!("{ROOT}/src/lib.rs")).unwrap();
    let mut files = 0;
    for line in page.lines().filter_map(|line| line.strip_prefix("pub use ")) {
        let module = line.rsplit_once("::").unwrap().0.replace("::", "/");
        let candidates = ["", "/mod"].map(|end| format!("{ROOT}/src/{module}{end}.rs"));
        let path = candidates.iter().find(|path| fs::exists(path).unwrap()).unwrap();
        let text = fs::read_to_string(path).unwrap();
        let text = text.split("#[cfg(test)]\nmod tests").next().unwrap();
        let lines: Vec<_> = text.lines().map(str::trim_start).collect();
        for (number, line) in lines.iter().enumerate().filter(|(_, line)| line.starts_with("pub "))
        {
            let mut above = lines[..number].iter().rev().skip_while(|line| line.starts_with('#'));
            let is_said = above.next().is_some_and(|line| line.starts_with("///"));
            let is_item = !["pub use", "pub mod"].iter().any(|word| line.starts_with(word));
            assert!(is_said || !is_item, "{path}:{}: {line}", number + 1);
        }
        files += 1;
    }
    assert!(files > 10);
}
