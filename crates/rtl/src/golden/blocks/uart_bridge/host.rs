//! A host that sends commands bit by bit, and spoils some.

use std::collections::VecDeque;

use tofsim::firmware::uart_bridge::{Params, State, UartBridge};

use crate::golden::prelude::*;

/// How a command is spoilt.
#[derive(Clone, Copy)]
pub(super) enum Spoilt {
    /// It stops.
    Stops,
    /// A byte has no stop bit.
    NoStopBit,
}

impl Spoilt {
    /// Kinds, with the bytes that come before.
    pub(super) fn cases() -> impl Iterator<Item = u64> {
        [Spoilt::Stops, Spoilt::NoStopBit].into_iter().flat_map(|kind| (1..10).map(move |bytes| kind.at(bytes)))
    }

    fn at(self, bytes: u64) -> u64 {
        self as u64 * 16 + bytes
    }
}

/// The line from a host, and what it does next.
pub(super) struct HostLine {
    params: Params,
    /// Levels to come, each for so many cycles.
    levels: VecDeque<(bool, u64)>,
    /// Code x 4 + words of the command under way, if it is not spoilt.
    command: Option<u64>,
    /// Cycles since the line was last busy.
    idle: u64,
    /// Commands so far.
    sent: usize,
}

/// Commands with words, code x 4 + words.
pub(super) fn complete() -> impl Iterator<Item = u64> {
    [1, 2, 3, 4].into_iter().flat_map(|code| (0..4).map(move |words| code * 4 + words))
}

impl HostLine {
    pub(super) fn new(params: Params) -> Self {
        HostLine { params, levels: VecDeque::new(), command: None, idle: 0, sent: 0 }
    }

    /// The command that has been completed, once.
    pub(super) fn complete(&mut self) -> Option<u64> {
        self.command.take()
    }

    /// The level of the next cycle; a new command begins where the bridge expects one.
    pub(super) fn level(&mut self, draw: &mut Draw, bridge: &UartBridge, spoilt: &mut Cover) -> bool {
        let (state, _) = bridge.under_way();
        self.idle = if self.levels.is_empty() { self.idle + 1 } else { 0 };
        if self.levels.is_empty() && state == State::Command && self.idle > 2 && draw.one_in(20) {
            self.send(draw, spoilt);
        }
        let Some((level, left)) = self.levels.front_mut() else {
            // A spike that is over in the middle of a start bit.
            let is_idle = state == State::Command && self.idle > 2;
            if is_idle && draw.one_in(60) {
                self.levels.push_back((true, 10));
                return false;
            }
            return true;
        };
        let level = *level;
        *left -= 1;
        if *left == 0 {
            self.levels.pop_front();
        }
        level
    }

    fn send(&mut self, draw: &mut Draw, spoilt: &mut Cover) {
        // All of them in turn; of four, one stops, one has a byte without a stop bit.
        let (turn, kind) = (self.sent / 4, self.sent % 4);
        self.sent += 1;
        let command = complete().nth((turn * 2 + kind / 3) % complete().count()).unwrap_or_default();
        let (code, words) = match kind {
            0 | 1 => (1, 2),
            _ if draw.one_in(10) => (draw.bits() & 0xff, command % 4),
            _ => (command / 4, command % 4),
        };
        let mut bytes = vec![code, words, draw.bits(), draw.bits(), draw.bits(), draw.bits()];
        if code == 1 || code == 3 {
            bytes.extend((0..4 * words).map(|_| draw.bits()));
        }
        self.command = Some(code * 4 + words);
        let whole = bytes.len() as u64;
        let before = (1 + turn as u64 % 9).min(whole - 1);
        let stop_bits = match kind {
            0 => {
                bytes.truncate(before as usize);
                spoilt.see(Spoilt::Stops.at(before));
                self.command = None;
                whole
            }
            1 => {
                spoilt.see(Spoilt::NoStopBit.at(before));
                self.command = None;
                before
            }
            _ => whole,
        };
        for (place, byte) in bytes.into_iter().enumerate() {
            self.byte(byte, place as u64 != stop_bits);
        }
    }

    fn byte(&mut self, byte: u64, has_stop_bit: bool) {
        let cycles = self.params.bit_cycles;
        let bits = (0..8).map(|bit| byte >> bit & 1 == 1);
        let all = [false].into_iter().chain(bits).chain([has_stop_bit]);
        self.levels.extend(all.map(|level| (level, cycles)));
        // What has no stop bit is followed by a pause, as a start bit comes with a fall.
        self.levels.extend((!has_stop_bit).then_some((true, cycles)));
    }
}
