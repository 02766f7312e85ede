//! Tests of the messages for unusable input, and of the files left behind.

use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use crate::common::{device, empty, files, output, refused, short_run as run, stdout, tofsim};

#[test]
fn a_scenario_that_cannot_be_used_is_refused_with_its_place() {
    let folder = empty();
    let path = folder.path();
    let scenario = |text: &[u8]| {
        fs::write(path.join("s.toml"), text).unwrap();
        refused(path, &["run", "s.toml", "--waves", "none"])
    };
    assert!(scenario(b"[target\n").contains("s.toml:1:"));
    assert!(scenario(b"x = \xff\n").contains("s.toml:1:5: expected UTF-8"));
    assert!(
        scenario(b"[target]\ndistanc_m = 1\n")
            .contains("s.toml:2:1: target.distanc_m: unknown key; did you mean `distance_m`?")
    );
    assert!(
        scenario(b"[target]\ndistance_m = \"far\"\n")
            .contains("s.toml:2:14: target.distance_m = \"far\": expected a number")
    );
    assert!(scenario(b"[target]\ndistance_m = -1\n").contains("from 0.001 to 1000.0 [m]"));
    assert!(scenario(b"[target]\ndistance_m = nan\n").contains("distance_m = nan"));
    assert!(scenario(b"[firmware]\nshots_per_frame = 0\n").contains("from 1 to 16777215"));
    assert!(
        scenario(b"[firmware]\nshots_per_frame = 70000\n")
            .contains("expected 65535 at most, what a word of 16 bits")
    );
    let error = scenario(b"[pll]\nmultiply = 2\n");
    let expected = "s.toml:2:12: pll.multiply = 2: the VCO would run at 400 MHz";
    assert!(error.contains(expected) && error.contains("; pll.multiply = 4 fits"), "{error}");
    let error = scenario(b"[pll]\noutput_divide = 10\n");
    assert!(
        error.contains("chain uniform") && error.contains("10 ns or more, a period"),
        "{error}"
    );
    assert!(
        scenario(b"[stimulus]\nphotons = \"a\"\ncodes = \"b\"\n").contains("one stimulus only")
    );
    assert!(scenario(b"[spad]\non_tdc = 0\n").contains("on_tdc = 0: expected a whole number"));
    assert!(scenario(b"[spad]\ncount = 7\non_tdc = 8\n").contains("on_tdc = 8: expected 7 at"));
    let listed = b"[spad]\non_tdc = 2\n[stimulus]\nphotons = \"a\"\n";
    assert!(scenario(listed).contains("s.toml:2:10: spad.on_tdc = 2: expected 1: the photons"));
    assert!(scenario(b"[[control]]\nlaser_freq = 2\n").contains("control.0.at_us: missing"));
    assert!(scenario(b"[[control]]\nat_us = 2\n[[control]]\nat_us = 1\n").contains("s.toml:4:9"));
    assert!(
        scenario(b"[report]\nwindows = [\"shot:3..1\"]\n")
            .contains("s.toml:2:12: report.windows.0")
    );
    assert!(refused(path, &["run", "missing.toml"]).contains("missing.toml: cannot read"));
    assert!(refused(path, &["run", "."]).contains("cannot read"));
    assert!(refused(path, &["run", "kc750"]).contains("`kc705`?"));
    assert!(refused(path, &["run", "-s", "target.distance_m"]).contains("expected key=value"));
    assert_eq!(files(path), ["s.toml"]);
}

#[test]
fn a_stimulus_that_cannot_be_used_is_refused_with_its_place() {
    let folder = empty();
    let path = folder.path();
    let with = |key: &str, text: &str| {
        fs::write(path.join("stimulus"), text).unwrap();
        fs::write(path.join("s.toml"), format!("[stimulus]\n{key} = \"stimulus\"\n")).unwrap();
        refused(path, &["run", "s.toml", "--waves", "none"])
    };
    assert!(with("photons", "shot,arrival_ps\n0,x\n").contains("stimulus:2:3: arrival_ps = x"));
    assert!(with("photons", "shot,arrival_ps\n0,5\n0,4\n").contains("stimulus:3:3"));
    assert!(with("photons", "shot,arrival_ps\n0,-4\n").contains("from 0 to 1e9"));
    assert!(
        with("codes", "code\n256\n")
            .contains("stimulus:2:1: code = 256: expected a code from 0 to 255")
    );
    assert!(with("histogram", "bin,count\n0,1\n").contains("stimulus"));
    fs::write(path.join("s.toml"), "[stimulus]\nphotons = \"nowhere\"\n").unwrap();
    assert!(refused(path, &["run", "s.toml"]).contains("nowhere: cannot read"));
    let network = ["run", "-s", "estimator.network=unifrom", "--waves", "none"];
    assert!(refused(path, &network).contains("uniform"));
    let chain = ["run", "-s", "tdc.profile=unifrom", "--waves", "none"];
    assert!(refused(path, &chain).contains("`uniform`?"));
}

#[test]
fn a_window_or_a_glob_that_matches_nothing_is_refused_and_leaves_nothing() {
    let folder = empty();
    let path = folder.path();
    let error = |args: &[&str]| refused(path, &run(args));
    assert!(error(&["--window", "shot:8..3"]).contains("8 is not before 3"));
    assert!(error(&["--window", "12us..10us"]).contains("reversed"));
    assert!(error(&["--window", "shot:0..41"]).contains("the run has 40 shots"));
    let late = error(&["--window", "9ms..10ms"]);
    assert!(late.contains("the run ends at 7.28 us"), "{late}");
    assert!(error(&["--window", "shots"]).contains("expected `shot:0..8`"));
    assert!(error(&["--signals", "tdc_cod"]).contains("tdc_code"));
    assert!(error(&["--signals", "[a"]).contains("--signals"));
    assert!(error(&["--events", "shots.txt"]).contains(".csv or .parquet"));
    assert_eq!(files(&path.join("waves")), [""; 0]);
}

#[test]
fn a_frame_that_can_never_end_is_refused() {
    let folder = empty();
    let error = |set: &str| refused(folder.path(), &run(&["--waves", "none", "-s", set]));
    let dsp_en = error("firmware.dsp_en=false");
    assert!(
        dsp_en.contains("scenario kc705: firmware.dsp_en: frame 0 never ends: dsp_en stays low")
    );
    let control = error("control=[{at_us=1,dsp_en=true},{at_us=2,dsp_en=false}]");
    assert!(control.contains("control.1.dsp_en: frame 0 never ends"), "{control}");
    assert!(error("firmware.rst=true").contains("rst stays high"));
    assert!(error("firmware.dsp_rst=true").contains("dsp_rst stays high"));
}

#[test]
fn what_has_no_effect_is_said() {
    let folder = empty();
    let said = |args: &[&str]| {
        let output = output(folder.path(), &run(&[&["--waves", "none"], args].concat()));
        assert!(output.status.success());
        let said = String::from_utf8(output.stderr).unwrap();
        // A short run is none that the network was trained for, nor one that shows an echo.
        let of_few = ["firmware.shots_per_frame = ", "[second-opinion]"];
        let other = |line: &&str| of_few.iter().all(|few| !line.contains(few));
        said.lines().filter(other).collect::<String>()
    };
    assert_eq!(said(&[]), "");
    assert!(
        said(&["-s", "control=[{at_us=9999,mode=1}]"])
            .contains("control = 1 left: the run ended before the last of the changes of control")
    );
    assert!(
        said(&["-s", "tdc.profile=ideal"])
            .contains("tdc.profile = ideal: the network was not trained for it (expected uniform)")
    );
    let photons = folder.path().join("late.csv");
    fs::write(&photons, "shot,arrival_ps\n3,100\n400,100\n").unwrap();
    let photons = format!("stimulus.photons={:?}", photons.to_str().unwrap());
    assert!(
        said(&["-s", &photons])
            .contains("stimulus.photons = 1 left: the run ended before the shots of the last rows")
    );
    assert_eq!(said(&["-q", "-s", &photons]), "");
}

#[test]
fn two_files_of_one_name_are_refused_before_the_run() {
    let folder = empty();
    let error = refused(folder.path(), &run(&["-o", "out", "--events", "out/histogram.csv"]));
    assert!(error.contains("--events: out/histogram.csv: expected another name"), "{error}");
    assert_eq!(files(&folder.path().join("out")), [""; 0]);
}

#[cfg(unix)]
#[test]
fn places_that_cannot_be_written_are_named() {
    let folder = empty();
    let path = folder.path();
    fs::write(path.join("file"), "").unwrap();
    assert!(refused(path, &run(&["-o", "file"])).contains("file: cannot create"));
    assert!(refused(path, &run(&["-o", "file/below"])).contains("cannot create"));
    assert!(refused(path, &run(&["-o", "/proc/tofsim"])).contains("/proc/tofsim: cannot create"));
    let events = refused(path, &run(&["--events", "/nowhere/shots.csv", "--waves", "none"]));
    assert!(events.contains("/nowhere/shots.csv: cannot write"));
}

#[cfg(unix)]
#[test]
fn a_full_disk_is_an_error_and_devices_stay_devices() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let folder = empty();
    let path = folder.path();
    let devices = empty();
    let (full, null) = (device(devices.path(), "full"), device(devices.path(), "null"));
    let (full_name, null_name) = (full.to_str().unwrap(), null.to_str().unwrap());
    let is_device = || fs::metadata(&full).unwrap().file_type().is_char_device();
    fs::create_dir(path.join("waves")).unwrap();
    for format in ["vcd", "fst"] {
        symlink(&full, path.join(format!("waves/kc705.{format}"))).unwrap();
        assert!(refused(path, &run(&["--waves", format])).contains("cannot write"), "{format}");
        fs::remove_file(path.join(format!("waves/kc705.{format}"))).unwrap();
    }
    assert!(
        refused(path, &run(&["--events", full_name, "--waves", "none"])).contains("cannot write")
    );
    assert!(is_device());
    stdout(path, &run(&["--events", null_name, "--waves", "none"]));
    assert!(fs::metadata(&null).unwrap().file_type().is_char_device());
    let full = fs::File::options().write(true).open(&full).unwrap();
    let status = tofsim(path, &run(&["--json", "--waves", "none"])).stdout(full).status().unwrap();
    assert_eq!(status.code(), Some(2));
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_nothing_and_ends_with_130() {
    let folder = empty();
    let path = folder.path();
    let args = ["run", "--frames", "100000", "--events", "shots.csv"];
    let mut child =
        tofsim(path, &args).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let written = path.join("waves");
    while files(&written).is_empty() {
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(50));
    let interrupt =
        std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(interrupt.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(files(path), [""; 0]);
}

#[test]
fn a_reader_that_goes_away_ends_the_program_quietly() {
    let folder = empty();
    let mut child = tofsim(folder.path(), &["scenario", "schema"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let mut error = String::new();
    child.stderr.take().unwrap().read_to_string(&mut error).unwrap();
    assert!(child.wait().unwrap().success());
    assert_eq!(error, "");
}

#[test]
fn an_old_waveform_survives_a_run_that_fails() {
    let folder = empty();
    stdout(folder.path(), &run(&[]));
    let vcd = folder.path().join("waves/kc705.vcd");
    let before = fs::read(&vcd).unwrap();
    refused(folder.path(), &run(&["--window", "9ms..10ms"]));
    assert!(fs::read(&vcd).unwrap() == before);
    assert!(
        files(Path::new(&folder.path().join("waves"))).iter().all(|name| !name.contains("part"))
    );
}

#[test]
fn usage_errors_have_status_2() {
    let folder = empty();
    for args in [&["run", "--frames", "0"][..], &["run", "--waves", "png"], &["fly"], &[]] {
        assert_eq!(output(folder.path(), args).status.code(), Some(2), "{args:?}");
    }
}
