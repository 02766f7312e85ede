//! Receives bytes: looks at each bit in its middle.

use crate::kernel::U;

use super::{Params, UartBridge};

impl UartBridge {
    /// The next look at the line.
    pub(super) fn receive(&self, d: &mut Self, p: &Params) {
        let q = self;
        d.rx_wait = q.rx_wait - 1;
        (d.rx_valid, d.rx_error) = (false, false);
        if !q.rx_busy {
            (d.rx_busy, d.rx_bit) = (!q.rx_sync, U::new(0));
            d.rx_wait = U::new(p.bit_cycles / 2 - 1);
        } else if q.rx_wait == 0 {
            (d.rx_wait, d.rx_bit) = (U::new(p.bit_cycles - 1), q.rx_bit + 1);
            match q.rx_bit.get() {
                0 => d.rx_busy = !q.rx_sync,
                9 => (d.rx_busy, d.rx_valid, d.rx_error) = (false, q.rx_sync, !q.rx_sync),
                _ => d.rx_byte = U::new(u64::from(q.rx_sync) << 7 | q.rx_byte.get() >> 1),
            }
        }
    }
}
