//! Sends the bytes of a word, the upper one first.

use crate::kernel::U;

use super::{Params, State, UartBridge};

/// Bits of a byte after its start bit: its data and the stop bit.
const BITS: u64 = 9;

impl UartBridge {
    /// The next bit.
    pub(super) fn transmit(&self, d: &mut Self, p: &Params) {
        let q = self;
        d.tx_wait = q.tx_wait - 1;
        if !q.tx_busy {
            let begins = q.state == State::Send;
            (d.tx_busy, d.uart_tx) = (begins, !begins);
            (d.tx_wait, d.tx_left) = (U::new(p.bit_cycles - 1), U::new(BITS));
            d.tx_bits = U::new(1 << 8 | q.write_data.get() >> 24);
        } else if q.tx_wait == 0 {
            d.tx_wait = U::new(p.bit_cycles - 1);
            (d.tx_busy, d.uart_tx) = (q.tx_left != 0, q.tx_left == 0 || q.tx_bits.get() & 1 == 1);
            (d.tx_left, d.tx_bits) = (q.tx_left - 1, U::new(q.tx_bits.get() >> 1));
        }
    }
}
