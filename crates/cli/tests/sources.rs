//! `tofsim verify` on source trees as people have them: sub-folders, includes, macros, packages, lists.

use std::fs;
use std::path::Path;

use crate::common;

const OWN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../rtl_ref");

/// Files that make up a design, and the folder that they stand in.
fn tree(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = common::empty();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

/// Our coarse counter without its parameter, its width in a macro, and a line before it.
fn counter(before: &str) -> String {
    let text = fs::read_to_string(Path::new(OWN).join("coarse_counter.v")).unwrap();
    let parameter = text.find(" #(").unwrap()..text.find(" (\n    input").unwrap();
    let mut fixed = text.clone();
    fixed.replace_range(parameter, "");
    let fixed = fixed.replace("CoarseBits", "3");
    let with_macro = fixed.replace("reg [3-1:0] coarse,", "reg [`WIDTH-1:0] coarse,");
    assert_ne!(fixed, with_macro);
    format!("{before}\n{with_macro}")
}

/// Our coarse counter in SystemVerilog, its type from a package.
fn with_package(package: &str) -> String {
    counter("")
        .replace(
            "module coarse_counter (",
            &format!("module coarse_counter import {package}::*; ("),
        )
        .replace("reg [`WIDTH-1:0]", "count_t")
}

fn passes(folder: &Path, args: &[&str]) -> String {
    let args = [&["verify", "--block", "coarse_counter"], args].concat();
    let output = common::output(folder, &args);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{args:?}: {error}");
    error
}

fn refused(folder: &Path, args: &[&str]) -> String {
    common::refused(folder, &[&["verify", "--block", "coarse_counter"], args].concat())
}

const SIMULATORS: [&str; 2] = ["icarus", "verilator"];

#[test]
fn a_missing_include_is_named_and_a_folder_for_it_helps() {
    let counter = counter("`include \"width.vh\"");
    let folder = tree(&[("rtl/sub/counter.v", &counter), ("inc/width.vh", "`define WIDTH 3\n")]);
    for simulator in SIMULATORS {
        let args = ["--rtl", "rtl", "--simulator", simulator];
        let error = refused(folder.path(), &args);
        let first = error.lines().find(|line| line.contains("width.vh")).unwrap();
        assert!(error.contains("coarse_counter: not checked: rtl: "), "{error}");
        assert!(error.contains("-I DIR"), "{error}");
        assert!(first.contains("counter.v:"), "{error}");
        passes(folder.path(), &[&args[..], &["-I", "inc"]].concat());
    }
    fs::copy(folder.path().join("inc/width.vh"), folder.path().join("rtl/sub/width.vh")).unwrap();
    for simulator in SIMULATORS {
        passes(folder.path(), &["--rtl", "rtl", "--simulator", simulator]);
    }
}

#[test]
fn a_missing_macro_is_named_and_its_definition_helps() {
    let folder = tree(&[("counter.v", &counter(""))]);
    for simulator in SIMULATORS {
        let args = ["--rtl", "counter.v", "--simulator", simulator];
        let error = refused(folder.path(), &args);
        assert!(error.contains("-D NAME=VALUE") && error.contains("WIDTH"), "{error}");
        passes(folder.path(), &[&args[..], &["-D", "WIDTH=3"]].concat());
        let error = refused(folder.path(), &[&args[..], &["-DWIDTH=4"]].concat());
        assert!(error.contains("has 4 bits, expected 3"), "{error}");
    }
    let error = refused(folder.path(), &["-D", "WIDTH=3"]);
    assert!(error.contains("--rtl"), "{error}");
}

#[test]
fn packages_come_before_their_users_whatever_their_files_are_called() {
    let types =
        "// import z_none::*;\npackage types; typedef logic [sizes::WIDTH-1:0] count_t; endpackage";
    let sizes = "package sizes; localparam WIDTH = 3; endpackage";
    let folder = tree(&[("a.sv", &with_package("types")), ("b.sv", types), ("c/d.sv", sizes)]);
    for simulator in SIMULATORS {
        passes(folder.path(), &["--rtl", ".", "--simulator", simulator]);
        let files = ["--rtl", "a.sv", "--rtl", "b.sv", "--rtl", "c/d.sv", "--simulator", simulator];
        passes(folder.path(), &files);
    }
    let circle = "package sizes; localparam WIDTH = 3; typedef types::count_t t; endpackage";
    fs::write(folder.path().join("c/d.sv"), circle).unwrap();
    let error = refused(folder.path(), &["--rtl", "."]);
    assert!(error.contains("packages that do not need each other"), "{error}");
    assert!(error.contains("b.sv") && error.contains("d.sv"), "{error}");
}

#[test]
fn the_benches_take_a_design_in_system_verilog_as_they_are() {
    let text = counter("").replace("output reg [`WIDTH-1:0]", "output logic [2:0]");
    let text =
        text.replace("always @*", "always_comb").replace("always @(posedge", "always_ff @(posedge");
    let text = text.replace("output reg window", "output logic window");
    let initial = text.find("    initial begin").unwrap()..text.find("    always_comb").unwrap();
    let mut text = text;
    text.replace_range(initial, "");
    let folder = tree(&[("counter.sv", &text)]);
    // Without initial values, the first cycle has unknown ones: a design in this style has declared them.
    let declared = text
        .replace("output logic [2:0] coarse,", "output logic [2:0] coarse = 3'd0,")
        .replace("output logic window ", "output logic window = 1'b0 ");
    fs::write(folder.path().join("counter.sv"), declared).unwrap();
    for simulator in SIMULATORS {
        passes(folder.path(), &["--rtl", ".", "--simulator", simulator]);
    }
}

#[test]
fn what_a_block_does_not_need_does_not_disturb_it() {
    let text = counter("`include \"width.vh\"");
    let files = [
        ("rtl/counter.v", text.as_str()),
        ("rtl/width.vh", "`define WIDTH 3\n"),
        ("sim/tb.v", "module tb; this is no Verilog"),
        ("old/one/tb.v", "module tb; endmodule"),
        ("syn/mem.v", "module mem; endmodule"),
        ("old/mem.v", "module mem; endmodule"),
        (".git/counter.v", "module coarse_counter; endmodule"),
    ];
    let folder = tree(&files);
    #[cfg(unix)]
    std::os::unix::fs::symlink(folder.path(), folder.path().join("rtl/loop")).unwrap();
    for simulator in SIMULATORS {
        passes(folder.path(), &["--rtl", ".", "--simulator", simulator]);
    }
    fs::copy(folder.path().join("rtl/counter.v"), folder.path().join("old/counter.v")).unwrap();
    let error = refused(folder.path(), &["--rtl", "."]);
    let said = "module = coarse_counter: expected it in one file, found it in ";
    assert!(error.contains(said), "{error}");
    assert!(error.contains("old/counter.v") && error.contains("rtl/counter.v"), "{error}");
}

#[test]
fn file_lists_name_sources_folders_macros_and_libraries() {
    let top = counter("").replace("endmodule", "endmodule\nmodule unused; helper h(); endmodule");
    let list = "// design\n+incdir+inc\n+define+WIDTH=3 // [bits]\n-timescale=1ns/1ps\n\
        $TOFSIM_TEST_FOLDER/counter.v\n-y lib +libext+.v\n-f more.f\n";
    let folder = tree(&[
        ("src/counter.v", &top),
        ("lists/design.f", list),
        ("lists/more.f", "# nothing\n"),
        ("more.f", ""),
        ("inc/a.vh", ""),
        ("lib/helper.v", "module helper; endmodule"),
    ]);
    let run = |args: &[&str]| {
        let args = [&["verify", "--block", "coarse_counter"], args].concat();
        let mut command = common::tofsim(folder.path(), &args);
        let output = command.env("TOFSIM_TEST_FOLDER", folder.path().join("src")).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (status, error) = run(&["-f", "lists/design.f"]);
    assert_eq!(status, Some(0), "{error}");
    assert!(
        error.contains("lists/design.f:4: -timescale=1ns/1ps: no option of a source"),
        "{error}"
    );
    let (status, error) = run(&["-F", "lists/design.f"]);
    assert_eq!(status, Some(2));
    assert!(error.contains("lists/design.f:2: +incdir+inc: no folder"), "{error}");
    let error = refused(folder.path(), &["-f", "lists/design.f"]);
    let said = "design.f:5: $TOFSIM_TEST_FOLDER/counter.v: expected a value of $TOFSIM_TEST_FOLDER";
    assert!(error.contains(said), "{error}");
}
