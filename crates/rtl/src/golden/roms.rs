//! The memories that the Verilog loads, for a setting.

use tofsim::firmware::carry_chain::Delays;
use tofsim::firmware::histogram_builder::BINS;
use tofsim::firmware::tof_top::{CodeSource, HistogramSource, Params};
use tofsim::kernel::U;
use tofsim::network::mem::{self, Mem, lines};

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

/// All memories of the firmware. The Verilog loads those of an unused stand-in too: zeros.
pub fn tof_top(params: &Params) -> Vec<Mem> {
    let mut roms = mem::depth_estimator(&params.depth_estimator);
    roms.push(mem::tdc_decoder(&params.tdc.cal));
    roms.push(tap_delays(&params.tdc.delays));
    roms.push(match &params.code_source {
        CodeSource::Tdc => codes(&[U::new(0)]),
        CodeSource::Preload(rom) => codes(rom),
    });
    roms.push(match &params.histogram_source {
        HistogramSource::Builder => histogram(&[U::new(0); BINS]),
        HistogramSource::Preload(rom) => histogram(&rom[..]),
    });
    roms
}
