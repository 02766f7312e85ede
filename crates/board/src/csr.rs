//! The register map as `csr.csv`, which LiteX's `RemoteClient` and `litex_cli` read.
//!
//! The lines are those of LiteX's `get_csr_csv`; its `CSRBuilder` takes the first word of a long register for the upper
//! one, as the map has it. Addresses are in bytes there.

use std::fmt::Write;

use tofsim::firmware::registers::map::{
    ADDRESS_BITS, ALL, ARM_KEY, CODE_DENSITY, HISTOGRAM, IDENTITY_VALUE, MAP_VERSION_VALUE, Memory,
};
use tofsim::sim::setup::Setup;
use tofsim_rtl::golden::parameters::hash::parameters_hash;

/// Bytes of a word.
const WORD: u32 = 4;

/// Returns the register map of a setup's firmware as `csr.csv`.
pub fn csr_csv(setup: &Setup) -> String {
    let mut text = "csr_base,tofsim,0x00000000,,\n".to_owned();
    for register in ALL {
        let (address, mode) =
            (WORD * register.address, if register.writable { "rw" } else { "ro" });
        line(
            &mut text,
            &format!("csr_register,{},{address:#010x},{},{mode}", register.name, register.words),
        );
    }
    // The first two tell LiteX how wide words and addresses are; it reads numbers in decimal.
    let constants = [
        ("config_csr_data_width", 32),
        ("config_bus_address_width", 32),
        ("config_bus_data_width", 32),
        ("config_clock_frequency", setup.scenario.pll.params().system_hz()),
        ("identity_value", IDENTITY_VALUE.into()),
        ("map_version_value", MAP_VERSION_VALUE.into()),
        ("parameters_hash_value", parameters_hash(setup)),
        ("arm_key", ARM_KEY.into()),
    ];
    for (name, value) in constants {
        line(&mut text, &format!("constant,{name},{value},,"));
    }
    let (bins, counts) = (setup.params.histogram.bins, setup.params.tdc.delays.taps() + 1);
    let whole = Memory { name: "registers", address: 0, meaning: "" };
    let regions = [(whole, 1 << ADDRESS_BITS), (HISTOGRAM, bins), (CODE_DENSITY, counts)];
    for (memory, words) in regions {
        let (base, size) = (WORD * memory.address, WORD as usize * words);
        line(&mut text, &format!("memory_region,{},{base:#010x},{size},io", memory.name));
    }
    text
}

fn line(text: &mut String, line: &str) {
    // Writing to memory does not fail.
    let _ = writeln!(text, "{line}");
}
