//! Combinational wires, and the source of codes and counts that drives them.

use crate::firmware::carry_chain::Taps;
use crate::firmware::{code_preload, histogram_preload, lvds_output, tdc};
use crate::kernel::Clocked;

use super::{CodeSource, HistogramSource, Params, TofTop, Wires};

impl TofTop {
    /// Takes the edge's part of the TDC or of its stand-in, and its code.
    #[inline(always)]
    pub(crate) fn convert(
        &mut self,
        p: &Params,
        tdc: &tdc::In,
        code_preload: &code_preload::In,
        taps: Taps,
    ) {
        match &p.code_source {
            CodeSource::Tdc => {
                self.tdc.rise(tdc, &p.tdc, taps);
                self.take_code();
            }
            CodeSource::Preload(rom) => {
                self.code_preload.tick(code_preload, rom);
                let preload = &self.code_preload;
                (self.nets.tdc_valid, self.nets.tdc_code) = (preload.tdc_valid, preload.tdc_code);
            }
        }
    }

    /// The code, from the registers of the TDC.
    #[inline(always)]
    pub(crate) fn take_code(&mut self) {
        let decoder = &self.tdc.tdc_decoder;
        (self.nets.tdc_valid, self.nets.tdc_code) = (decoder.tdc_valid, decoder.tdc_code);
    }

    /// Combinational wires beside the code, which only registers drive. Every edge does this; at power-up it is for
    /// who makes the device.
    #[inline(always)]
    pub fn settle(&mut self, p: &Params) {
        self.nets.rst_dsp = self.reset_sync_sys.rst_sync | self.control_sync.dsp_rst_sync;
        self.nets.count = match &p.histogram_source {
            HistogramSource::Builder => {
                if p.frame_ctrl.scan.has_one_histogram() {
                    self.histogram_builder.count(&Wires::histogram_builder(self))
                } else {
                    self.shown(p)
                }
            }
            HistogramSource::Preload(rom) => {
                histogram_preload::count(&Wires::histogram_preload(self), rom)
            }
        };
        self.drive_laser();
    }

    /// The laser's pins, from the driver's register.
    #[inline(always)]
    pub(crate) fn drive_laser(&mut self) {
        self.nets.laser_on = self.vcsel_driver.laser_on();
        self.lvds_output = lvds_output::out(&lvds_output::In { i: self.nets.laser_on });
    }
}
