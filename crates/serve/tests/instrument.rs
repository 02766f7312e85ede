//! Tests that requests affect the frames of the run.

use serde_json::Value;

use super::common::Server;

fn of_layer(frame: &Value, cause: &str) -> f64 {
    let layers = frame["layers"].as_array().unwrap();
    let layer = layers.iter().find(|layer| layer["cause"] == cause);
    let counts = layer.map(|layer| layer["counts"].as_array().unwrap());
    counts.into_iter().flatten().map(|count| count.as_f64().unwrap()).sum()
}

fn depth(frame: &Value, estimator: &str) -> f64 {
    let depths = frame["depths"].as_array().unwrap();
    let depth = depths.iter().find(|depth| depth["estimator"] == estimator).unwrap();
    depth["depth_m"].as_f64().unwrap()
}

#[test]
fn laser_off_makes_the_histogram_dark_within_a_frame() {
    for fidelity in ["cycle", "shot"] {
        let server = Server::start(&["--stopped", "--fidelity", fidelity]);
        let lit = server.frames(1);
        assert!(of_layer(&lit, "signal") > 5000.0, "{fidelity}");
        server.act("control", "{\"laser_en\":false}");
        let dark = server.frames(1);
        assert_eq!((&dark["laser_en"], &dark["mixed"]), (&false.into(), &false.into()));
        assert_eq!(of_layer(&dark, "signal"), 0.0, "{fidelity}");
        server.stop_within_a_frame();
        server.act("control", "{\"laser_en\":true}");
        let mixed = server.frames(1);
        assert_eq!(mixed["mixed"], true);
        server.act("control", "{\"laser_en\":false}");
        let dark = server.frames(1);
        assert_eq!((of_layer(&dark, "signal"), &dark["mixed"]), (0.0, &false.into()), "{fidelity}");
        assert!(dark["true_m"].is_null(), "there is no depth without a laser");
        let state = server.state();
        assert!(
            state["notes"][0].as_str().unwrap().contains("firmware.laser_en"),
            "{}",
            state["notes"]
        );
        server.act("control", "{\"laser_en\":true}");
        let lit = server.frames(1);
        assert!(of_layer(&lit, "signal") > 5000.0);
        assert_eq!(
            server.state()["notes"].as_array().unwrap().len(),
            0,
            "silence: the answer holds"
        );
    }
}

#[test]
fn a_moved_target_moves_the_depth() {
    for fidelity in ["cycle", "shot"] {
        let server = Server::start(&["--stopped", "--fidelity", fidelity]);
        let before = server.frames(1);
        server.act("scene", "{\"target.distance_m\":0.3}");
        let after = server.frames(1);
        for estimator in ["network", "likelihood"] {
            let [before, after] = [&before, &after].map(|frame| depth(frame, estimator));
            assert!(
                (before - 0.5).abs() < 0.005 && (after - 0.3).abs() < 0.005,
                "{before} {after}"
            );
        }
        assert_eq!(after["true_m"], 0.3);
        let bounds = [before, after].map(|frame| frame["bound_two_sd_mm"].as_f64().unwrap());
        assert!(bounds[1] < bounds[0] && bounds[1] > 0.1, "{bounds:?}");
        server.act("scene", "{\"target.distance_m\":0.8}");
        let state = server.state();
        let said = state["notes"].to_string();
        assert!(said.contains("outside-training"), "{said}");
    }
}

#[test]
fn a_new_scene_is_coming_until_the_first_frame_of_it() {
    let server = Server::start(&["--stopped", "--fidelity", "shot"]);
    let coming = || server.state()["scene_coming"].as_bool().unwrap();
    server.frames(1);
    assert!(!coming());
    server.stop_within_a_frame();
    server.act("scene", "{\"target.distance_m\":0.3}");
    assert!(coming());
    // This frame is of the old scene still.
    assert_eq!((&server.frames(1)["true_m"], coming()), (&0.5.into(), true));
    assert_eq!((&server.frames(1)["true_m"], coming()), (&0.3.into(), false));
    server.act("control", "{\"laser_freq\":1}");
    assert!(!coming(), "a switch is no part of the scene");
    server.act("scene", "{\"target.distance_m\":0.5}");
    server.act("scene", "{\"target.distance_m\":0.3}");
    assert!(!coming(), "it is as before");
}

#[test]
fn light_and_fog_are_seen_too() {
    let server = Server::small(&[]);
    let before = server.frames(1);
    server.act("scene", "{\"ambient.irradiance_w_m2_nm\":0}");
    let dark = server.frames(1);
    assert!(of_layer(&before, "ambient") > 50.0 && of_layer(&dark, "ambient") == 0.0);
    server.act("scene", "{\"atmosphere.visibility_m\":0.7,\"target.reflectance\":0.5}");
    let state = server.act("run", "{\"frames\":1}");
    assert!(state["notes"].to_string().contains("atmosphere.visibility_m"), "{}", state["notes"]);
    assert!(state["frame"]["bound_two_sd_mm"].is_null(), "its model is one echo");
}

#[test]
fn dsp_rst_abandons_the_frame() {
    let server = Server::start(&[]);
    server.stop_within_a_frame();
    let held = server.act("control", "{\"dsp_rst\":true}");
    assert_eq!(held["control"]["dsp_rst"], true);
    server.act("run", "{\"running\":true}");
    let held = server.wait(|state| state["progress"]["abandoned"] == 1);
    let frames = held["time"]["frames"].as_u64().unwrap();
    let still =
        server.wait(|state| state["time"]["board_s"].as_f64() > held["time"]["board_s"].as_f64());
    assert_eq!(
        (still["time"]["frames"].as_u64(), &still["progress"]["shots"]),
        (Some(frames), &0.into())
    );
    assert!(still["held"].as_str().unwrap().contains("dsp_rst"));
    server.act("control", "{\"dsp_rst\":false}");
    server.wait(|state| state["time"]["frames"].as_u64() > Some(frames));
    let before = server.stop_within_a_frame();
    server.act("control", "{\"pulse_dsp_rst\":true}");
    let after = server.act("run", "{\"frames\":1}");
    let count = |state: &Value| state["progress"]["abandoned"].as_u64().unwrap();
    assert_eq!(count(&after), count(&before) + 1);
    assert_eq!(after["control"]["dsp_rst"], false);
    assert_eq!(after["frame"]["mixed"], false);
    // The whole of a frame's shots came after the pulse.
    assert_eq!(after["frame"]["shots"], 30_000);
}

#[test]
fn dsp_en_holds_the_histogram_before_the_estimator() {
    let server = Server::small(&["--rate", "1000"]);
    server.act("control", "{\"dsp_en\":false}");
    let refused = server.post("run", "{\"frames\":1}");
    assert!(refused.fault().contains("dsp_en is low"), "{}", refused.fault());
    assert_eq!(server.state()["progress"]["phase"], "Drain");
    server.act("control", "{\"dsp_en\":true}");
    assert_eq!(server.frames(1)["index"], 0);
}

#[test]
fn mode_and_rate_reach_the_firmware() {
    let server = Server::small(&[]);
    let fast = server.frames(1)["frame_cycles"].as_u64().unwrap();
    server.act("control", "{\"laser_freq\":0,\"mode\":1}");
    server.frames(1);
    let state = server.act("run", "{\"frames\":1}");
    let slow = state["frame"]["frame_cycles"].as_u64().unwrap();
    assert_eq!(slow - fast, 300 * (25 - 6));
    assert!(state["notes"].to_string().contains("firmware.mode"), "{}", state["notes"]);
}

#[test]
fn the_same_inputs_give_the_same_frames_whichever_way() {
    let play = |fidelity: &str, seed: &str| {
        let server = Server::small(&["--fidelity", fidelity, "--seed", seed]);
        let mut words = Vec::new();
        for (path, body) in [
            ("control", "{\"laser_freq\":2}"),
            ("scene", "{\"target.distance_m\":0.25}"),
            ("control", "{\"pulse_dsp_rst\":true}"),
            ("control", "{\"mode\":1}"),
            ("run", "{\"power_up\":true}"),
        ] {
            let frame = server.frames(1);
            words.push((frame["depth_raw"].clone(), frame["hits"].clone()));
            server.act(path, body);
        }
        let frame = server.frames(1);
        words.push((frame["depth_raw"].clone(), frame["hits"].clone()));
        words
    };
    let first = play("cycle", "7");
    assert_eq!(first, play("cycle", "7"));
    assert_eq!(first, play("shot", "7"));
    assert_ne!(first, play("shot", "8"));
}

#[test]
fn the_run_so_far_is_a_scenario_that_gives_it_again() {
    let server = Server::small(&[]);
    server.frames(1);
    server.act("control", "{\"laser_freq\":1}");
    server.frames(1);
    server.act("control", "{\"laser_en\":false,\"mode\":1}");
    let last = server.frames(2);
    assert_eq!(server.state()["exact"], true);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.toml");
    std::fs::write(&path, server.get("run.toml").body).unwrap();
    let setup = tofsim::Setup::load(path.to_str().unwrap(), &[]).unwrap();
    let frames = tofsim::Run::new(&setup).frames(4).unwrap();
    assert_eq!(format!("{:09x}", frames[3].words.depth.bits()), last["depth_raw"]);
    assert_eq!(frames[3].hits(), last["hits"].as_u64().unwrap());
}

#[test]
fn every_browser_sees_the_same_state() {
    let server = Server::start(&["--rate", "1000"]);
    let versions = [(); 2].map(|()| {
        let (page, host) = (server.path(), server.host());
        let mut stream = std::net::TcpStream::connect(host).unwrap();
        let request = format!("GET {page}events HTTP/1.1\r\nHost: {host}\r\n\r\n");
        std::io::Write::write_all(&mut stream, request.as_bytes()).unwrap();
        std::io::BufReader::new(stream)
    });
    server.act("control", "{\"laser_en\":false}");
    let stopped = server.act("run", "{\"running\":false}");
    for stream in versions {
        let mut newest = Value::Null;
        for line in std::io::BufRead::lines(stream) {
            let line = line.unwrap();
            let Some(data) = line.strip_prefix("data: ") else { continue };
            newest = serde_json::from_str(data).unwrap();
            if newest["running"] == false {
                break;
            }
        }
        assert_eq!(newest, stopped);
    }
}
