//! The protocol: bytes on the line, and recovery after faults.

use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::time::{Duration, Instant};

use tofsim_board::uartbone::{BRIDGE_TIMEOUT, BusError, UartBone};

const PATIENCE: Duration = Duration::from_millis(60);

/// A line that records what is sent; each element of `answers` is there after one command, byte by byte.
#[derive(Default)]
struct Line {
    sent: Vec<Vec<u8>>,
    at: Vec<Instant>,
    answers: VecDeque<Vec<u8>>,
    incoming: VecDeque<u8>,
    gone: bool,
}

/// A line with those answers.
fn answering(answers: &[&[u8]]) -> Line {
    Line { answers: answers.iter().map(|answer| answer.to_vec()).collect(), ..Line::default() }
}

impl Read for &mut Line {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        if self.gone {
            return Err(ErrorKind::BrokenPipe.into());
        }
        let Some(byte) = self.incoming.pop_front() else {
            std::thread::sleep(Duration::from_millis(2));
            return Err(ErrorKind::TimedOut.into());
        };
        bytes[0] = byte;
        Ok(1)
    }
}

impl Write for &mut Line {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.sent.push(bytes.to_vec());
        self.at.push(Instant::now());
        let answer = self.answers.pop_front().unwrap_or_default();
        self.incoming.extend(answer);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn commands_are_those_of_litex() {
    let mut line = answering(&[&[], &[], &[1, 2, 3, 4, 0xf5, 6, 7, 8], &[0, 0, 0, 9]]);
    let mut bus = UartBone::new(&mut line, PATIENCE);
    bus.write(0x1234, &[0xdead_beef]).unwrap();
    bus.write_fixed(8, &[1, 2]).unwrap();
    assert_eq!(bus.read(0x2000, 2).unwrap(), [0x0102_0304, 0xf506_0708]);
    assert_eq!(bus.read_fixed(7, 1).unwrap(), [9]);
    assert_eq!(bus.read(7, 0).unwrap(), [0; 0]);
    let expected: [&[u8]; 4] = [
        &[1, 1, 0, 0, 0x12, 0x34, 0xde, 0xad, 0xbe, 0xef],
        &[3, 2, 0, 0, 0, 8, 0, 0, 0, 1, 0, 0, 0, 2],
        &[2, 2, 0, 0, 0x20, 0],
        &[4, 1, 0, 0, 0, 7],
    ];
    assert_eq!(line.sent, expected);
}

#[test]
fn no_command_is_longer_than_255_words() {
    let mut line = answering(&[&[], &[], &[7; 4 * 255], &[8; 4]]);
    let mut bus = UartBone::new(&mut line, PATIENCE);
    bus.write(0x1000, &[5; 300]).unwrap();
    let words = bus.read(0x1000, 256).unwrap();
    assert_eq!((words.len(), words[254], words[255]), (256, 0x0707_0707, 0x0808_0808));
    let heads: Vec<_> = line.sent.iter().map(|bytes| bytes[..6].to_vec()).collect();
    let expected = [
        [1, 255, 0, 0, 0x10, 0],
        [1, 45, 0, 0, 0x10, 0xff],
        [2, 255, 0, 0, 0x10, 0],
        [2, 1, 0, 0, 0x10, 0xff],
    ];
    assert_eq!(heads, expected);
}

#[test]
fn a_read_is_repeated_once_after_the_bridge_has_given_up() {
    let mut line = answering(&[&[1, 2, 3], &[0, 0, 0, 7]]);
    assert_eq!(UartBone::new(&mut line, PATIENCE).read(4, 1).unwrap(), [7]);
    assert_eq!((line.sent.len(), &line.sent[0]), (2, &line.sent[1]));
    assert!(line.at[1] - line.at[0] > PATIENCE + BRIDGE_TIMEOUT);
}

#[test]
fn what_remains_short_is_an_error_with_its_length() {
    let mut line = answering(&[&[1, 2, 3], &[1, 2]]);
    let error = UartBone::new(&mut line, PATIENCE).read(4, 1).unwrap_err();
    assert!(matches!(error, BusError::Silent { received: 2, expected: 4 }), "{error:?}");
    assert_eq!(line.sent.len(), 2);
}

#[test]
fn a_lost_connection_is_not_tried_again() {
    let mut line = Line { gone: true, ..Line::default() };
    let error = UartBone::new(&mut line, PATIENCE).read(4, 1).unwrap_err();
    assert!(matches!(error, BusError::Lost(_)), "{error:?}");
    assert_eq!(line.sent.len(), 1);
}
