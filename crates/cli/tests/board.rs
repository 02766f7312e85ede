//! `tofsim board`, against a device in software on a pseudo-terminal.

#[path = "../../board/tests/device.rs"]
#[allow(dead_code, reason = "the client's own tests look at more of it")]
mod device;
mod refused;

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use tofsim::firmware::registers::map::{DSP_RST, LASER_EN, RING_ON};
use tofsim::sim::setup::Setup;
use tofsim_rtl::golden::parameters::hash::parameters_hash;

use crate::common::{empty, json, output, stdout, tofsim};

use device::{Device, Faults, HeldFrame, Registers};

/// Keys of an instrument whose estimator states sigma and status, with short frames.
const SET: [&str; 4] = ["-s", "estimator.kind=likelihood", "-s", "firmware.shots_per_frame=3000"];

/// Arguments of `tofsim board` for a device.
fn board<'a>(verb: &'a str, device: &'a Device, args: &[&'a str]) -> Vec<&'a str> {
    [&["board", verb, "--port", &device.port, "--timeout", "0.3"], args].concat()
}

/// The frames of a simulation, as a board would have them.
fn simulated(folder: &Path) -> Value {
    let run = ["run", "--frames", "3", "--waves", "none", "--no-second-opinion", "--json"];
    json(folder, &[&run[..], &SET].concat())
}

fn results(run: &Value) -> Vec<HeldFrame> {
    let setup = setup();
    let held = |frame: &Value| {
        let counts = frame["histogram"].as_array().unwrap().iter();
        let histogram: Vec<_> = counts.map(|count| count.as_u64().unwrap() as u32).collect();
        let words = setup.estimate_words(&histogram);
        HeldFrame {
            depth: words.depth.get(),
            sigma: words.sigma.get(),
            status: words.status.get() as u32,
            valid: words.valid,
            code: words.code as u32,
            histogram,
        }
    };
    run["frames"].as_array().unwrap().iter().map(held).collect()
}

fn setup() -> Setup {
    Setup::load("kc705", &[SET[1], SET[3]]).unwrap()
}

/// A board with the parameters of [`SET`].
fn registers(results: Vec<HeldFrame>) -> Registers {
    Registers::new(parameters_hash(&setup()), results)
}

fn healthy() -> Device {
    Device::on_terminal(registers(vec![HeldFrame::default()]), Faults::default())
}

/// Whether laser and frames are off, some time after the program has ended.
fn is_off(device: &Device) -> bool {
    let begun = Instant::now();
    loop {
        let now = device.state().registers.clone();
        if !now.armed && now.control == DSP_RST.with(0, 1) {
            return true;
        }
        if begun.elapsed() > Duration::from_secs(5) {
            return false;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn frames_have_the_form_of_a_run_and_the_words_of_the_board() {
    let folder = empty();
    let path = folder.path();
    let run = simulated(path);
    let device = Device::on_terminal(registers(results(&run)), Faults::default());
    let args = ["--frames", "3", "--laser", "--json", "-o", "out", "--csv", "--npy", "--parquet"];
    let own = json(path, &board("run", &device, &[&args[..], &SET].concat()));
    assert!(device.state().registers.lit > 0 && is_off(&device));

    let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    let of_board = ["source", "board"];
    let shared: Vec<_> =
        keys(&own).into_iter().filter(|key| !of_board.contains(&&key[..])).collect();
    let with_opinion = [&keys(&run)[..], &["second_opinion".to_owned()]].concat();
    assert!(shared.iter().all(|key| with_opinion.contains(key)), "{shared:?}");
    assert_eq!((&own["schema"], &own["source"]), (&"tofsim.run/1".into(), &"board".into()));
    assert_eq!(
        (&own["board"]["port"], &own["board"]["laser"]),
        (&device.port[..].into(), &true.into())
    );
    assert_eq!(own["fidelity"], Value::Null);
    let frames = |run: &Value| run["frames"].as_array().unwrap().clone();
    for (own, simulated) in frames(&own).iter().zip(frames(&run)) {
        assert_eq!(keys(own), keys(&simulated));
        for key in [
            "index",
            "depth_raw",
            "depth_m",
            "sigma_m",
            "valid",
            "status",
            "status_code",
            "shots",
            "hits",
            "histogram",
        ] {
            assert_eq!(own[key], simulated[key], "{key}");
        }
        for key in ["true_depth_m", "tdc_hits", "estimator_cycles", "frame_cycles"] {
            assert_eq!(own[key], Value::Null, "{key}");
        }
    }
    assert_eq!(own["frames"].as_array().unwrap().len(), 3);

    let summary: Value =
        serde_json::from_slice(&fs::read(path.join("out/summary.json")).unwrap()).unwrap();
    assert_eq!(summary["frames"], own["frames"]);
    let files = ["summary.json", "frames.csv", "frames.parquet", "histograms.npy", "depths.npy"];
    assert_eq!(summary["files"], serde_json::json!(files));
    for file in ["out/histograms.npy", "out/frames.parquet"] {
        let again = json(path, &[&["estimate", file, "--json"], &SET[..]].concat());
        let depths: Vec<_> = frames(&own).iter().map(|frame| frame["depth_raw"].clone()).collect();
        let list = again["estimates"]
            .as_array()
            .or(again["histograms"].as_array())
            .unwrap_or_else(|| panic!("{again}"));
        let others: Vec<_> = list.iter().map(|row| row["depth_raw"].clone()).collect();
        assert_eq!(others, depths, "{file}");
    }
    let csv = fs::read_to_string(path.join("out/frames.csv")).unwrap();
    let lines: Vec<_> = csv.lines().collect();
    assert!(lines[0].starts_with("# tofsim-record {") && lines.len() == 5, "{}", lines[0]);
    assert!(lines[1].starts_with("frame,depth_m,depth_raw,sigma_m,valid,status,hits,b0,b1,"));
    let cells: Vec<_> = lines[2].split(',').collect();
    let raw = i64::from_str_radix(own["frames"][0]["depth_raw"].as_str().unwrap(), 16).unwrap();
    assert_eq!((cells.len(), cells[2]), (7 + 256, raw.to_string().as_str()));
}

#[test]
fn without_the_option_the_laser_is_not_armed_and_a_note_says_so() {
    let folder = empty();
    let dark = HeldFrame { histogram: vec![0; 256], ..HeldFrame::default() };
    let device = Device::on_terminal(registers(vec![dark]), Faults::default());
    let output =
        output(folder.path(), &board("run", &device, &[&["--frames", "2"], &SET[..]].concat()));
    let (table, notes) =
        (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert!(output.status.success(), "{notes}");
    assert!(notes.contains("--laser = false: the laser is not armed: frames are dark"), "{notes}");
    assert!(table.starts_with("kc705: likelihood\n") && table.contains("depth [m]"), "{table}");
    assert_eq!(device.state().registers.lit, 0);
    assert!(is_off(&device));
}

#[test]
fn info_says_what_the_board_is_and_whether_it_is_that_of_the_scenario() {
    let folder = empty();
    let device = healthy();
    device.state().registers.laser_faults = 1;
    let args = board("info", &device, &SET);
    let info = json(folder.path(), &[&args[..], &["--json"]].concat());
    assert_eq!((&info["schema"], &info["matches"]), (&"tofsim.board_info/1".into(), &true.into()));
    assert_eq!(
        (&info["system_hz"], &info["host_timeout_ms"]),
        (&125_000_000.into(), &500.0.into())
    );
    assert_eq!(
        (&info["control"]["dsp_rst"], &info["status"]["locked"]),
        (&true.into(), &true.into())
    );
    assert_eq!(info["laser_faults"], serde_json::json!(["host_silent"]));
    let text = stdout(folder.path(), &args);
    assert!(
        text.contains("that of the scenario") && text.contains("The host was silent for longer"),
        "{text}"
    );
    let other = output(folder.path(), &board("info", &device, &[]));
    assert_eq!(other.status.code(), Some(1));
    let text = String::from_utf8(other.stdout).unwrap();
    assert!(text.contains("; the scenario has "), "{text}");
}

#[test]
fn control_signals_and_registers_are_set_by_name() {
    let folder = empty();
    let device = healthy();
    let args = ["laser_freq=5", "ring_on=1", "scratch=0xdeadbeef", "arm=0", "--json"];
    let set = json(folder.path(), &board("set", &device, &args));
    let change = |name: &str, before: u32, after: u32| serde_json::json!({ "name": name, "before": before, "after": after });
    let expected = [
        change("laser_freq", 0, 5),
        change("ring_on", 0, 1),
        change("scratch", 0, 0xdead_beef),
        change("arm", 0, 0),
    ];
    assert_eq!(set["set"], serde_json::json!(expected));
    let control = device.state().registers.control;
    assert_eq!((DSP_RST.of(control), RING_ON.of(control), LASER_EN.of(control)), (1, 1, 0));
}

#[test]
fn a_calibration_is_that_of_the_counts_and_fits_scenario_and_firmware() {
    let folder = empty();
    let path = folder.path();
    let ring: Vec<u32> =
        (0..801).map(|n| if (1..720).contains(&n) { 3 + n % 5 } else { 0 }).collect();
    let device = Device::on_terminal(
        Registers { ring, ..registers(vec![HeldFrame::default()]) },
        Faults::default(),
    );
    let args = ["--hits", "20000", "-o", "cal", "--json"];
    let own = json(path, &board("calibrate", &device, &[&args[..], &SET].concat()));
    assert!(own["hits"].as_u64().unwrap() >= 20_000);
    let tdc = json(path, &["tdc", "calibrate", "cal/counts.csv", "--json"]);
    assert_eq!((&tdc["entries"], &tdc["largest_se_ps"]), (&own["entries"], &own["largest_se_ps"]));
    let mem = fs::read_to_string(path.join("cal/tdc_cal.mem")).unwrap();
    let words: Vec<_> = mem.lines().map(|line| u64::from_str_radix(line, 16).unwrap()).collect();
    let entries = own["entries"].as_array().unwrap();
    let units: Vec<_> = entries.iter().map(|entry| entry["units"].as_u64().unwrap()).collect();
    assert_eq!((words.len(), &words), (801, &units));
    let run = ["run", "--waves", "none", "-s", "tdc.calibration=cal/calibration.csv"];
    stdout(path, &[&run[..], &["-s", "firmware.shots_per_frame=40"]].concat());
    let mut set = SET.to_vec();
    set.extend(["-s", "tdc.calibration=cal/calibration.csv"]);
    let hash = json(path, &board("info", &device, &[&["--json", "-q"], &SET[..]].concat()));
    let calibrated = output(path, &board("info", &device, &[&["--json"], &set[..]].concat()));
    let calibrated: Value = serde_json::from_slice(&calibrated.stdout).unwrap();
    assert_ne!(calibrated["scenario_parameters_hash"], hash["scenario_parameters_hash"]);
    assert!(is_off(&device));
}

#[cfg(unix)]
#[test]
fn an_interrupted_watch_has_printed_a_line_for_each_frame_and_leaves_the_laser_off() {
    let folder = empty();
    let device =
        Device::on_terminal(registers(results(&simulated(folder.path()))), Faults::default());
    let args = board("watch", &device, &[&["--laser"], &SET[..]].concat()).join(" ");
    let args: Vec<_> = args.split(' ').collect();
    let mut child = tofsim(folder.path(), &args).stdout(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let head = lines.next().unwrap().unwrap();
    assert!(head.contains("depth [m]") && head.contains("laser faults"), "{head}");
    for index in 0..4 {
        let line = lines.next().unwrap().unwrap();
        let cells: Vec<_> = line.split_whitespace().collect();
        assert_eq!((cells[0], cells[5]), (index.to_string().as_str(), "-"), "{line}");
    }
    let lit = device.state().registers.clone();
    assert!(lit.armed && LASER_EN.of(lit.control) == 1);
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(sent.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(is_off(&device));
}

#[test]
fn csr_csv_needs_no_board() {
    let folder = empty();
    let text = stdout(folder.path(), &["board", "csr"]);
    assert!(text.starts_with("csr_base,tofsim,0x00000000,,\ncsr_register,identity,"), "{text}");
    stdout(folder.path(), &["board", "csr", "-o", "csr.csv"]);
    assert_eq!(fs::read_to_string(folder.path().join("csr.csv")).unwrap(), text);
    let short = stdout(
        folder.path(),
        &["board", "csr", "-s", "tdc.bins=64", "-s", "estimator.kind=centroid"],
    );
    assert!(short.contains("memory_region,histogram,0x00004000,256,io\n"), "{short}");
}
