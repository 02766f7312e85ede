//! The register map: the one table from which Verilog, host and `csr.csv` have their addresses.
//!
//! An address counts words of 32 bits. A register of two words has its upper word first, as LiteX has it.

/// A register of the host's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Register {
    /// Its name.
    pub name: &'static str,
    /// Address of its first word [words].
    pub address: u32,
    /// Its length [words].
    pub words: u32,
    /// Whether the host may write it.
    pub writable: bool,
    /// Its meaning.
    pub meaning: &'static str,
}

/// Declares the registers: meaning, name, address, words, and `writable` if the host may write it.
macro_rules! registers {
    ($(#[doc = $doc:literal] $NAME:ident = $name:literal, $address:literal, $words:literal $(, $writable:ident)?;)*) => {
        $(
            #[doc = $doc]
            pub const $NAME: Register = Register {
                name: $name,
                address: $address,
                words: $words,
                writable: registers!(@ $($writable)?),
                meaning: $doc.trim_ascii(),
            };
        )*

        /// Every register, in the order of their addresses.
        pub const ALL: &[Register] = &[$($NAME),*];
    };
    (@) => { false };
    (@ writable) => { true };
}

registers! {
    /// Always 0x746f6673, "tofs".
    IDENTITY = "identity", 0x000, 1;
    /// Version of this map.
    MAP_VERSION = "map_version", 0x001, 1;
    /// Hash of the parameters that the firmware was built with.
    PARAMETERS_HASH = "parameters_hash", 0x002, 2;
    /// Frequency of clk_sys [Hz].
    SYSTEM_HZ = "system_hz", 0x004, 1;
    /// Silence of the host after which the laser goes off [cycles of clk_sys].
    HOST_TIMEOUT = "host_timeout", 0x005, 1;
    /// Keeps what is written.
    SCRATCH = "scratch", 0x006, 1, writable;
    /// Control signals, see the bits of control.
    CONTROL = "control", 0x008, 1, writable;
    /// Frames whose depth may still be estimated, unless frames run freely; counts down.
    FRAMES_PERMITTED = "frames_permitted", 0x009, 1, writable;
    /// Arms the laser when 0x4c415352, "LASR", is written, and disarms it otherwise; reads 1 while it is armed.
    ARM = "arm", 0x00a, 1, writable;
    /// State of the firmware, see the bits of status.
    STATUS = "status", 0x00b, 1;
    /// Why the laser went off since it was armed, see the bits of laser faults.
    LASER_FAULTS = "laser_faults", 0x00c, 1;
    /// Frames that have ended since the reset.
    FRAMES = "frames", 0x010, 1;
    /// Laser shots since the reset.
    SHOTS = "shots", 0x011, 1;
    /// Hits with a code since the reset.
    HITS = "hits", 0x012, 1;
    /// Keeps the last finished frame while it is 1: its number, estimate and histogram.
    HOLD = "hold", 0x018, 1, writable;
    /// Number of the last finished frame plus one; 0 before the first.
    FRAME = "frame", 0x019, 1;
    /// Depth of the last finished frame [2^-29 m], sign extended.
    DEPTH = "depth", 0x01a, 2;
    /// Its standard deviation [2^-29 m].
    SIGMA = "sigma", 0x01c, 2;
    /// Bits that speak against it.
    ESTIMATE_STATUS = "estimate_status", 0x01e, 1;
    /// 1 if they do not.
    ESTIMATE_VALID = "estimate_valid", 0x01f, 1;
    /// Sets all counts of the code density to zero when 1 is written; reads 1 until that is done.
    DENSITY_CLEAR = "density_clear", 0x020, 1, writable;
    /// Hits counted in the code density; it stops at 2^32 - 1.
    DENSITY_HITS = "density_hits", 0x021, 1;
    /// What a host can rely on, a number of the table of status codes.
    ESTIMATE_CODE = "estimate_code", 0x022, 1;
}

/// Value of [`IDENTITY`].
pub const IDENTITY_VALUE: u32 = 0x746f_6673;
/// Value of [`MAP_VERSION`].
pub const MAP_VERSION_VALUE: u32 = 1;
/// Value that arms the laser in [`ARM`].
pub const ARM_KEY: u32 = 0x4c41_5352;

/// A range of words that the host reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Its name.
    pub name: &'static str,
    /// Address of its first word [words].
    pub address: u32,
    /// Its meaning.
    pub meaning: &'static str,
}

/// Histogram of the last finished frame: a word a bin.
pub const HISTOGRAM: Memory = Memory {
    name: "histogram",
    address: 0x1000,
    meaning: "Histogram of the last finished frame, a word a bin [hits].",
};
/// Code density: a word for each `n` from 0 to the number of taps.
pub const CODE_DENSITY: Memory = Memory {
    name: "code_density",
    address: 0x2000,
    meaning: "Hits of each n of the TDC, from 0 to the number of taps [hits].",
};

/// Every memory.
pub const MEMORIES: &[Memory] = &[HISTOGRAM, CODE_DENSITY];

/// Bits of an address that the registers decode; with any other bit set nothing is there, and zero is read.
pub const ADDRESS_BITS: u32 = 14;

/// A bit of a register, or a field that begins there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RegisterBit {
    /// Its name.
    pub name: &'static str,
    /// Its place.
    pub bit: u32,
    /// Its width [bits].
    pub width: u32,
    /// Its meaning.
    pub meaning: &'static str,
}

/// Declares the bits of a register.
macro_rules! bits {
    ($(#[$list_doc:meta])* $list:ident: $(#[doc = $doc:literal] $NAME:ident = $name:literal, $bit:literal, $width:literal;)*) => {
        $(
            #[doc = $doc]
            pub const $NAME: RegisterBit =
                RegisterBit { name: $name, bit: $bit, width: $width, meaning: $doc.trim_ascii() };
        )*

        $(#[$list_doc])*
        pub const $list: &[RegisterBit] = &[$($NAME),*];
    };
}

bits! {
    /// Bits of [`CONTROL`]. After a reset only `dsp_rst` is set, so that frames wait for the host.
    CONTROL_BITS:
    /// Lets the laser fire, while it is armed.
    LASER_EN = "laser_en", 0, 1;
    /// Lets the estimator start.
    DSP_EN = "dsp_en", 1, 1;
    /// Abandons the frame, and holds the next one.
    DSP_RST = "dsp_rst", 2, 1;
    /// SPAD quench mode (Table 6.2).
    MODE = "mode", 3, 1;
    /// Laser repetition rate (Table 6.1).
    LASER_FREQ = "laser_freq", 4, 3;
    /// Hits come from the ring oscillator, for a code density.
    RING_ON = "ring_on", 7, 1;
    /// Frames do not wait for permission.
    FREE_RUNNING = "free_running", 8, 1;
}

impl RegisterBit {
    /// Returns the field's value in a word.
    pub fn of(self, word: u32) -> u32 {
        word >> self.bit & ((1 << self.width) - 1)
    }

    /// Returns a word with the field set to a value of its width.
    pub fn with(self, word: u32, value: u32) -> u32 {
        let mask = ((1 << self.width) - 1) << self.bit;
        word & !mask | value << self.bit & mask
    }
}

bits! {
    /// Bits of [`STATUS`].
    STATUS_BITS:
    /// The PLL has locked; without, nothing answers.
    LOCKED = "locked", 0, 1;
    /// The TDC has been calibrated, and is not being calibrated.
    CALIBRATED = "calibrated", 1, 1;
    /// Shots are being taken.
    ACQUIRING = "acquiring", 2, 1;
    /// The switch selects the control pins.
    PINS_SELECTED = "pins_selected", 3, 1;
    /// The laser is armed.
    ARMED = "armed", 4, 1;
    /// The interlock is open.
    INTERLOCK_OPEN = "interlock_open", 5, 1;
}

bits! {
    /// Bits of [`LASER_FAULTS`].
    FAULT_BITS:
    /// The host was silent for longer than `host_timeout`.
    HOST_SILENT = "host_silent", 0, 1;
    /// The PLL was not locked.
    UNLOCKED = "unlocked", 1, 1;
    /// The interlock was open.
    INTERLOCKED = "interlocked", 2, 1;
    /// A pulse would have been longer than allowed.
    PULSE_TOO_LONG = "pulse_too_long", 3, 1;
    /// A pulse would have come too soon after the one before.
    RATE_TOO_HIGH = "rate_too_high", 4, 1;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_registers_overlap_and_none_reaches_a_memory() {
        let mut free = 0;
        for register in ALL {
            assert!(register.address >= free, "{register:?}");
            free = register.address + register.words;
        }
        assert!(free <= HISTOGRAM.address);
    }

    #[test]
    fn no_two_bits_of_a_register_overlap() {
        for list in [CONTROL_BITS, STATUS_BITS, FAULT_BITS] {
            let all = list.iter().fold(0, |all, bit| {
                let own = bit.with(0, u32::MAX);
                assert_eq!(all & own, 0, "{bit:?}");
                all | own
            });
            assert_eq!(all.count_ones(), list.iter().map(|bit| bit.width).sum::<u32>());
        }
        assert_eq!(LASER_FREQ.of(LASER_FREQ.with(0, 5)), 5);
    }
}
