//! What a board is, and how it is.

use serde_json::{Map, Value, json};

use tofsim::error::Result;
use tofsim::firmware::registers::map::{
    CONTROL, CONTROL_BITS, DENSITY_HITS, FAULT_BITS, FRAME, FRAMES, HITS, LASER_FAULTS,
    RegisterBit, SHOTS, STATUS, STATUS_BITS,
};
use tofsim::sim::setup::Setup;
use tofsim_board::names::{laser_faults, set_bits};
use tofsim_board::{Board, Identity};
use tofsim_rtl::golden::parameters::hash::parameters_hash;

use crate::text::table::{facts, grouped};

use super::writer::Findings;

/// Registers of a board.
pub struct BoardFindings {
    /// Name of its port.
    pub port: String,
    /// What it says of itself.
    pub identity: Identity,
    /// Hash of the scenario's parameters.
    pub expected_hash: u64,
    /// Names and values of its counters.
    pub counters: Vec<(&'static str, u32)>,
    /// Register `control`.
    pub control: u32,
    /// Register `status`.
    pub status: u32,
    /// Register `laser_faults`.
    pub laser_faults: u32,
}

impl BoardFindings {
    /// Reads them.
    ///
    /// # Errors
    /// When the board does not answer.
    pub fn read(board: &mut Board, setup: &Setup) -> Result<Self> {
        let counters = [FRAMES, FRAME, SHOTS, HITS, DENSITY_HITS];
        let counters = counters.iter().map(|one| Ok((one.name, board.read_word(one)?)));
        Ok(BoardFindings {
            counters: counters.collect::<Result<_>>()?,
            port: board.port().to_owned(),
            identity: *board.identity(),
            expected_hash: parameters_hash(setup),
            control: board.read_word(&CONTROL)?,
            status: board.read_word(&STATUS)?,
            laser_faults: board.read_word(&LASER_FAULTS)?,
        })
    }

    /// Whether the board was built with the scenario's parameters.
    pub fn matches(&self) -> bool {
        self.identity.parameters_hash == self.expected_hash
    }

    /// Returns the names of the bits that are set, with the value of a longer field.
    fn fields(bits: &'static [RegisterBit], word: u32) -> String {
        let set = bits.iter().filter(|bit| bit.of(word) != 0 || bit.width > 1);
        let words: Vec<_> = set
            .map(|bit| match bit.width {
                1 => bit.name.to_owned(),
                _ => format!("{} {}", bit.name, bit.of(word)),
            })
            .collect();
        if words.is_empty() { "-".to_owned() } else { words.join(", ") }
    }
}

/// Returns the fields of a register as a JSON object: flags, and numbers where there are more bits.
fn object(bits: &'static [RegisterBit], word: u32) -> Value {
    let value = |bit: &RegisterBit| match bit.width {
        1 => json!(bit.of(word) != 0),
        _ => json!(bit.of(word)),
    };
    Value::Object(bits.iter().map(|bit| (bit.name.to_owned(), value(bit))).collect())
}

impl Findings for BoardFindings {
    const SCHEMA: &'static str = "tofsim.board_info/1";

    fn json(&self) -> Value {
        let identity = &self.identity;
        let counters = self.counters.iter();
        let counters: Map<_, _> =
            counters.map(|(name, count)| ((*name).to_owned(), json!(count))).collect();
        json!({
            "port": self.port,
            "identity": format!("{:08x}", identity.identity),
            "map_version": identity.map_version,
            "parameters_hash": format!("{:016x}", identity.parameters_hash),
            "scenario_parameters_hash": format!("{:016x}", self.expected_hash),
            "matches": self.matches(),
            "system_hz": identity.system_hz,
            "host_timeout_cycles": identity.host_timeout,
            "host_timeout_ms": identity.host_timeout().as_secs_f64() * 1e3,
            "counters": counters,
            "control": object(CONTROL_BITS, self.control),
            "status": object(STATUS_BITS, self.status),
            "laser_faults": set_bits(FAULT_BITS, self.laser_faults),
        })
    }

    fn text(&self) -> String {
        let identity = &self.identity;
        let hash = match self.matches() {
            true => format!("{:016x}, that of the scenario", identity.parameters_hash),
            false => format!(
                "{:016x}; the scenario has {:016x}",
                identity.parameters_hash, self.expected_hash
            ),
        };
        let faults = match laser_faults(self.laser_faults) {
            faults if faults.is_empty() => "-".to_owned(),
            faults => faults.join(" "),
        };
        let mut rows = vec![
            ("port", self.port.clone()),
            ("register map", format!("version {}", identity.map_version)),
            ("parameters", hash),
            ("clk_sys", format!("{} MHz", f64::from(identity.system_hz) * 1e-6)),
            ("host time-out", format!("{:.3} ms", identity.host_timeout().as_secs_f64() * 1e3)),
        ];
        rows.extend(self.counters.iter().map(|(name, count)| (*name, grouped((*count).into()))));
        rows.extend([
            ("control", Self::fields(CONTROL_BITS, self.control)),
            ("status", Self::fields(STATUS_BITS, self.status)),
            ("laser faults", faults),
        ]);
        format!("{}\n", facts(rows))
    }
}
