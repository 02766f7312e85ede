//! Lets a host read and write registers over a serial line, by LiteX's UARTBone.
//!
//! Mirrors `rtl_ref/uart_bridge.v`. Bytes have 8 data bits, no parity and one stop bit; words and addresses come with
//! the most significant byte first.
//!
//! ```text
//! byte   0        1       2 .. 5   6 ..
//! host   command  length  address  words of a write
//! here                             words of a read
//! ```
//!
//! Commands 1 and 3 write, 2 and 4 read; 1 and 2 count the address up, 3 and 4 do not. Any other is ignored with its
//! length and its address. A host that stops within a command is forgotten after a time without a byte; so is one whose
//! byte has no stop bit, with all that it sends before that.

use crate::kernel::{Clocked, U};
use crate::{signals, states};

mod receiver;
mod transmitter;

/// Cycles after an address until its word is taken, less one.
const LAST_WAIT: u64 = 3;

/// Parameters that elaboration fixes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Params {
    /// Length of a bit, 4 or more [cycles of clk_sys].
    pub bit_cycles: u64,
    /// Time without a byte after which a command is forgotten [cycles of clk_sys].
    pub timeout_cycles: u64,
}

impl Params {
    /// Time without a byte after which a command is forgotten, as LiteX has it [ms].
    pub const TIMEOUT_MS: u64 = 100;

    /// For a clock and a baud rate.
    pub fn new(system_hz: u64, baud: u64) -> Self {
        let bit_cycles = (system_hz + baud / 2) / baud;
        Params { bit_cycles, timeout_cycles: system_hz / 1000 * Self::TIMEOUT_MS }
    }
}

states! {
    /// States of a command.
    pub enum State: 3 {
        /// None is under way.
        Command,
        /// Its length comes.
        Length,
        /// Its address comes.
        Address,
        /// A word comes.
        Data,
        /// A word is waited for.
        Read,
        /// A word is sent.
        Send,
        /// A byte had no stop bit.
        Lost,
    }
}

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// From the host, asynchronous.
        pub uart_rx: bool,
        /// The word at `address`, three cycles after it.
        pub read_data: U<32>,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct UartBridge {
        /// To the host.
        #[only_if(Hosted)]
        pub uart_tx: bool = true,
        /// Address of the word [words].
        pub address: U<32>,
        /// `write_data` is to be written.
        pub write_en: bool,
        /// Word that is written, or under way.
        pub write_data: U<32>,
        /// A command is complete; one cycle.
        pub heard: bool,
        /// First flip-flop of `uart_rx`.
        rx_meta: bool = true,
        /// Second flip-flop of `uart_rx`.
        rx_sync: bool = true,
        /// A byte is being received.
        rx_busy: bool,
        /// Until the next look at the line [cycles].
        rx_wait: U<16>,
        /// Bits seen, the start bit too.
        rx_bit: U<4>,
        /// Byte under way.
        rx_byte: U<8>,
        /// `rx_byte` is complete; one cycle.
        rx_valid: bool,
        /// It has no stop bit; one cycle.
        rx_error: bool,
        /// A byte is being sent.
        tx_busy: bool,
        /// Until the next bit [cycles].
        tx_wait: U<16>,
        /// Bits after this one.
        tx_left: U<4>,
        /// Those bits.
        tx_bits: U<9>,
        /// State of the command.
        pub(crate) state: State,
        /// The command.
        command: U<8>,
        /// Words to come.
        length: U<8>,
        /// Bytes of a word that are through, or cycles that a word is waited for.
        bytes: U<2>,
        /// Cycles since the last byte.
        silence: U<32>,
    }
}

impl UartBridge {
    /// Returns the state of the command under way, and its code.
    pub fn under_way(&self) -> (State, u64) {
        (self.state, self.command.get())
    }

    fn writes(&self) -> bool {
        self.command == 1 || self.command == 3
    }

    fn reads(&self) -> bool {
        self.command == 2 || self.command == 4
    }

    fn counts_up(&self) -> bool {
        self.command == 1 || self.command == 2
    }

    /// The word with another byte at its end.
    fn shifted(word: U<32>, byte: U<8>) -> U<32> {
        U::new(word.get() << 8 | byte.get())
    }

    /// A byte of a command, or its end.
    fn proceed(&self, d: &mut Self, i: &In, p: &Params) {
        let q = self;
        let (last_byte, last_word) = (q.bytes == 3, q.length == 1);
        let after = if last_word { State::Command } else { State::Read };
        d.silence = if q.rx_valid { U::new(0) } else { q.silence + 1 };
        if q.write_en && q.counts_up() {
            d.address = q.address + 1;
        }
        (d.write_en, d.heard) = (false, false);
        match q.state {
            State::Command if q.rx_valid => (d.command, d.state) = (q.rx_byte, State::Length),
            State::Length if q.rx_valid => {
                (d.length, d.bytes, d.state) = (q.rx_byte, U::new(0), State::Address);
            }
            State::Address if q.rx_valid => {
                (d.address, d.bytes) = (Self::shifted(q.address, q.rx_byte), q.bytes + 1);
                if last_byte {
                    d.heard = q.length == 0 && (q.writes() || q.reads());
                    d.state = match () {
                        () if q.length == 0 => State::Command,
                        () if q.writes() => State::Data,
                        () if q.reads() => State::Read,
                        () => State::Command,
                    };
                }
            }
            State::Data if q.rx_valid => {
                (d.write_data, d.bytes) = (Self::shifted(q.write_data, q.rx_byte), q.bytes + 1);
                if last_byte {
                    (d.write_en, d.length, d.heard) = (true, q.length - 1, last_word);
                    if last_word {
                        d.state = State::Command;
                    }
                }
            }
            State::Read => {
                d.bytes = q.bytes + 1;
                if q.bytes == LAST_WAIT {
                    (d.write_data, d.state) = (i.read_data, State::Send);
                }
            }
            State::Send if !q.tx_busy => {
                (d.write_data, d.bytes) = (Self::shifted(q.write_data, U::new(0)), q.bytes + 1);
                if last_byte {
                    (d.length, d.heard, d.state) = (q.length - 1, last_word, after);
                    if q.counts_up() {
                        d.address = q.address + 1;
                    }
                }
            }
            _ => {}
        }
        if q.state != State::Read && q.state != State::Send {
            if q.state != State::Command && q.silence == p.timeout_cycles {
                d.state = State::Command;
            }
            if q.rx_error {
                (d.silence, d.state) = (U::new(0), State::Lost);
            }
        }
    }
}

impl Clocked for UartBridge {
    type In = In;
    type Params = Params;

    fn next(&self, i: &In, p: &Params) -> Self {
        let (q, mut d) = (self, *self);
        (d.rx_meta, d.rx_sync) = (i.uart_rx, q.rx_meta);
        q.receive(&mut d, p);
        q.transmit(&mut d, p);
        q.proceed(&mut d, i, p);
        if i.rst {
            (d.uart_tx, d.state) = (true, State::Command);
            (d.rx_busy, d.rx_valid, d.rx_error) = (false, false, false);
            (d.tx_busy, d.write_en, d.heard) = (false, false, false);
        }
        d
    }
}

#[cfg(test)]
mod tests;
