//! Memories of the firmware that are no part of the network.

use tofsim::firmware::carry_chain::Delays;
use tofsim::kernel::U;
use tofsim::network::mem::{Mem, lines};

/// When each tap is reached after a change of `tdc_stop`, in the order of the taps [fs].
pub fn tap_delays(delays: &Delays) -> Mem {
    let mut arrivals = vec![0; delays.order().len()];
    for (&tap, at) in delays.order().iter().zip(delays.arrivals()) {
        arrivals[tap as usize] = u128::from(at.fs());
    }
    Mem { name: "tap_delays.mem", text: lines(arrivals, 8) }
}

/// The ROM of `code_preload`.
pub fn codes(rom: &[U<8>]) -> Mem {
    Mem { name: "codes.mem", text: lines(rom.iter().map(|code| code.get().into()), 2) }
}

/// The ROM of `histogram_preload`.
pub fn histogram(rom: &[U<16>]) -> Mem {
    Mem { name: "histogram.mem", text: lines(rom.iter().map(|count| count.get().into()), 4) }
}
