//! Test that the logic analyser's files equal those of `tofsim ila capture`.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::common::Server;
use tofsim::{Run, Setup};
use tofsim_captures::ila::export::{CaptureFormat, export};
use tofsim_captures::ila::{Analyser, AnalyserPlan, AnalyserSetup, capture};

/// Runs until the analyser is full, with changes of control signals before, and returns the capture as the page shows
/// it.
fn captured(server: &Server, request: &str) -> Value {
    server.frames(1);
    server.act("control", "{\"laser_freq\":1}");
    server.frames(1);
    server.act("ila", request);
    assert_eq!(server.state()["ila"]["status"], "armed");
    server.act("control", "{\"mode\":1}");
    let state = server.act("run", "{\"frames\":3}");
    assert_eq!(state["ila"]["status"], "full", "{}", state["ila"]);
    state["ila"]["capture"].clone()
}

#[test]
fn an_armed_analyser_captures_what_a_run_of_the_scenario_shows() {
    let requests = [
        "{\"arm\":true,\"set_up\":\"fig_6_6\"}",
        "{\"arm\":true,\"set_up\":\"fig_6_21\",\"windows\":2,\"position\":5}",
        "{\"arm\":true,\"set_up\":\"fig_6_6\",\"clock\":\"100MHz + 250ps\",\"trigger\":\"VCSEL_ON rising\"}",
        // The first sample triggers, so that the instant of arming shows.
        "{\"arm\":true,\"set_up\":\"fig_6_6\",\"trigger\":\"SPAD_RST_DO == 0\",\"position\":0}",
    ];
    for (fidelity, request) in ["shot", "cycle", "shot", "cycle"].into_iter().zip(requests) {
        let server = Server::small(&["--fidelity", fidelity]);
        let found = captured(&server, request);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.toml");
        std::fs::write(&path, server.get("run.toml").body).unwrap();
        let setup = Setup::load(path.to_str().unwrap(), &[]).unwrap();
        let mut set_up = AnalyserSetup::load(found["name"].as_str().unwrap()).unwrap();
        let asked: Value = serde_json::from_str(request).unwrap();
        let file = &mut set_up.file;
        file.arm_at_us = found["arm_at_us"].as_f64().unwrap();
        file.windows = asked["windows"].as_u64().unwrap_or(file.windows);
        file.position = asked["position"].as_u64().or(file.position);
        file.trigger = asked["trigger"].as_str().map(str::to_owned).or(file.trigger.take());
        file.clock = asked["clock"].as_str().unwrap_or(&file.clock).to_owned();
        let mut plan = AnalyserPlan::new(&set_up, &setup).unwrap();
        plan.stop_when_full = true;
        let mut analyser = Analyser::new(&plan, &setup);
        capture(Run::new(&setup), 5, &mut analyser, None).unwrap();
        assert!(analyser.is_full());
        let formats = CaptureFormat::ALL;
        let paths = export(&analyser.finish(), folder.path(), "own", formats, true).unwrap();
        for (format, path) in formats.iter().zip(paths) {
            let answer = server.get(&format!("ila.{format}"));
            assert_eq!(answer.status, 200);
            assert!(answer.head.contains("attachment; filename=\"fig_6_"), "{}", answer.head);
            let own = std::fs::read(path).unwrap();
            assert!(answer.body == own, "{request} {format:?}");
        }
    }
}

#[test]
fn a_set_up_of_ones_own_triggers_and_one_that_never_does_can_be_let_be() {
    let server = Server::small(&[]);
    let text = "trigger = 'HIT rising'\\n[[probe]]\\nname = 'HIT'\\nsignal = 'tdc.tdc_latch.hit'";
    let found = captured(&server, &format!("{{\"arm\":true,\"text\":\"{text}\"}}"));
    assert_eq!((&found["name"], &found["probes"][0]["name"]), (&"own".into(), &"HIT".into()));
    let never = "{\"arm\":true,\"set_up\":\"fig_6_6\",\"trigger\":\"rst == 1\"}";
    server.act("ila", never);
    server.frames(2);
    let state = server.state();
    assert_eq!(state["ila"]["status"], "armed");
    assert!(state["ila"]["armed"]["samples"].as_u64() > Some(1000));
    server.act("ila", "{\"arm\":false}");
    assert_eq!(server.state()["ila"]["capture"], found, "the capture before stays");
}

#[test]
fn a_shot_s_waveform_is_that_of_the_scenario() {
    let server = Server::small(&["--fidelity", "shot"]);
    server.frames(1);
    server.act("control", "{\"laser_freq\":1}");
    server.frames(1);
    let found = server.get("shot.vcd").body;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.toml");
    std::fs::write(&path, server.get("run.toml").body).unwrap();
    let setup = Setup::load(path.to_str().unwrap(), &[]).unwrap();
    let wave = folder.path().join("own.vcd");
    let waves = setup.waves(&wave, tofsim::WaveFormat::Vcd, &[]).unwrap();
    let windows = vec![tofsim::Window::Shots { from: 599, to: 600 }];
    let observers = tofsim::Observers { waves: Some((waves, windows)), ..Default::default() };
    Run::new(&setup).observe(2, observers).unwrap();
    // The comments tell where each comes from.
    let body = |bytes: &[u8]| {
        let text = String::from_utf8(bytes.to_vec()).unwrap();
        text.split_once("$enddefinitions").unwrap().1.trim_end().to_owned()
    };
    let (found, own) = (body(&found), body(&std::fs::read(wave).unwrap()));
    // A run ends with its last frame, and the page's goes on.
    assert!(found.len() > 1000 && found == own, "{} {}", found.len(), own.len());
    assert_eq!(&server.get("shot.fst").body[..1], [0], "the header block of an FST");
}

#[test]
#[ignore = "long: ./check --full"]
fn the_command_that_the_page_shows_makes_the_same_files() {
    let server = Server::small(&[]);
    let found = captured(&server, "{\"arm\":true,\"set_up\":\"shot\"}");
    assert_eq!(found["exact"], true);
    let tofsim = Path::new(env!("CARGO_BIN_EXE_tofsim-serve")).with_file_name("tofsim");
    assert!(tofsim.is_file(), "{} is missing: cargo build -p tofsim-cli", tofsim.display());
    let folder = tempfile::tempdir().unwrap();
    let answer = server.get("run.toml");
    let name = answer.head.split('"').nth(1).unwrap();
    std::fs::write(folder.path().join(name), answer.body).unwrap();
    let command = found["command"].as_str().unwrap();
    let words = command.strip_prefix("tofsim ").unwrap();
    let shell = format!("{} {words} -q", tofsim.display());
    let status = Command::new("sh").args(["-c", &shell]).current_dir(folder.path()).status();
    assert!(status.unwrap().success(), "{command}");
    for ending in ["csv", "vcd", "ila"] {
        let path = folder.path().join("ila").join(format!("shot.{ending}"));
        assert!(
            server.get(&format!("ila.{ending}")).body == std::fs::read(path).unwrap(),
            "{ending}"
        );
    }
}
