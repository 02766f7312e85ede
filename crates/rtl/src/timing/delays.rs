//! Delays of the 7 series' primitives, for an estimate.
//!
//! From Yosys's `xilinx/cells_sim.v`, which has prjxray's measurements of an Artix-7 of the slowest grade. A
//! LUT is as fast from each input as from its fastest, as in Vivado's reports. `RAM256X1S` has no delays there:
//! it has those of `RAM128X1D` and one MUXF8 more.

use super::netlist::Cell;

/// A delay [ps].
type Ps = u32;

/// A pin: port and index in it.
type Pin = (&'static str, usize);

/// Delays of a cell.
#[derive(Clone, Debug, Default)]
pub struct Delays {
    /// From an input to an output, for all indices.
    pub through: Vec<(&'static str, &'static str, Ps)>,
    /// Delays from pin to pin.
    pub between: Vec<(Pin, Pin, Ps)>,
    /// From the clock to an output.
    pub starts: Vec<(&'static str, Ps)>,
    /// From an input to the clock.
    pub ends: Vec<(&'static str, Ps)>,
    /// Inputs that have a wire of their own from the cell before.
    pub direct: &'static [&'static str],
}

const LUT: Ps = 127;
const ADDRESSES: [&str; 9] = ["A", "A0", "A1", "A2", "A3", "A4", "A5", "A6", "A7"];
const LUT_INPUTS: [&str; 6] = ["I0", "I1", "I2", "I3", "I4", "I5"];

/// From CYINIT, CI, the four DI and the four S to the four O, then to the four CO; 0: no way.
const CARRY4: [[Ps; 8]; 10] = [
    [482, 598, 584, 642, 536, 494, 592, 580],
    [222, 334, 239, 313, 271, 157, 228, 114],
    [0, 407, 556, 615, 379, 465, 540, 526],
    [0, 0, 537, 596, 0, 445, 520, 507],
    [0, 0, 0, 438, 0, 0, 356, 398],
    [0, 0, 0, 0, 0, 0, 0, 385],
    [223, 400, 523, 582, 340, 433, 512, 508],
    [0, 205, 558, 618, 0, 469, 548, 528],
    [0, 0, 226, 330, 0, 0, 292, 378],
    [0, 0, 0, 227, 0, 0, 0, 380],
];

impl Delays {
    /// Returns the delays of a cell; `None` for one that is not known.
    pub fn of(cell: &Cell) -> Option<Self> {
        let kind = cell.kind.as_str();
        let lut = |port| (port, "O", LUT);
        let none = Delays::default();
        Some(match kind {
            "INV" => Delays { through: vec![("I", "O", LUT)], ..none },
            _ if kind.starts_with("LUT") => {
                Delays { through: LUT_INPUTS.map(lut).to_vec(), ..none }
            }
            "MUXF7" => muxf(223, 296),
            "MUXF8" => muxf(104, 273),
            "CARRY4" => carry4(),
            _ if kind.starts_with("FD") => Delays {
                starts: vec![("Q", 303)],
                ends: vec![("D", 0), ("CE", 109), ("R", 404), ("S", 404)],
                ..none
            },
            "RAM256X1S" => ram(642 + 193 + 104 + 175, 1153 + 217 + 104 + 175),
            _ if kind.starts_with("RAM128X1") => ram(642 + 193 + 175, 1153 + 217 + 175),
            _ if kind.starts_with("RAM64") || kind.starts_with("RAM32") => ram(642, 1161),
            _ if kind.starts_with("SRL") => {
                Delays { starts: vec![("Q", 1472)], ends: vec![("D", 173), ("CE", 109)], ..none }
            }
            _ if kind.starts_with("RAMB") => block_ram(cell),
            "DSP48E1" => dsp(cell),
            // Clock buffers, pins and what has to do with them.
            "BUFG" | "IBUF" | "OBUF" | "IBUFDS" | "OBUFDS" | "PLLE2_BASE" | "ODDR" | "VCC"
            | "GND" => Delays {
                ends: if kind == "ODDR" { vec![("D1", 0), ("D2", 0)] } else { vec![] },
                ..none
            },
            _ => return None,
        })
    }
}

fn muxf(data: Ps, select: Ps) -> Delays {
    Delays {
        through: vec![("I0", "O", data), ("I1", "O", data), ("S", "O", select)],
        direct: &["I0", "I1"],
        ..Delays::default()
    }
}

fn carry4() -> Delays {
    let pins = |(port, width): (&'static str, usize)| (0..width).map(move |bit| (port, bit));
    let inputs = [("CYINIT", 1), ("CI", 1), ("DI", 4), ("S", 4)].into_iter().flat_map(pins);
    let arcs = |(input, row): (Pin, [Ps; 8])| {
        let outputs = [("O", 4), ("CO", 4)].into_iter().flat_map(pins);
        outputs.zip(row).map(move |(output, ps)| (input, output, ps))
    };
    let all = inputs.zip(CARRY4).flat_map(arcs);
    Delays { between: all.filter(|arc| arc.2 > 0).collect(), direct: &["CI"], ..Delays::default() }
}

/// Distributed RAM: from address and from clock to the word.
fn ram(read: Ps, clock: Ps) -> Delays {
    const OUTPUTS: [&str; 8] = ["O", "SPO", "DPO", "DOA", "DOB", "DOC", "DOD", "DO"];
    const PAIRS: [(&str, &str); 4] =
        [("ADDRA", "DOA"), ("ADDRB", "DOB"), ("ADDRC", "DOC"), ("ADDRD", "DOD")];
    let single = ADDRESSES.iter().flat_map(|port| ["O", "SPO"].map(|word| (*port, word, read)));
    let dual = ["DPRA", "DPRA0", "DPRA1", "DPRA2"].map(|port| (port, "DPO"));
    let pairs = PAIRS.into_iter().chain(dual).map(|(port, word)| (port, word, read));
    let written = ["D", "DI", "DIA", "DIB", "DIC", "DID"].map(|port| (port, 453));
    let addressed = ADDRESSES.iter().chain(&["ADDRD"]).map(|port| (*port, 616));
    Delays {
        through: single.chain(pairs).collect(),
        starts: OUTPUTS.map(|word| (word, clock)).to_vec(),
        ends: written.into_iter().chain(addressed).chain([("WE", 654)]).collect(),
        ..Delays::default()
    }
}

fn block_ram(cell: &Cell) -> Delays {
    let clock = |parameter| if cell.number(parameter) == 1 { 882 } else { 2454 };
    let (a, b) = (clock("DOA_REG"), clock("DOB_REG"));
    let ends: [(Ps, &'static [&'static str]); 5] = [
        (566, &["ADDRARDADDR", "ADDRBWRADDR"]),
        (532, &["WEA", "WEBWE"]),
        (360, &["REGCEAREGCE", "REGCEB", "ENARDEN", "ENBWREN"]),
        (342, &["RSTREGARSTREG", "RSTREGB"]),
        (737, &["DIADI", "DIBDI", "DIPADIP", "DIPBDIP"]),
    ];
    let of_each =
        |(ps, ports): (Ps, &'static [&'static str])| ports.iter().map(move |port| (*port, ps));
    Delays {
        starts: vec![("DOADO", a), ("DOPADOP", a), ("DOBDO", b), ("DOPBDOP", b)],
        ends: ends.into_iter().flat_map(of_each).collect(),
        ..Delays::default()
    }
}

/// A multiplier with accumulator, without its adder before the multiplier.
fn dsp(cell: &Cell) -> Delays {
    let has = |parameter| cell.number(parameter) > 0;
    let multiplies = cell.says("USE_MULT", "MULTIPLY");
    let (to_p, to_m) =
        if multiplies { ([2739, 2608], [1416, 1285]) } else { ([1441, 1428], [0, 0]) };
    let through = if multiplies { [2823, 2690] } else { [1523, 1509] };
    let mut delays = Delays { direct: &["PCIN", "ACIN", "BCIN"], ..Delays::default() };
    let registers = ["AREG", "BREG"].map(has);
    for (k, port) in ["A", "B"].into_iter().enumerate() {
        match (registers[k], multiplies && has("MREG"), has("PREG")) {
            (true, ..) => delays.ends.push((port, [254, 324][k])),
            (_, true, _) => delays.ends.push((port, to_m[k])),
            (.., true) => delays.ends.push((port, to_p[k])),
            _ => delays.through.push((port, "P", through[k])),
        }
    }
    match (has("CREG"), has("PREG")) {
        (true, _) => delays.ends.push(("C", 168)),
        (_, true) => delays.ends.push(("C", 1244)),
        _ => delays.through.push(("C", "P", 1325)),
    }
    let clock = match () {
        () if has("PREG") => Some(329),
        () if multiplies && has("MREG") => Some(1671),
        () if registers[0] => Some(if multiplies { 2952 } else { 1632 }),
        () if registers[1] => Some(if multiplies { 2813 } else { 1616 }),
        () => None,
    };
    delays.starts.extend(clock.map(|ps| ("P", ps)));
    // These are not in cells_sim.v: what selects an operand of the adder is taken to be as slow as C.
    delays.ends.extend([("OPMODE", 1244), ("ALUMODE", 1244), ("CARRYIN", 1244)]);
    delays.ends.extend(["CEA2", "CEB2", "CEC", "CEM", "CEP", "RSTP"].map(|port| (port, 109)));
    delays
}
