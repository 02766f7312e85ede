use super::*;

const PARAMS: Params = Params { bit_cycles: 8, timeout_cycles: 400 };

/// A bridge with a memory behind it that answers with the address's complement.
#[derive(Default)]
struct Line {
    bridge: UartBridge,
    written: Vec<(u64, u64)>,
    heard: usize,
    /// Levels of `uart_tx`.
    sent: Vec<bool>,
}

impl Line {
    fn level(&mut self, uart_rx: bool, cycles: u64) {
        for _ in 0..cycles {
            let read_data = U::new(!self.bridge.address.get());
            self.bridge = self.bridge.next(&In { rst: false, uart_rx, read_data }, &PARAMS);
            let q = &self.bridge;
            self.written.extend(q.write_en.then_some((q.address.get(), q.write_data.get())));
            self.heard += usize::from(q.heard);
            self.sent.push(q.uart_tx);
        }
    }

    fn byte(&mut self, byte: u8, stop: bool) {
        self.level(false, 8);
        (0..8).for_each(|bit| self.level(byte >> bit & 1 == 1, 8));
        self.level(stop, 8);
        self.level(true, 2);
    }

    fn bytes(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.byte(byte, true));
    }

    /// The bytes that have been sent.
    fn received(&self) -> Vec<u8> {
        let (mut bytes, mut at) = (Vec::new(), 0);
        while let Some(start) = self.sent[at..].iter().position(|level| !level) {
            let bit = |bit: usize| self.sent[at + start + 12 + 8 * bit];
            bytes.push((0..8).map(|k| u8::from(bit(k)) << k).sum());
            assert!(bit(8), "a stop bit");
            at += start + 80;
        }
        bytes
    }
}

#[test]
fn words_are_written_at_increasing_addresses_or_at_one() {
    let mut line = Line::default();
    line.bytes(&[1, 2, 0, 0, 0x10, 0x01, 0xde, 0xad, 0xbe, 0xef, 1, 2, 3, 4]);
    line.bytes(&[3, 2, 0, 0, 0, 7, 0, 0, 0, 1, 0, 0, 0, 2]);
    assert_eq!(line.written, [(0x1001, 0xdead_beef), (0x1002, 0x0102_0304), (7, 1), (7, 2)]);
    assert_eq!(line.heard, 2);
}

#[test]
fn words_are_read_with_the_most_significant_byte_first() {
    let mut line = Line::default();
    line.bytes(&[2, 2, 0, 0, 0, 0xff]);
    line.level(true, 1000);
    assert_eq!(line.received(), [0xff, 0xff, 0xff, 0x00, 0xff, 0xff, 0xfe, 0xff]);
    line.bytes(&[4, 1, 0x12, 0x34, 0x56, 0x78]);
    line.level(true, 500);
    assert_eq!(line.received()[8..], [0xed, 0xcb, 0xa9, 0x87]);
    assert_eq!(line.heard, 2);
}

#[test]
fn a_command_that_stops_is_forgotten_after_the_time_out() {
    for sent in 1..10 {
        let mut line = Line::default();
        line.bytes(&[1, 1, 0, 0, 0, 5, 1, 2, 3, 4][..sent]);
        line.level(true, 410);
        line.bytes(&[1, 1, 0, 0, 0, 6, 0, 0, 0, 9]);
        assert_eq!(line.written, [(6, 9)], "{sent}");
    }
}

#[test]
fn a_byte_without_a_stop_bit_spoils_what_comes_until_the_line_is_silent() {
    let mut line = Line::default();
    line.bytes(&[1, 1, 0, 0]);
    line.byte(0, false);
    line.bytes(&[5, 1, 2, 3, 4, 1, 1, 0, 0, 0, 7, 0, 0, 0, 1]);
    assert_eq!((line.written.len(), line.heard), (0, 0));
    line.level(true, 410);
    line.bytes(&[1, 1, 0, 0, 0, 6, 0, 0, 0, 9]);
    assert_eq!((line.written.len(), line.heard), (1, 1));
}

#[test]
fn nothing_is_done_for_no_words_or_an_unknown_command() {
    let mut line = Line::default();
    for command in [0, 5, 255] {
        line.bytes(&[command, 3, 0, 0, 0, 1]);
    }
    assert_eq!(line.heard, 0);
    line.bytes(&[1, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 1]);
    line.level(true, 500);
    assert_eq!((line.heard, line.written.len(), line.received().len()), (2, 0, 0));
}

#[test]
fn the_baud_rate_of_the_board_is_a_quarter_percent_off() {
    let params = Params::new(125_000_000, 921_600);
    assert_eq!(params, Params { bit_cycles: 136, timeout_cycles: 12_500_000 });
    let error: f64 = 125e6 / 136.0 / 921_600.0 - 1.0;
    assert!((error + 0.002_693_5).abs() < 1e-6, "{error}");
}
