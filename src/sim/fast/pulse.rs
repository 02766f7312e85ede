//! The laser's pulse on its way through the registers of `clk_laser`, while nobody looks at them.
//!
//! Once the driver has fired, nothing stops the pulse while resets are low, and its light comes two cycles
//! later. So those registers stay at rest, and are brought to where they are when somebody looks. A pulse that
//! outlasts the cycle of its light is stepped, and so is one that was on its way before.

use crate::firmware::tof_top::{Params, TofTop};
use crate::kernel::Time;
use crate::sim::device::Device;

use super::halves::{emit, emit_light, emitter_quiet, emitter_quiet_without_pulse, rest_of_cycle};

/// Cycles from the one in which the driver fires to that of the light.
const FLIGHT: u64 = 2;
/// Longest pulse that is over in the cycle of its light [half cycles of clk_laser].
const SHORT: u32 = 3;

/// The pulses of an acquisition.
pub(super) struct Pulse {
    /// The cycle in which the driver fired last.
    fired: Option<u64>,
    /// `true` if every edge of `clk_laser` is stepped.
    stepped: bool,
}

/// Returns whether pulses are too long to be replayed, or one is on its way whose begin was not seen.
fn is_stepped(top: &TofTop, p: &Params) -> bool {
    p.vcsel_driver.pulse_half_cycles > SHORT || top.vcsel_driver.has_pulse()
}

impl Pulse {
    /// No pulse yet in an acquisition.
    pub(super) fn new(top: &TofTop, p: &Params) -> Self {
        Pulse { fired: None, stepped: is_stepped(top, p) }
    }

    /// Takes the emitter's part of the cycle that ends as `device.cycle` and begins at `now`.
    #[inline(always)]
    pub(super) fn emit(&mut self, device: &mut Device, p: &Params, now: Time) {
        if self.stepped {
            return self.step(device, p, now);
        }
        emit(&mut device.top, p);
        let cycle = device.cycle - 1;
        device.react_to_shot(now, self.fired.is_some_and(|fired| fired + FLIGHT == cycle));
        if device.top.vcsel_driver.registers.fire {
            self.fired = Some(cycle);
        }
    }

    /// Takes the emitter's part of the cycle edge by edge.
    #[inline(never)]
    fn step(&mut self, device: &mut Device, p: &Params, now: Time) {
        let lit = device.top.nets.laser_on;
        emit_light(&mut device.top, p);
        emit(&mut device.top, p);
        device.react(now, device.top.nets.laser_on && !lit);
        rest_of_cycle(&mut device.top, p);
        self.stepped = is_stepped(&device.top, p);
    }

    /// Returns the number of next cycles in which only the laser's count moves in the emitter.
    #[inline(always)]
    pub(super) fn emitter_quiet(&self, top: &TofTop, p: &Params) -> u64 {
        if self.stepped { emitter_quiet(top, p) } else { emitter_quiet_without_pulse(top, p) }
    }

    /// Brings the registers of `clk_laser` to their state after `cycle` cycles.
    pub(super) fn replay(&self, top: &mut TofTop, p: &Params, cycle: u64) {
        let Some(fired) = self.fired.filter(|fired| fired + FLIGHT >= cycle) else { return };
        let registers = top.vcsel_driver.registers;
        for done in fired..cycle {
            // At the first edge the driver had not fired yet.
            top.vcsel_driver.registers.fire = done == fired + 1;
            emit_light(top, p);
            top.vcsel_driver.registers.fire = done == fired;
            rest_of_cycle(top, p);
        }
        top.vcsel_driver.registers = registers;
    }
}
