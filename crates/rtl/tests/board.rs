//! The tops of the boards, compiled for synthesis with models of the vendors' primitives, do what `tof_top` does as it
//! is simulated.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common;
use crate::record::Inputs;

mod faults;
mod guard;
mod pins;
mod scripts;
mod sound;

/// Taps of the chain: few and long ones.
const TAPS: u64 = 64;
/// Delay of each [fs].
const TAP_FS: u64 = 140_500;

/// A board: the macro of its sources, and the file with its primitives.
#[derive(Clone, Copy, PartialEq)]
enum Board {
    Kc705,
    Ecp5,
}

impl Board {
    const ALL: [Board; 2] = [Board::Kc705, Board::Ecp5];

    fn options(self) -> [&'static str; 2] {
        match self {
            Board::Kc705 => ["-DKC705", "series_7.v"],
            Board::Ecp5 => ["-DECP5", "ecp5.v"],
        }
    }
}

/// A fault: boards that have it, file, text and what stands there instead.
type Fault = (&'static [Board], &'static str, &'static str, &'static str);

const KC705: &[Board] = &[Board::Kc705];
const ECP5: &[Board] = &[Board::Ecp5];

const DSP: &str = ".dsp_en(dsp_en),\n        .dsp_rst(dsp_rst)";
const SWAPPED: &str = ".dsp_en(dsp_rst),\n        .dsp_rst(dsp_en)";

const FAULTS: &[Fault] = &[
    (KC705, "kc705_top", DSP, SWAPPED),
    (KC705, "kc705_top", ".laser_on_lvds_p(laser_on_lvds_p)", ".laser_on_lvds_p(laser_on_lvds_n)"),
    (KC705, "kc705_top", ".rst(cpu_reset)", ".rst(!cpu_reset)"),
    (KC705, "kc705_top", ".IB(sysclk_n)", ".IB(sysclk_p)"),
    (ECP5, "ecp5_top", DSP, SWAPPED),
    (ECP5, "ecp5_top", ".rst(!reset_n)", ".rst(reset_n)"),
    (ECP5, "ecp5_top", "locked_n = !locked", "locked_n = locked"),
    (ECP5, "ecp5_top", "clk_in_en = 1'b1", "clk_in_en = 1'b0"),
    (ECP5, "ecp5_top", ".Divide(2)", ".Divide(1)"),
    (ECP5, "ecp5_top", ".OutputDivide(4)", ".OutputDivide(8)"),
    (KC705, "lvds_output", ".O(o)", ".O(ob)"),
    (KC705, "lvds_output", ".I(i)", ".I(!i)"),
    (
        ECP5,
        "lvds_output",
        "assign o = i;\n    assign ob = 1'b0",
        "assign o = !i;\n    assign ob = 1'b0",
    ),
    (KC705, "ddr_output", ".D1(d_first)", ".D1(d_second)"),
    (KC705, "ddr_output", ".D2(d_second)", ".D2(d_first)"),
    (ECP5, "ddr_output", ".D0(d_first)", ".D0(d_second)"),
    (ECP5, "ddr_output", ".D1(d_second)", ".D1(d_first)"),
    (KC705, "kc705_top", ".uart_rx(uart_rx)", ".uart_rx(uart_tx)"),
    (KC705, "kc705_top", ".interlock(interlock)", ".interlock(1'b0)"),
    (KC705, "kc705_top", ".select_pins(select_pins)", ".select_pins(!select_pins)"),
    (&Board::ALL, "ring_oscillator", "runs ? clocks[DivideLog2] : tdc_stop", "clocks[DivideLog2]"),
    (ECP5, "ecp5_top", ".uart_rx(uart_rx)", ".uart_rx(uart_tx)"),
    (ECP5, "ecp5_top", ".interlock(interlock)", ".interlock(1'b0)"),
    (ECP5, "ecp5_top", ".select_pins(!select_pins_n)", ".select_pins(select_pins_n)"),
    (ECP5, "ecp5_top", "armed_n = !armed", "armed_n = armed"),
    (&Board::ALL, "tof_top", "by_host = Hosted && !pins_selected", "by_host = Hosted"),
    (KC705, "pll", ".CLKOUT0_DIVIDE(OutputDivide)", ".CLKOUT0_DIVIDE(OutputDivide / 2)"),
    (KC705, "pll", ".CLKOUT1_DIVIDE(OutputDivide / 2)", ".CLKOUT1_DIVIDE(OutputDivide)"),
    (KC705, "pll", ".DIVCLK_DIVIDE(Divide)", ".DIVCLK_DIVIDE(2)"),
    (KC705, "pll", "1.0e9 / InputHz", "1.0e6 / InputHz"),
    (KC705, "pll", ".CLKFBIN(feedback_in)", ".CLKFBIN(1'b0)"),
    (ECP5, "pll", ".CLKFB_DIV(2 * Multiply / Common)", ".CLKFB_DIV(Multiply / Common)"),
    (ECP5, "pll", ".CLKOP_DIV(OutputDivide / 2)", ".CLKOP_DIV(OutputDivide)"),
    (ECP5, "pll", ".CLKOS_CPHASE(OutputDivide - 1)", ".CLKOS_CPHASE(OutputDivide - 2)"),
    (ECP5, "pll", ".CLKFB(clk_laser)", ".CLKFB(1'b0)"),
    (KC705, "carry_chain", ".CYINIT(k == 0 ? tdc_stop : 1'b0)", ".CYINIT(1'b0)"),
    (KC705, "carry_chain", ".S(4'b1111)", ".S(4'b0111)"),
    (
        KC705,
        "carry_chain",
        ".DI(4'b0000),\n                .S(4'b1111)",
        ".DI(4'b0000),\n                .S(4'b1110)",
    ),
    (KC705, "carry_chain", "4*k - 1)]", "4*k - 2)]"),
    (KC705, "carry_chain", "taps <= carry[Taps-1:0]", "taps <= {carry[Taps-2:0], tdc_stop}"),
    (ECP5, "carry_chain", ".INIT1(16'h0005)", ".INIT1(16'h000A)"),
    (ECP5, "carry_chain", ".A1(tdc_stop)", ".A1(1'b0)"),
    (ECP5, "carry_chain", ".CIN(carry[k])", ".CIN(carry[0])"),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

/// A folder with the firmware, its ROMs and the delays of the chain, and the Verilog in it; it may have a fault.
fn sources(fault: Option<&Fault>) -> (tempfile::TempDir, Vec<PathBuf>) {
    let folder = tempfile::tempdir().unwrap();
    let rtl = root().join("rtl_ref");
    let copy = folder.path().join("rtl_ref");
    fs::create_dir(&copy).unwrap();
    let mut sources = Vec::new();
    for name in common::files(&rtl) {
        fs::copy(rtl.join(&name), copy.join(&name)).unwrap();
        sources.extend(name.ends_with(".v").then(|| copy.join(&name)));
    }
    if let Some((_, file, old, new)) = fault {
        let path = copy.join(format!("{file}.v"));
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(old), "{file}: no {old}");
        fs::write(&path, text.replacen(old, new, 1)).unwrap();
    }
    let delays = (1..=TAPS).map(|tap| format!("{:010x}\n", tap * TAP_FS));
    fs::write(folder.path().join("delays.mem"), delays.collect::<String>()).unwrap();
    let ages = fs::read_to_string(rtl.join("tdc_cal.mem")).unwrap();
    let ages: Vec<_> = ages.lines().step_by(12).take(TAPS as usize + 1).collect();
    fs::write(folder.path().join("cal.mem"), ages.join("\n")).unwrap();
    (folder, sources)
}

/// Runs a program that must succeed, and returns its output.
fn output(command: &mut Command) -> String {
    let done = command.output().expect("iverilog: apt-get install iverilog");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    String::from_utf8(done.stdout).unwrap()
}

/// A bench of a board's top, or of the simulated one.
struct Bench {
    /// Its module, which is its file's stem.
    top: &'static str,
    board: Option<Board>,
}

impl Bench {
    /// Options of the compiler.
    fn options(&self) -> Vec<String> {
        let board = self.board.map(|board| {
            let tap = format!("-DTAP_PS={}", TAP_FS as f64 / 1000.0);
            [board.options()[0].to_owned(), "-DSYNTHESIS".to_owned(), tap]
        });
        let top = ["-g2005", "-s", self.top, "-o", "bench.vvp"].map(str::to_owned);
        top.into_iter().chain(board.into_iter().flatten()).collect()
    }

    /// The bench and the models of the primitives.
    fn files(&self) -> Vec<PathBuf> {
        let models = self.board.map(|board| ["vendor_pll.v", board.options()[1]]);
        let bench = format!("{}.v", self.top);
        let names = [bench.as_str()].into_iter().chain(models.into_iter().flatten());
        names.map(|name| root().join("crates/rtl/tests/board").join(name)).collect()
    }

    /// What it prints; the design may have a fault.
    fn run(&self, fault: Option<&Fault>) -> String {
        let (folder, sources) = sources(fault);
        let mut compiler = Command::new("iverilog");
        compiler.current_dir(folder.path()).args(self.options()).args(self.files()).args(sources);
        output(&mut compiler);
        output(Command::new("vvp").current_dir(folder.path()).args(["-n", "bench.vvp"]))
    }
}

/// Runs a board's top, or the simulated one; the design may have a fault.
fn trace(board: Option<Board>, fault: Option<&Fault>) -> String {
    Bench { top: "bench", board }.run(fault)
}

/// The first line in which two traces differ.
fn difference(found: &str, wanted: &str) -> Option<String> {
    let (mut found, mut wanted) = (found.lines(), wanted.lines());
    loop {
        match (found.next(), wanted.next()) {
            (None, None) => return None,
            (found, wanted) if found != wanted => {
                return Some(format!("expected {wanted:?}, got {found:?}"));
            }
            _ => {}
        }
    }
}

#[test]
fn the_boards_do_in_synthesis_what_is_simulated() {
    let all = [None, Some(Board::Kc705), Some(Board::Ecp5)];
    let read = all.map(|board| faults::inputs(&Bench { top: "bench", board }, None));
    let inputs = Inputs::default().rust("checks", include_str!("board.rs")).all("benches", &read);
    sound::passes("boards in synthesis", &inputs, || {
        let wanted = trace(None, None);
        let depths: BTreeSet<_> =
            wanted.lines().filter_map(|line| between(line, " depth ", " ")).collect();
        assert!(wanted.lines().count() > 1000 && depths.len() > 2, "{wanted}");
        for board in Board::ALL {
            assert_eq!(difference(&trace(Some(board), None), &wanted), None);
        }
    });
}

#[test]
#[ignore = "long: ./check --full"]
fn a_fault_of_a_board_is_found() {
    let wanted = trace(None, None);
    for fault in FAULTS {
        for &board in fault.0 {
            let found = faults::difference(board, fault, &wanted);
            assert_ne!(found, faults::NONE, "{}: {} -> {}", fault.1, fault.2, fault.3);
        }
    }
}

/// What stands between two texts in a line.
fn between<'a>(line: &'a str, before: &str, after: &str) -> Option<&'a str> {
    Some(line.split_once(before)?.1.split_once(after)?.0)
}
