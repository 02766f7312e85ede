//! `tofsim ila capture` as users and scripts meet it.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::LazyLock;

use tofsim_captures::ila::{AnalyserPlan, AnalyserSetup};

use crate::common::{self, empty, files, json, refused, setup, stdout};
use crate::record::{Inputs, Record};

#[test]
fn the_command_writes_all_forms_and_says_when_it_triggered() {
    let folder = empty();
    let args = ["ila", "capture", "--probes", "fig_6_21", "-o", "out", "--json"];
    let report = json(folder.path(), &args);
    assert_eq!(report["schema"], "tofsim.ila_capture/1");
    assert_eq!((report["samples"].as_u64(), report["seed"].as_u64()), (Some(1024), Some(1)));
    assert_eq!(report["scenario"], "estimator_validation");
    assert_eq!(report["trigger_times_us"].as_array().unwrap().len(), 1);
    assert_eq!(
        files(&folder.path().join("out")),
        ["fig_6_21.csv", "fig_6_21.ila", "fig_6_21.map.toml", "fig_6_21.vcd"]
    );
    let table = stdout(folder.path(), &args[..6]);
    assert!(table.contains("triggered") && table.contains("clk_sys"), "{table}");
}

static CORE: LazyLock<Record> = LazyLock::new(|| {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/ila_command/core.record");
    Record::read(path, "cargo test -p tofsim-cli --test cli the_core_for_vivado")
});

const SCRIPT: &str = "crates/rtl/tests/board/vivado.tcl";

/// All that Yosys reads: the script, the core, and Verilog, memories and scripts of `rtl_ref`.
fn inputs_of_core(root: &Path, core: &str) -> Inputs {
    let text = |file: &str| fs::read_to_string(root.join(file)).unwrap();
    let inputs = Inputs::default().version("yosys", "-V").text("core", core);
    let inputs = inputs.text("script", text(SCRIPT));
    let sources = files(&root.join("rtl_ref"));
    sources.iter().filter(|file| !file.ends_with(".md")).fold(inputs, |inputs, file| {
        let text = text(&format!("rtl_ref/{file}"));
        if file.ends_with(".v") { inputs.verilog(file, &text) } else { inputs.text(file, text) }
    })
}

/// The commands of Vivado are those of the script's own test: Yosys finds each net, and its width, in the board's top.
#[test]
fn the_core_for_vivado_has_the_probes_of_the_configuration_on_nets_of_the_board() {
    let folder = empty();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let tcl = |probes: &str| stdout(folder.path(), &["ila", "tcl", "--probes", probes, "kc705"]);
    let shot = tcl("shot");
    for line in [
        "create_debug_core u_ila_0 ila",
        "set_property C_DATA_DEPTH 1024 [get_debug_cores u_ila_0]",
        "connect_debug_port u_ila_0/clk [get_nets [list {tof_top/clk_laser}]]",
        "connect_debug_port u_ila_0/probe3 [get_nets [list {tof_top/vcsel_driver/laser_pulse}]]",
        "set_property port_width 3 [get_debug_ports u_ila_0/probe6]",
        "set_property C_CLK_INPUT_FREQ_HZ 250000000 [get_debug_cores dbg_hub]",
    ] {
        assert!(shot.lines().any(|other| other == line), "{line}: {shot}");
    }
    let all = [&shot, &tcl("fig_6_6"), &tcl("fig_6_21")].map(String::as_str).concat();
    let run = |core: &str| {
        let file = folder.path().join("ila.tcl");
        fs::write(&file, core).unwrap();
        let mut yosys = Command::new("yosys");
        yosys.arg("-c").arg(root.join(SCRIPT));
        yosys.env("SCRIPT", root.join("rtl_ref/kc705.tcl")).env("SLACK", "max 0.1 min 0.1");
        yosys.env("OUT", folder.path().join("out")).env("ILA", file);
        let done = yosys.output().expect("yosys: apt-get install yosys");
        let said = [done.stdout, done.stderr].concat();
        (done.status.success(), String::from_utf8_lossy(&said).into_owned())
    };
    let done = CORE.answer("the nets of the core", &inputs_of_core(&root, &all), || {
        let (is_done, said) = run(&all);
        assert!(is_done, "{said}");
        assert!(said.contains("create_debug_port u_ila_0 probe"), "{said}");
        assert!(said.contains("write_debug_probes -force"), "{said}");
        Ok("found".to_owned())
    });
    assert_eq!(done, "found");
    let other = all.replace("tof_top/spad_rst}", "tof_top/spad_reset}");
    let done = CORE.answer("a net that is not there", &inputs_of_core(&root, &other), || {
        assert!(!run(&other).0);
        Ok("refused".to_owned())
    });
    assert_eq!(done, "refused");
}

#[test]
fn what_a_core_in_the_fpga_cannot_sample_is_refused() {
    let folder = empty();
    let tcl = |args: &[&str]| refused(folder.path(), &[&["ila", "tcl", "--probes"], args].concat());
    let clock = tcl(&["fig_6_13"]);
    assert!(clock.contains("set-up fig_6_13:11:10: probe.0.signal"), "{clock}");
    assert!(clock.contains("expected no clock"), "{clock}");
    let set_up = |name: &str, text: &str| {
        fs::write(folder.path().join(name), text).unwrap();
        tcl(&[name])
    };
    let word = set_up("ram.toml", "[[probe]]\nsignal = \"histogram_builder.ram_0\"\n");
    assert!(word.contains("ram.toml:2:10") && word.contains("a word of a RAM has none"), "{word}");
    let free = set_up("free.toml", "clock = \"100MHz\"\n[[probe]]\nsignal = \"start\"\n");
    assert!(
        free.contains("free.toml:1:9: clock = \"100MHz\": expected clk_sys or clk_laser"),
        "{free}"
    );
    assert!(tcl(&["nowhere"]).contains("no such file or built-in probe configuration"));
}

#[test]
fn options_go_before_the_set_up() {
    let folder = empty();
    let capture = |args: &[&str]| {
        let first = ["ila", "capture", "--probes", "fig_6_6", "-o", "out", "--json"];
        json(folder.path(), &[&first[..], args].concat())
    };
    let args = ["--windows", "4", "--position", "2", "--format", "csv", "--clock", "clk_sys"];
    let report =
        capture(&[&args[..], &["--trigger", "SPAD_RST_DO rising", "--arm-at-us", "0"]].concat());
    assert_eq!(report["window_depth"], 256);
    assert_eq!((&report["windows"], &report["position"]), (&4.into(), &2.into()));
    assert_eq!(report["files"].as_array().unwrap().len(), 2);
    let early = capture(&["--stop-when-full"]);
    assert!(early["end_us"].as_f64() < capture(&[])["end_us"].as_f64());
    let kc705 = capture(&["kc705", "--arm-at-us", "0", "--seed", "9"]);
    assert_eq!((&kc705["scenario"], &kc705["seed"]), (&"kc705".into(), &9.into()));
}

#[test]
fn a_window_that_is_not_full_is_written_and_noted() {
    let folder = empty();
    let args = ["ila", "capture", "kc705", "-s", "firmware.shots_per_frame=40", "-o", "out"];
    let more = [
        "--probes",
        "fig_6_6",
        "--trigger",
        "frame_ctrl.shots == 30",
        "--depth",
        "2048",
        "--arm-at-us",
        "0",
        "--position",
        "16",
    ];
    let done = common::output(folder.path(), &[&args[..], &more].concat());
    assert!(done.status.success());
    let note = String::from_utf8(done.stderr).unwrap();
    assert!(note.contains("0 of 1 windows of 2048 samples"), "{note}");
}

#[test]
fn without_a_trigger_nothing_is_written() {
    let folder = empty();
    let args = ["ila", "capture", "kc705", "-s", "firmware.shots_per_frame=40", "-o", "out"];
    let more = ["--probes", "fig_6_6", "--trigger", "frame_ctrl.shots == 50"];
    let error = refused(folder.path(), &[&args[..], &more].concat());
    assert!(error.contains("--trigger: frame_ctrl.shots == 50: never held before"), "{error}");
    assert_eq!(files(folder.path()), [""; 0]);
}

#[test]
fn faults_of_options_name_them() {
    let folder = empty();
    let args = ["ila", "capture", "--probes", "fig_6_6", "-o", "out"];
    let error = |more: &[&str]| refused(folder.path(), &[&args[..], more].concat());
    assert!(error(&["--depth", "1000"]).contains("--depth: 1000: expected a power of two"));
    assert!(error(&["--trigger", "VCSEL_ON = 1"]).contains("--trigger:1:10: =: expected `==`"));
    assert!(error(&["--position", "9999"]).contains("--position: 9999"));
    assert!(error(&["--stages", "7"]).contains("--stages: 7"));
    assert!(error(&["--arm-at-us", "nan"]).contains("--arm-at-us: NaN"));
    let unknown = ["ila", "capture", "--probes", "fig_6_7", "-o", "out"];
    assert!(refused(folder.path(), &unknown).contains("(`fig_6_"));
    assert_eq!(files(folder.path()), [""; 0]);
}

#[test]
fn faults_of_a_set_up_have_their_place() {
    let of = |scenario: &str, text: &str| {
        let set_up = AnalyserSetup::parse("t", "t.toml", text);
        let setup = setup(scenario, &[]);
        set_up.and_then(|set_up| AnalyserPlan::new(&set_up, &setup)).unwrap_err().to_string()
    };
    let fault = |text: &str| of("kc705", &format!("{text}\n[[probe]]\nsignal = \"rst\""));
    for (text, expected) in [
        ("depth = 3000", "t.toml:1:9: depth = 3000: expected a power of two from 1024"),
        ("depth = 512", "t.toml:1:9: depth = 512: expected a whole number from 1024 to 131072"),
        ("position = 1024", "t.toml:1:12: position = 1024: expected 0 to 1023"),
        ("windows = 2048", "t.toml:1:11: windows = 2048: expected 1 to 1024"),
        ("windows = 1024\nposition = 1", "t.toml:2:12: position = 1: expected 0 to 0"),
        ("input_stages = 7", "t.toml:1:16: input_stages = 7: expected a whole number from 0 to 6"),
        ("clock = \"clk\"", "t.toml:1:9: clock = \"clk\": expected clk_sys"),
        ("name = \"a/b\"", "t.toml:1:8: name = \"a/b\": expected a name of letters"),
        ("trigger = \"rst &\"", "t.toml:1:16: trigger = &: expected a name, a value"),
        ("trigger = \"rst == 2\"", "t.toml:1:19: trigger = 2: expected 0 to 1"),
        ("capture = \"!tdc.tdc_cod == 1\"", "t.toml:1:13: capture = tdc.tdc_cod: no such signal"),
        ("[[probe]]\nsignal = \"rsst\"", "t.toml:2:10: probe.0.signal = \"rsst\": no such signal"),
        ("[[probe]]\nsignal = \"rst\"", "t.toml:4:10: probe.1.signal = \"rst\": probe 0 has this"),
        (
            "[[probe]]\nsignal = \"mode[3]\"",
            "t.toml:2:10: probe.0.signal = \"mode[3]\": `mode` has 1",
        ),
        ("[[probe]]\nname = \"x\"", "t.toml: probe.0.signal: missing"),
    ] {
        let error = fault(text);
        assert!(error.starts_with(expected), "{text}: {error}");
    }
    assert!(of("kc705", "").contains("expected at least one [[probe]]"));
    let ram = "[[probe]]\nsignal = \"histogram_builder.ram_3\"";
    let error = of("estimator_validation", ram);
    assert!(error.contains("leaves this module out"), "{error}");
    let taps: String = (0..6)
        .map(|k| format!("[[probe]]\nname = \"t{k}\"\nsignal = \"tdc.carry_chain.taps\"\n"))
        .collect();
    assert!(of("kc705", &taps).contains("expected at most 4096 bits in all, not 4800"));
}

#[test]
fn a_position_on_the_command_line_goes_before_the_set_up_s() {
    let mut set_up = AnalyserSetup::parse("t", "t.toml", "position = 9").unwrap();
    set_up.override_with("position", "--position", Some(2u64), |file| &mut file.position);
    assert_eq!(set_up.file.position, Some(2));
}

#[test]
fn a_tap_beyond_the_widest_condition_is_refused() {
    let folder = empty();
    let trigger = ["--trigger", "tdc.carry_chain.taps[128] rising"];
    let args = ["ila", "capture", "--probes", "fig_6_6", "-o", "out"];
    let error = refused(folder.path(), &[&args[..], &trigger].concat());
    assert!(error.contains("taps[128]: expected bits of the lowest 128"), "{error}");
}

#[test]
fn set_ups_can_be_listed_and_shown_and_have_a_schema() {
    let folder = empty();
    let list = json(folder.path(), &["ila", "list", "--json"]);
    assert_eq!((list.as_array().unwrap().len(), &list[0]["name"]), (7, &"array".into()));
    assert!(stdout(folder.path(), &["ila", "list"]).contains("fig_6_21"));
    let text = stdout(folder.path(), &["ila", "show", "fig_6_12"]);
    std::fs::write(folder.path().join("own.toml"), &text).unwrap();
    assert_eq!(stdout(folder.path(), &["ila", "show", "own.toml"]), text);
    json(folder.path(), &["ila", "capture", "--probes", "own.toml", "-o", "out", "--json"]);
    assert!(refused(folder.path(), &["ila", "show", "fig_6_7"]).contains("no such file"));
    let schema = json(folder.path(), &["ila", "schema"]);
    assert_eq!(schema["properties"]["depth"]["unit"], "samples");
    let schema = json(folder.path(), &["ila", "schema", "--map"]);
    assert_eq!(schema["properties"]["after_us"]["unit"], "us");
}
