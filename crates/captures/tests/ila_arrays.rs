//! Captures of the firmware of an array against those of a single pixel.

use std::fs;

use tofsim::scenario;
use tofsim::sim::Run;
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::array::ArraySetup;
use tofsim_captures::ila::{
    Analyser, AnalyserPlan, AnalyserSetup, Capture, capture_array, sampler,
};

fn array(set: &[&str]) -> ArraySetup {
    let short = ["firmware.shots_per_frame=220", "array.rows=1"];
    let set: Vec<_> = short.iter().chain(set).map(|set| (*set).to_owned()).collect();
    ArraySetup::new(scenario::load("bright", &set).unwrap()).unwrap()
}

fn plan(text: &str, setup: &Setup) -> AnalyserPlan {
    let set_up = AnalyserSetup::parse("own", "own.toml", text).unwrap();
    AnalyserPlan::new(&set_up, setup).unwrap()
}

/// Returns what an analyser has seen of one image of an array.
fn of_array(array: &ArraySetup, text: &str) -> Capture {
    let setup = array.with_firmware().unwrap();
    let mut analyser = Analyser::new(&plan(text, &setup), &setup);
    capture_array(array, 1, &mut analyser, None).unwrap();
    analyser.finish()
}

fn of_pixel(setup: &Setup, text: &str) -> Capture {
    let mut analyser = Analyser::new(&plan(text, setup), setup);
    sampler::capture(Run::new(setup), 1, &mut analyser, None).unwrap();
    analyser.finish()
}

fn probes(signals: &[&str]) -> String {
    let probe = |signal: &&str| format!("[[probe]]\nsignal = \"{signal}\"\n");
    signals.iter().map(probe).collect()
}

#[test]
fn an_array_of_one_pixel_is_captured_as_the_pixel() {
    let mut probed = vec![
        "tdc_stop",
        "tdc.carry_chain.taps",
        "tdc_code",
        "tdc_valid",
        "depth",
        "frame_ctrl.state",
        "clk_sys",
    ];
    // From the first edge on: an array shows what its wires do between lock and that edge with the edge.
    let heads = [
        "clock = \"clk_sys\"",
        "clock = \"clk_laser\"\ntrigger = \"tdc_stop rising\"\narm_at_us = 3.1",
        "clock = \"100MHz + 250ps\"\ntrigger = \"tdc_valid == 1\"\ninput_stages = 3\narm_at_us = 1.1",
        "clock = \"clk_in\"\nwindows = 4\ntrigger = \"start rising\"\narm_at_us = 1.1",
        "clock = \"clk_sys\"\ncapture = \"tdc_valid == 1\"\nposition = 0",
    ];
    for probes_clk_in in [false, true] {
        if probes_clk_in {
            probed.push("clk_in");
        }
        for (k, head) in heads.iter().enumerate() {
            // In MODE 1, what comes after the acquisition is of the next row.
            for (mode, depth) in [("firmware.mode=0", 2048), ("firmware.mode=1", 1024)] {
                if depth == 1024 && k == 4 {
                    continue;
                }
                let array = array(&[mode]);
                let text = format!("{head}\ndepth = {depth}\n{}", probes(&probed));
                let capture = of_array(&array, &text);
                assert!(capture.samples() > 40, "{head}: {}", capture.samples());
                let is_same = capture == of_pixel(&array.pixel(0, 0), &text);
                assert!(is_same, "{head} {mode}");
            }
        }
    }
}

#[test]
fn a_channel_is_captured_as_its_pixel_alone() {
    let array = array(&["array.columns=5"]);
    for (head, hit) in [("clock = \"clk_sys\"", 500), ("clock = \"125MHz + 8500ps\"", 500)] {
        let of = |names: [&str; 3], trigger: &str| {
            let trigger = format!("trigger = \"{trigger} rising\"\nposition = {hit}");
            format!("{head}\n{trigger}\n{}", probes(&names))
        };
        let own = of(
            ["channel_4.tdc_stop", "channel_4.code_valid", "channel_4.code"],
            "channel_4.tdc_stop",
        );
        let alone = ["tdc_stop", "tdc.tdc_decoder.tdc_valid", "tdc.tdc_decoder.tdc_code"];
        let alone = of_pixel(&array.pixel(0, 4), &of(alone, "tdc_stop"));
        let own = of_array(&array, &own);
        assert_eq!((own.words, own.triggers), (alone.words, alone.triggers), "{head}");
    }
}

#[test]
fn a_photon_with_an_edge_is_sampled_by_the_next_edge() {
    let folder = crate::common::empty();
    let arrivals = (0..60).map(|shot| format!("{shot},{}\n", 4000 * (shot % 6)));
    let list = "shot,arrival_ps\n".to_owned() + &arrivals.collect::<String>();
    fs::write(folder.path().join("edges.csv"), list).unwrap();
    let path = folder.path().join("edges.toml");
    let keys = "[stimulus]\nphotons = \"edges.csv\"\n[firmware]\nshots_per_frame = 60\n";
    fs::write(&path, keys).unwrap();
    let array = ArraySetup::new(scenario::load(path.to_str().unwrap(), &[]).unwrap()).unwrap();
    for clock in ["clk_sys", "clk_laser", "125 MHz", "250MHz + 4ns"] {
        let probed = probes(&["start", "tdc_stop", "tdc.tdc_latch.hit"]);
        let text = format!("clock = \"{clock}\"\ntrigger = \"tdc_stop rising\"\n{probed}");
        let capture = of_array(&array, &text);
        assert!(capture.samples() > 500, "{clock}: {}", capture.samples());
        assert_eq!(capture, of_pixel(&array.pixel(0, 0), &text), "{clock}");
    }
}
