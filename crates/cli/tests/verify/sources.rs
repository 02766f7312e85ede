//! Sources that a tool does not take as they are: byte order marks, packages of Synopsys, another simulator's
//! language, devices; and modules that are not there.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common;

use super::{OWN, counter, refused, verify};

/// The vectors' first lines, which suffice for a design that is right.
const SHORT: [&str; 2] = ["--cycles", "500"];

fn passes(folder: &Path, args: &[&str]) {
    let output = verify(folder, &[&SHORT[..], args].concat());
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{args:?}: {error}");
}

#[test]
fn a_byte_order_mark_in_verilog_is_no_fault() {
    let folder = common::empty();
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/verify/cases");
    for case in ["c15_bom.v", "c15_map.toml"] {
        fs::copy(cases.join(case), folder.path().join(case)).unwrap();
    }
    for simulator in ["icarus", "verilator"] {
        passes(folder.path(), &["--map", "c15_map.toml", "--simulator", simulator]);
    }
    let marked = "\u{feff}".to_owned();
    let map = fs::read_to_string(folder.path().join("c15_map.toml")).unwrap();
    fs::write(folder.path().join("c15_map.toml"), marked.clone() + &map).unwrap();
    fs::write(folder.path().join("list.f"), marked + "c15_bom.v\n").unwrap();
    let list = ["verify", "-f", "list.f", "--map", "c15_map.toml", "--block", "coarse_counter"];
    let output = common::output(folder.path(), &[&list[..], &SHORT].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_byte_order_mark_in_an_included_file_is_none_and_errors_name_the_user_s_files() {
    let folder = counter("output reg [CoarseBits-1:0] coarse", "`include \"width.vh\"\n coarse");
    let width = "\u{feff}output reg [CoarseBits-1:0]\n";
    for (place, args) in [("width.vh", &[][..]), ("inc/width.vh", &["-I", "inc"])] {
        let path = folder.path().join(place);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, width).unwrap();
        passes(folder.path(), args);
        fs::write(&path, width.replace("reg", "reg ]")).unwrap();
        let error = refused(folder.path(), args);
        let name = path.canonicalize().unwrap().display().to_string();
        assert!(error.contains(&format!("{name}:1: ")) && !error.contains("unmarked"), "{error}");
        fs::remove_file(path).unwrap();
    }
}

#[test]
fn a_byte_order_mark_in_the_words_of_a_rom_is_none() {
    let folder = common::empty();
    let text = fs::read_to_string(Path::new(OWN).join("tdc_decoder.v")).unwrap();
    fs::write(folder.path().join("a.v"), text.replace("rtl_ref/tdc_cal.mem", "cal.mem")).unwrap();
    let words = fs::read_to_string(Path::new(OWN).join("tdc_cal.mem")).unwrap();
    fs::write(folder.path().join("cal.mem"), format!("\u{feff}{words}")).unwrap();
    let map = "[block.tdc_decoder.parameters]\nCalFile = \"\"\n";
    fs::write(folder.path().join("map.toml"), map).unwrap();
    let args = ["verify", "--rtl", ".", "--block", "tdc_decoder.default", "--map", "map.toml"];
    let output = common::output(folder.path(), &[&args[..], &SHORT].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

/// A counter in VHDL as people wrote it before `numeric_std`.
const SYNOPSYS: &str = "\u{feff}library ieee;
use ieee.std_logic_1164.all;
use ieee.std_logic_arith.all;
use ieee.std_logic_unsigned.all;
entity coarse_counter is
  port (clk_sys, rst, start : in std_logic; coarse : out std_logic_vector(2 downto 0); window : out std_logic);
end entity;
architecture rtl of coarse_counter is
  signal count : std_logic_vector(2 downto 0) := \"000\";
  signal open_now : std_logic := '0';
begin
  coarse <= count;
  window <= open_now;
  process (clk_sys) begin
    if rising_edge(clk_sys) then
      if rst = '1' then
        count <= \"000\"; open_now <= '0';
      elsif start = '1' then
        count <= \"000\"; open_now <= '1';
      elsif open_now = '1' then
        if conv_integer(count) = 7 then open_now <= '0'; else count <= count + 1; end if;
      end if;
    end if;
  end process;
end architecture;
";

#[test]
fn vhdl_may_use_the_packages_of_synopsys_and_have_a_byte_order_mark() {
    let folder = common::empty();
    let path = folder.path().join("counter.vhd");
    fs::write(&path, SYNOPSYS).unwrap();
    passes(folder.path(), &[]);
    fs::write(&path, SYNOPSYS.replace("open_now = '1' then", "open_now = '1'")).unwrap();
    let error = refused(folder.path(), &[]);
    assert!(error.contains("counter.vhd:2") && !error.contains("unmarked"), "{error}");
}

#[test]
fn what_the_other_simulator_accepts_is_said() {
    let next = "coarse_next = coarse + 1'b1;";
    // Icarus 11 knows no streams, Verilator no tables of primitives.
    let stream = counter(next, "coarse_next = {<<{ {<<{coarse + 1'b1}} }};");
    let path = stream.path().join("coarse_counter.v");
    fs::rename(path, stream.path().join("coarse_counter.sv")).unwrap();
    let error = refused(stream.path(), &[]);
    assert!(
        error.contains("Verilator accepts these files: verify --simulator verilator"),
        "{error}"
    );
    passes(stream.path(), &["--simulator", "verilator"]);

    let table = "endmodule\nprimitive buffer (output o, input i); table 0 : 0; 1 : 1; endtable endprimitive\n";
    let primitive = counter(
        "endmodule\n",
        &table.replacen("endmodule", "buffer b (unused, rst); wire unused;\nendmodule", 1),
    );
    let error = refused(primitive.path(), &["--simulator", "verilator"]);
    assert!(
        error.contains("Icarus Verilog accepts these files: verify --simulator icarus"),
        "{error}"
    );
    passes(primitive.path(), &[]);

    let logic = counter("always @*", "always_comb");
    let error = refused(logic.path(), &[]);
    assert!(error.contains("accepts these files as SystemVerilog: name them .sv"), "{error}");
    let nothing = counter("always @*", "always @*(");
    assert!(!refused(nothing.path(), &[]).contains("accepts"));
}

#[test]
fn a_module_that_is_not_there_is_refused_with_those_that_are() {
    let folder = counter("module coarse_counter", "module coarse_count");
    fs::copy(Path::new(OWN).join("reset_sync.v"), folder.path().join("reset_sync.v")).unwrap();
    let declared = "the files declare coarse_count, reset_sync";
    let expected = format!("coarse_counter: no such module (`coarse_count`?); {declared}");
    for simulator in ["icarus", "verilator"] {
        let error = refused(folder.path(), &["--simulator", simulator]);
        assert!(error.contains(&expected), "{error}");
    }
    fs::write(folder.path().join("map.toml"), "[block.coarse_counter]\nmodule = \"reset_syn\"\n")
        .unwrap();
    let error = refused(folder.path(), &["--map", "map.toml"]);
    assert!(error.contains("module = reset_syn: no such module (`reset_sync`?)"), "{error}");
    fs::remove_file(folder.path().join("reset_sync.v")).unwrap();
    let error = common::refused(folder.path(), &["verify", "--rtl", "."]);
    assert!(error.contains("or a map with their names; the files declare coarse_count"), "{error}");
}

#[test]
fn what_is_no_file_is_refused_at_once_by_name() {
    let folder = counter("", "");
    let pipe = folder.path().join("pipe.v");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for verb in [
        &["verify", "--block", "coarse_counter"][..],
        &["vectors", "tdc", "-o", "out"],
        &["timing"],
    ] {
        for path in ["/dev/zero", "pipe.v"] {
            let error = common::refused(folder.path(), &[verb, &["--rtl", path]].concat());
            let expected = format!("{path}: expected a file, not a pipe or device");
            assert!(error.contains(&expected), "{error}");
        }
    }
    for args in [&["verify", "-f", "/dev/zero"][..], &["verify", "--map", "/dev/zero"]] {
        assert!(
            common::refused(folder.path(), args).contains("/dev/zero: expected a file or a pipe")
        );
    }
    // A pipe in a folder is none of its sources.
    passes(folder.path(), &[]);
    let long = folder.path().join("long.v");
    fs::File::create(&long).unwrap().set_len(300 << 20).unwrap();
    assert!(refused(folder.path(), &[]).contains("long.v: expected 256 MiB at most"));
}
