//! Tests that invalid requests are refused with a reason, and have no effect.

use std::process::Command;

use super::common::Server;

#[test]
fn a_wrong_request_says_what_was_expected() {
    let server = Server::small(&[]);
    for (path, body, expected) in [
        ("control", "", "EOF while parsing"),
        ("control", "[]", "control: "),
        ("control", "{}", "expected laser_freq, mode"),
        ("control", "{\"laser_freq\":4}", "laser_freq = 4: expected 0 to 3"),
        ("control", "{\"laser_freq\":-1}", "control: invalid value"),
        ("control", "{\"mode\":2}", "mode = 2: expected 0 or 1"),
        ("control", "{\"laser\":true}", "unknown field `laser`"),
        ("run", "{}", "expected running, frames or power_up"),
        ("run", "{\"frames\":0}", "frames = 0: expected 1 to 1000"),
        ("scene", "{}", "expected one of target.distance_m"),
        ("scene", "{\"target.cells\":9}", "target.cells = 9: no such key of the scene"),
        ("scene", "{\"target.distance_m\":-1}", "target.distance_m = -1"),
        ("scene", "{\"target.distance_m\":1e999}", "number out of range"),
        ("ila", "{\"arm\":true}", "expected either set_up"),
        (
            "ila",
            "{\"arm\":true,\"set_up\":\"fig_9\"}",
            "no such file or built-in probe configuration",
        ),
        ("ila", "{\"arm\":true,\"set_up\":\"/etc/passwd\"}", "expected the name of a built-in"),
        ("ila", "{\"arm\":true,\"set_up\":\"fig_6_6\",\"trigger\":\"X rising\"}", "no such signal"),
        (
            "ila",
            "{\"arm\":true,\"set_up\":\"fig_6_6\",\"depth\":1000}",
            "depth: 1000: expected a power of two",
        ),
        ("ila", "{\"arm\":true,\"text\":\"x\"}", "set-up:1:2"),
    ] {
        let answer = server.post(path, body);
        assert_eq!(answer.status, 400, "{path} {body}");
        assert!(answer.fault().contains(expected), "{path} {body}: {}", answer.fault());
    }
    for (path, expected) in [
        ("shot.vcd", "no frame has ended yet"),
        ("shot.vcd?shot=x", "expected a whole number"),
        ("shot.vcd?laser", "expected shot=N or signals=GLOB"),
        ("ila.csv", "nothing has been captured yet"),
    ] {
        let answer = server.get(path);
        assert_eq!(answer.status, 400, "{path}");
        assert!(answer.fault().contains(expected), "{path}: {}", answer.fault());
    }
    for path in ["shot.exe", "ila.txt", "nothing", "page/../Cargo.toml", "page/%2e%2e%2fx"] {
        assert_eq!(server.get(path).status, 404, "{path}");
    }
    assert_eq!(server.get("run").status, 405);
    assert_eq!(server.post("control", &" ".repeat(1 << 17)).status, 413);
    let state = server.state();
    assert_eq!((&state["time"]["frames"], &state["ila"]["status"]), (&0.into(), &"idle".into()));
    server.frames(1);
    for (path, expected) in
        [("shot.vcd?shot=300", "expected 0 to 299"), ("shot.vcd?signals=nix", "matches no signal")]
    {
        let answer = server.get(path);
        assert_eq!(answer.status, 400, "{path}");
        assert!(answer.fault().contains(expected), "{path}: {}", answer.fault());
    }
}

#[test]
fn a_scenario_s_file_that_changes_under_the_run_is_not_mixed_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let text = "[firmware]\nshots_per_frame = 300\n";
    std::fs::write(&path, text).unwrap();
    let server = Server::start(&["--stopped", path.to_str().unwrap()]);
    server.frames(1);
    std::fs::write(&path, format!("{text}[tdc]\nbins = 128\n")).unwrap();
    let answer = server.post("scene", "{\"target.distance_m\":0.3}");
    assert!(answer.fault().contains("has changed since the start"), "{}", answer.fault());
    std::fs::remove_file(&path).unwrap();
    assert_eq!(server.post("control", "{\"mode\":1}").status, 400);
    assert_eq!(server.frames(1)["index"], 1);
    std::fs::write(&path, text).unwrap();
    server.act("scene", "{\"target.distance_m\":0.3}");
    assert_eq!(server.frames(1)["true_m"], 0.3);
}

#[test]
fn frames_under_way_are_seen_changed_and_stopped() {
    let server = Server::start(&["--stopped"]);
    std::thread::scope(|scope| {
        let frames = scope.spawn(|| server.post("run", "{\"frames\":1000}"));
        let state = server.wait(|state| state["time"]["frames"].as_u64() > Some(0));
        assert_eq!(state["running"], true);
        server.act("control", "{\"laser_en\":false}");
        server.wait(|state| state["frame"]["laser_en"] == false);
        let stopped = server.act("run", "{\"running\":false}");
        let frames = frames.join().unwrap().fault();
        let done = &stopped["time"]["frames"];
        assert_eq!(frames, format!("run: stopped by another request after {done} of 1000 frames"));
        assert_eq!(server.state()["time"]["frames"], *done);
        assert_eq!(stopped["running"], false);
    });
    // Frames replace frames.
    let replaced = std::thread::scope(|scope| {
        let frames = scope.spawn(|| server.post("run", "{\"frames\":1000}"));
        server.wait(|state| state["running"] == true);
        assert_eq!(server.act("run", "{\"frames\":2}")["running"], false);
        frames.join().unwrap()
    });
    assert!(replaced.fault().contains("stopped by another request"), "{}", replaced.fault());
}

#[test]
fn every_built_in_scenario_of_one_pixel_has_a_page() {
    for (name, text) in tofsim::scenario::builtin::scenarios() {
        if text.contains("\n[array]\n") {
            continue;
        }
        let server = Server::start(&["--stopped", "--fidelity", "shot", name]);
        let answer = server.post("run", "{\"frames\":1}");
        assert!(
            answer.status == 200 || answer.fault().contains("does not end"),
            "{name}: {}",
            answer.fault()
        );
        let laser = server.post("control", "{\"laser_en\":false}");
        assert!(
            laser.status == 200 || laser.fault().contains("dark_frames"),
            "{name}: {}",
            laser.fault()
        );
        let scene = server.post("scene", "{\"target.distance_m\":0.3}");
        assert!(
            scene.status == 200 || scene.fault().contains("stimulus"),
            "{name}: {}",
            scene.fault()
        );
        assert_eq!(server.get("run.toml").status, 200, "{name}");
    }
}

#[test]
fn random_bytes_are_refused_and_the_run_goes_on() {
    let server = Server::small(&[]);
    let mut word = 1u64;
    for _ in 0..200 {
        let body: String = (0..40)
            .map(|_| {
                word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                let some = "{}[]\":,.eE-+0123456789 truefalsnudsp_rmoge";
                some.chars().nth((word >> 33) as usize % some.len()).unwrap()
            })
            .collect();
        for path in ["control", "run", "scene", "ila"] {
            assert_eq!(server.post(path, &body).status, 400, "{path} {body}");
        }
    }
    assert_eq!(server.frames(1)["index"], 0);
}

#[test]
fn ctrl_c_ends_it_with_130() {
    let server = Server::start(&[]);
    let stopped = Command::new("kill").args(["-INT", &server.id().to_string()]).status();
    assert!(stopped.unwrap().success());
    assert_eq!(server.end().code(), Some(130));
}

#[test]
fn a_wrong_command_line_says_what_was_expected() {
    let fault = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_tofsim-serve"));
        let output = command.args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    assert!(fault(&["no_such"]).contains("no such file or built-in scenario"));
    assert!(fault(&["-s", "target.distance_m=-1"]).contains("target.distance_m = -1"));
    assert!(
        fault(&["--fidelity", "histogram"]).contains("expected cycle or shot for a single pixel")
    );
    let server = Server::small(&[]);
    let port = server.host().rsplit(':').next().unwrap();
    let taken = fault(&["--port", port]);
    assert!(taken.contains(&format!("--port: {port}: Address already in use")), "{taken}");
}
