//! The table of sizes and the Verilog agree: its defaults, and the width of every signal in designs of many sizes.

use std::fmt::Write;
use std::fs;
use std::time::Duration;

use tofsim::firmware::vcsel_driver;
use tofsim::hierarchy::{self, Kind};
use tofsim::kernel::sizes::{Size, Sizes};
use tofsim::sim::setup::Setup;
use tofsim_rtl::golden::BLOCKS;
use tofsim_rtl::golden::parameters::{self, Parameter, Parameters};
use tofsim_rtl::verify::process::Limits;
use tofsim_rtl::verify::{Rtl, Simulator};

use crate::common;

/// Scenarios whose sizes differ, with what is set in each.
const DESIGNS: [(&str, &[&str]); 7] = [
    ("kc705", &["tdc.recalibrate_frames=6", "tdc.calibration_hits_log2=11", "tdc.ring_ns=30"]),
    ("kc705", &["estimator.network=uniform-16", "laser.delay_ps=0", "tdc.count_stages=2"]),
    ("kc705", &["estimator.kind=likelihood", "firmware.count_bits=20"]),
    ("fine", &["estimator.kind=centroid"]),
    ("compact", &[]),
    ("long", &["estimator.kind=likelihood"]),
    ("ecp5", &["firmware.pulse_half_cycles=4"]),
];

/// Parameters of the instrument below that are not the default: of stand-ins, the estimator itself, and the end of the
/// window of a chain that the likelihood estimator's netlists were measured with.
const OTHERS: [&str; 4] = ["Codes", "HitsLog2", "Estimator", "WindowEnd"];

/// Value of a literal in Verilog.
fn number(literal: &str) -> Option<u64> {
    let (signed, digits) = literal.split_once('\'').unwrap_or(("", literal));
    let digits =
        if signed.is_empty() { digits } else { digits.trim_start_matches(['s', 'd', 'b']) };
    digits.parse().ok()
}

#[test]
fn parameters_have_the_same_defaults_in_rust_and_verilog() {
    let all =
        parameters::whole::tof_top_in_full(&common::setup("kc705", &["estimator.kind=likelihood"]));
    let expected = |name: &str| {
        if let Some(size) = Size::named(name) {
            return Some(u64::from(Sizes::default().of(size)));
        }
        let (_, value) = all.iter().find(|(own, _)| *own == name && !OTHERS.contains(own))?;
        if let Parameter::Number(number) = value { Some(*number) } else { None }
    };
    let (mut compared, mut wrong) = (0, Vec::new());
    for spec in BLOCKS {
        for name in parameters::declared(spec.verilog) {
            let (_, rest) = spec.verilog.split_once(&format!(" {name} = ")).unwrap();
            let literal = rest.split([',', '\n', ' ']).next().unwrap();
            if let (Some(expected), Some(found)) = (expected(name), number(literal)) {
                compared += 1;
                if found != expected {
                    wrong.push(format!(
                        "{name} in rtl_ref/{}.v: {found}, not {expected}",
                        spec.name
                    ));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "defaults that are not those of Rust: {wrong:#?}");
    assert!(compared > 120, "{compared}");
}

#[test]
fn laser_periods_have_the_same_default_in_rust_and_verilog() {
    let laser = vcsel_driver::Params::default();
    let [shortest, others @ ..] = [3, 2, 1, 0].map(|rate| format!("16'd{}", laser.periods[rate]));
    let default = format!(" LaserPeriods = {{{{5{{{shortest}}}}}, {}}}", others.join(", "));
    for spec in BLOCKS.iter().filter(|spec| spec.verilog.contains(" LaserPeriods = ")) {
        assert!(spec.verilog.contains(&default), "rtl_ref/{}.v has not{default}", spec.name);
    }
}

/// A bench that prints the width of each signal of the whole firmware.
fn bench(setup: &Setup, parameters: &Parameters) -> String {
    let set = parameters.iter().map(|(name, value)| format!(".{name}({})", value.literal()));
    let set = set.collect::<Vec<_>>().join(", ");
    let mut text = format!("module widths;\n  tof_top #({set}) tof_top ();\n  initial begin\n");
    for entry in hierarchy::entries(&setup.params) {
        let path = entry.path();
        writeln!(text, "    $display(\"{path} %0d\", $bits({path}));").unwrap();
    }
    text + "    $finish;\n  end\nendmodule\n"
}

#[test]
fn every_signal_has_the_width_of_the_table_in_designs_of_many_sizes() {
    let mut wrong = Vec::new();
    for (scenario, set) in DESIGNS {
        let (setup, folder) = (common::setup(scenario, set), common::empty());
        let parameters = parameters::whole::tof_top(&setup);
        let mut rtl = Rtl::own(folder.path()).unwrap();
        rtl.options.system_verilog = true;
        for memory in parameters::memories(&parameters) {
            fs::write(folder.path().join(&*memory.name), &memory.text).unwrap();
        }
        let file = folder.path().join("widths.v");
        fs::write(&file, bench(&setup, &parameters)).unwrap();
        let limits = Limits::new(Duration::from_secs(120));
        let compiled =
            Simulator::Icarus.compile(folder.path(), "widths", &[file], &rtl, false, &limits);
        let printed = compiled.unwrap().run(&[], &limits).unwrap().output;
        let entries = hierarchy::entries(&setup.params);
        let widths = entries.iter().map(|entry| format!("{} {}", entry.path(), entry.signal.width));
        let missing = widths.filter(|own| !printed.lines().any(|line| line == own));
        wrong.extend(missing.map(|own| format!("{scenario} {set:?}: {own}")));
        assert!(entries.iter().any(|entry| entry.kind == Kind::Internal));
    }
    assert!(wrong.is_empty(), "widths in Rust that the Verilog does not have: {wrong:#?}");
}
