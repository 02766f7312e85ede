//! The waveforms, and what each format or tool leaves out.

use super::files::{Tool, Waveform, file};

/// What GHDL leaves out of a VCD, because Verilog has no such type.
const NO_VERILOG: &[&str] = &[
    "word scalars.state",
    "word scalars.single",
    "word scalars.level",
    "word scalars.modes[",
    "character ",
    "number scalars.gap",
    "number scalars.delay",
    "number scalars.load",
    "number scalars.numbers[",
];

/// What GHDL leaves out of an FST: physical types, and arrays of other than bits.
const NO_ENUMERATION: &[&str] = &[
    "word scalars.modes[",
    "character scalars.name[",
    "number scalars.gap",
    "number scalars.delay",
    "number scalars.load",
    "number scalars.numbers[",
];

/// Records and arrays, which GHDL leaves out of VCD and FST.
const NESTED: &[&str] = &[
    "bits nested.outer.",
    "word ",
    "real ",
    "number ",
    "bits nested.list[",
    "bits nested.grid[",
    "bits nested.cube[",
    "bits nested.words[",
    "bits nested.pair.",
];

/// Fields of a record, and an array of vectors, likewise.
const PORTS: &[&str] = &["bits ports.pair.", "bits ports.seen["];

/// Members, which Verilator leaves out without `--trace-structs`.
const MEMBERS: &[&str] = &[
    "bits structs.pair.",
    "bits structs.outer.",
    "bits structs.packed_grid[",
    "bits structs.pairs[0].",
    "bits structs.pairs[1].",
    "bits structs.either.",
];

/// Whole structures and packed arrays, which Verilator leaves out with `--trace-structs`.
const WHOLE: &[&str] = &[
    "bits structs.pair",
    "bits structs.outer",
    "bits structs.either",
    "bits structs.packed_grid",
    "bits structs.pairs[0]",
    "bits structs.pairs[1]",
];

/// The design for Verilator, whose loop over the rows of the text dump is in the files too.
const fn structs(name: &'static str) -> Waveform {
    file(Tool::Verilator, name).tops(&[["", "TOP."]]).others(&["TOP.structs.unnamedblk1.at"])
}

pub(super) const FILES: &[Waveform] = &[
    file(Tool::Ghdl, "nine.ghw"),
    file(Tool::Ghdl, "nine.vcd"),
    file(Tool::Ghdl, "nine.fst").tops(&[["nine.", ""]]),
    file(Tool::Ghdl, "scalars.ghw"),
    file(Tool::Ghdl, "scalars.vcd").absent(16, NO_VERILOG),
    // `fst2vcd` prints one bit of each integer, and no real number, too.
    file(Tool::Ghdl, "scalars.fst")
        .tops(&[["scalars.", ""]])
        .absent(12, NO_ENUMERATION)
        .cut("real scalars.ratio"),
    file(Tool::Ghdl, "nested.ghw"),
    file(Tool::Ghdl, "nested.vcd").absent(31, NESTED),
    file(Tool::Ghdl, "nested.fst").tops(&[["nested.", ""]]).absent(31, NESTED),
    file(Tool::Ghdl, "ports.ghw"),
    file(Tool::Ghdl, "ports.vcd").absent(5, PORTS),
    file(Tool::Ghdl, "ports.fst").tops(&[["ports.", ""], ["ports_package.", ""]]).absent(5, PORTS),
    file(Tool::Icarus, "levels.vcd"),
    file(Tool::Icarus, "levels.fst"),
    file(Tool::Icarus, "values.vcd").digits(16).first_events(),
    file(Tool::Icarus, "values.fst").first_events(),
    file(Tool::Icarus, "scopes.vcd"),
    file(Tool::Icarus, "scopes.fst"),
    file(Tool::Icarus, "stops.vcd"),
    file(Tool::Icarus, "stops.fst"),
    file(Tool::Icarus, "packed.vcd"),
    file(Tool::Icarus, "packed.fst"),
    file(Tool::Gtkwave, "scalars.vcd2fst.fst").absent(16, NO_VERILOG),
    file(Tool::Gtkwave, "levels.vcd2fst.fst"),
    file(Tool::Gtkwave, "values.vcd2fst.fst").digits(16).first_events(),
    file(Tool::Gtkwave, "scopes.vcd2fst.fst"),
    file(Tool::Gtkwave, "stops.vcd2fst.fst"),
    file(Tool::Gtkwave, "packed.vcd2fst.fst"),
    file(Tool::Gtkwave, "pyvcd_types.vcd2fst.fst").without_ranges().digits(16),
    file(Tool::Gtkwave, "levels.fst2vcd.vcd"),
    file(Tool::Gtkwave, "values.fst2vcd.vcd").digits(16).first_events(),
    file(Tool::Gtkwave, "scopes.fst2vcd.vcd"),
    file(Tool::Gtkwave, "stops.fst2vcd.vcd"),
    file(Tool::Gtkwave, "packed.fst2vcd.vcd"),
    structs("structs.vcd").absent(19, MEMBERS).digits(16),
    structs("structs.fst").absent(19, MEMBERS),
    structs("structs.members.vcd").absent(6, WHOLE).digits(16),
    structs("structs.members.fst").absent(6, WHOLE),
    file(Tool::Yosys, "yosys_states.vcd").without_ranges(),
    file(Tool::Yosys, "yosys_states.fst").without_ranges(),
    file(Tool::Python, "myhdl_states.vcd").without_ranges(),
    file(Tool::Python, "pyvcd_types.vcd").without_ranges().digits(16),
    file(Tool::Python, "amaranth_views.vcd").without_ranges().others(&[
        "bench.top.fsm_state",
        "bench.top.memory.clk",
        "bench.top.memory.rst",
        "bench.top.rst",
    ]),
    file(Tool::Python, "pyrtl_counter.vcd").without_ranges(),
];
