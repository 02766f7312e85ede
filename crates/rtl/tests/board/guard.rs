//! The rules of `laser_guard`: each is proven of its Verilog, and shown on the boards' tops.

use std::process::Command;
use std::sync::LazyLock;

use crate::record::{Inputs, Record};

use super::{Bench, Board, ECP5, Fault, KC705, faults, root, sound};

/// The rules, in the order of their numbers in `proof.v`, each with a fault that breaks it.
const RULES: [(&str, &str, &str); 5] = [
    ("unlocked and interlocked", "cut = !locked || interlock;", "cut = !locked;"),
    ("not armed", "if (arming == 3'd1) armed", "if (arming <= 3'd1) armed"),
    ("host_silent", "silence >= HostTimeout;", "silence >= 2 * HostTimeout;"),
    ("pulse_too_long", "blocks_first || run_next + 4'd1 >=", "blocks_first || run_next >="),
    ("rate_too_high", "gap_next = ShortestPeriod - 16'd1;", "gap_next = ShortestPeriod - 16'd2;"),
];

/// What Yosys says of a rule.
const PROVEN: &str = "Induction step proven: SUCCESS!";
const DISPROVEN: &str = "model found for base case: FAIL!";

static PROOFS: LazyLock<Record> = LazyLock::new(|| {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/board/guard.record");
    Record::read(path, "cargo test -p tofsim-rtl --test rtl each_rule_is_proven -- --ignored")
});

/// The last line of Yosys on a rule of some Verilog of the guard, by the record; `of` says which Verilog that is.
fn prove(rule: usize, of: &str, guard: &str) -> String {
    let proof = include_str!("proof.v");
    let script = format!(
        "read_verilog -sv -formal -DRULE={rule} proof.v laser_guard.v; hierarchy -top proof; proc; flatten; \
         opt_expr; opt_clean; clk2fflogic; opt_clean; \
         sat -tempinduct -prove-asserts -seq 1 -maxsteps 60 proof"
    );
    let inputs = Inputs::default()
        .version("yosys", "-V")
        .text("script", &script)
        .verilog("proof.v", proof)
        .verilog("laser_guard.v", guard);
    PROOFS.answer(of, &inputs, || Ok(ask_yosys(&script, proof, guard)))
}

/// Runs that script on those files; the last line on the proof.
fn ask_yosys(script: &str, proof: &str, guard: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("proof.v"), proof).unwrap();
    std::fs::write(folder.path().join("laser_guard.v"), guard).unwrap();
    let mut yosys = Command::new("yosys");
    yosys.current_dir(folder.path()).args(["-p", script]);
    let done = yosys.output().expect("yosys: apt-get install yosys");
    let said = String::from_utf8_lossy(&done.stdout);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let ends = ["SUCCESS!", "FAIL!", "proof failed."];
    let last = said.lines().rfind(|line| ends.iter().any(|end| line.ends_with(end)));
    last.unwrap_or_else(|| panic!("{said}")).to_owned()
}

#[test]
#[ignore = "long: ./check --full"]
fn each_rule_is_proven_and_a_fault_breaks_its_proof() {
    let guard = std::fs::read_to_string(root().join("rtl_ref/laser_guard.v")).unwrap();
    for (rule, (name, old, new)) in RULES.into_iter().enumerate() {
        assert_eq!(prove(rule, name, &guard), PROVEN, "{name}");
        assert_eq!(guard.matches(old).count(), 1, "{name}: {old}");
        let fault = format!("{name}: {old} -> {new}");
        let last = prove(rule, &fault, &guard.replace(old, new));
        assert!(last.ends_with(DISPROVEN), "{fault}: {last}");
    }
}

/// What the host and the laser of a board's top do while each rule is broken.
fn broken_rules(board: Board, fault: Option<&Fault>) -> String {
    Bench { top: "safety", board: Some(board) }.run(fault)
}

/// The section of `docs/board.md` with the waveforms.
const SHOWN: (&str, &str) = ("```text safety\n", "```\n");

#[test]
fn each_rule_switches_the_laser_off_as_the_page_shows() {
    let page = root().join("docs/board.md");
    let text = std::fs::read_to_string(&page).unwrap();
    let from = text.find(SHOWN.0).expect("docs/board.md has the waveforms") + SHOWN.0.len();
    let to = from + text[from..].find(SHOWN.1).unwrap();
    let shown = &text[from..to];
    if std::env::var_os("UPDATE_DOCS").is_some() {
        let found = broken_rules(Board::Kc705, None);
        let updated = format!("{}{found}{}", &text[..from], &text[to..]);
        std::fs::write(&page, updated).unwrap();
        return;
    }
    let read =
        Board::ALL.map(|board| faults::inputs(&Bench { top: "safety", board: Some(board) }, None));
    let checks = Inputs::default().rust("checks", include_str!("guard.rs")).text("page", shown);
    sound::passes("rules of the guard", &checks.all("benches", &read), || {
        for board in Board::ALL {
            assert_eq!(shown, broken_rules(board, None), "UPDATE_DOCS=1 writes it");
        }
    });
    let faults = ["00001", "00010", "00100", "01000", "10000"];
    let of_rules = shown.lines().filter_map(|line| line.trim().strip_prefix("laser_faults "));
    let expected = faults.map(|bits| format!("{bits}, armed 0, then 0 pulses"));
    assert_eq!(of_rules.collect::<Vec<_>>(), expected);
    assert!(shown.starts_with("not armed\n  armed 0, 0 pulses\n"), "{shown}");
}

/// Faults on the way from the guard to the laser's last register.
const FAULTS: &[Fault] = &[
    (&Board::ALL, "tof_top", ".laser_off(laser_off)", ".laser_off(1'b0)"),
    (&Board::ALL, "tof_top", ".laser_block(laser_block)", ".laser_block({Halves{1'b0}})"),
    (&Board::ALL, "tof_top", ".interlock(interlock && Hosted)", ".interlock(1'b0)"),
    (&Board::ALL, "tof_top", ".heard(heard),\n        .arm", ".heard(1'b1),\n        .arm"),
    (KC705, "ddr_output", ".R(is_off)", ".R(1'b0)"),
    (ECP5, "ddr_output", ".RST(is_off)", ".RST(1'b0)"),
];

#[test]
#[ignore = "long: ./check --full"]
fn a_fault_between_the_guard_and_the_laser_is_found() {
    for board in Board::ALL {
        let sound = broken_rules(board, None);
        for fault in FAULTS.iter().filter(|fault| fault.0.contains(&board)) {
            let [file, old, new] = [fault.1, fault.2, fault.3];
            assert_ne!(broken_rules(board, Some(fault)), sound, "{file}: {old} -> {new}");
        }
    }
}

/// Periods of the ring oscillator within a time [ps], with 500 ps a look-up table, and the rises after it is off.
fn ring(board: Board) -> String {
    let here = root().join("crates/rtl/tests/board");
    let folder = tempfile::tempdir().unwrap();
    let bench = "`timescale 1ps / 1fs\nmodule bench; reg enable; wire hit; integer rises;\n\
        ring_oscillator ring_oscillator (.enable(enable), .tdc_stop(1'b0), .hit(hit));\n\
        always @(posedge hit) rises = rises + 1;\n\
        initial begin enable = 0; rises = 0; #50000 $write(\"%0d \", rises); enable = 1;\n\
        #1200100 $write(\"%0d \", rises); enable = 0; #50000 rises = 0; #1000000 $display(\"%0d\", rises);\n\
        $finish; end endmodule\n";
    std::fs::write(folder.path().join("bench.v"), bench).unwrap();
    let mut compiler = Command::new("iverilog");
    compiler
        .current_dir(folder.path())
        .args(["-g2005", "-s", "bench", "-o", "ring.vvp", "bench.v"]);
    let [name, primitives] = board.options();
    compiler.args([name, "-DSYNTHESIS", "-DTAP_PS=100"]);
    compiler.arg(root().join("rtl_ref/ring_oscillator.v"));
    compiler.args([here.join("vendor_pll.v"), here.join(primitives)]);
    super::output(&mut compiler);
    super::output(Command::new("vvp").current_dir(folder.path()).args(["-n", "ring.vvp"]))
}

#[test]
fn the_ring_oscillates_while_it_is_enabled() {
    // 15 look-up tables, twice around for a period, eight of which are one of the output: 120 ns.
    for board in Board::ALL {
        assert_eq!(ring(board), "0 10 0\n");
    }
}
