//! A device in software: UARTBone's bridge before registers that act as the firmware's do, with faults to order.

#[path = "device/registers.rs"]
mod registers;

use std::io::{ErrorKind, Read, Write};
use std::os::unix::net::UnixStream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{JoinHandle, spawn};
use std::time::{Duration, Instant};

use serialport::{SerialPort, TTYPort};

pub use registers::{HeldFrame, Registers};

/// Silence after which the bridge waits for a new command.
const BRIDGE_TIMEOUT: Duration = Duration::from_millis(100);

/// What is wrong with the device.
#[derive(Clone, Copy, Debug, Default)]
pub struct Faults {
    /// It answers nothing.
    pub silent: bool,
    /// Answers of which the last byte is missing, from now on.
    pub truncated: u32,
    /// Bytes before the next answer that nobody asked for.
    pub noise: usize,
    /// Commands after which the cable is pulled out.
    pub unplugged_after: Option<u32>,
}

/// Registers and faults.
pub struct State {
    pub registers: Registers,
    pub faults: Faults,
    /// Commands so far.
    pub commands: u32,
}

/// A running device.
pub struct Device {
    /// Name of its port.
    pub port: String,
    state: Arc<Mutex<State>>,
    quit: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Device {
    /// A device on a pseudo-terminal.
    pub fn on_terminal(registers: Registers, faults: Faults) -> Device {
        let (master, slave) = TTYPort::pair().unwrap();
        // Programs that a test begins do not inherit the clones, so that the cable can be pulled out.
        let [mut master, slave] = [master, slave].map(|end| end.try_clone_native().unwrap());
        master.set_timeout(Duration::from_millis(5)).unwrap();
        let port = slave.name().unwrap();
        // The other end stays open between two clients, and closes with the device.
        Device::run(port, registers, faults, Ends { ours: master, _other: slave })
    }

    /// A device on a socket, and the client's end of that.
    pub fn on_socket(registers: Registers, faults: Faults) -> (Device, UnixStream) {
        let (ours, theirs) = UnixStream::pair().unwrap();
        ours.set_read_timeout(Some(Duration::from_millis(5))).unwrap();
        theirs.set_read_timeout(Some(Duration::from_millis(20))).unwrap();
        (Device::run("socket".to_owned(), registers, faults, ours), theirs)
    }

    fn run(
        port: String,
        registers: Registers,
        faults: Faults,
        link: impl Read + Write + Send + 'static,
    ) -> Device {
        let state = Arc::new(Mutex::new(State { registers, faults, commands: 0 }));
        let quit = Arc::new(AtomicBool::new(false));
        let (own, stop) = (Arc::clone(&state), Arc::clone(&quit));
        let thread = Some(spawn(move || serve(link, &own, &stop)));
        Device { port, state, quit, thread }
    }

    /// Registers and faults, to be looked at or changed.
    pub fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        self.quit.store(true, Ordering::Relaxed);
        let ended = self.thread.take().map(JoinHandle::join);
        assert!(ended.is_none_or(|ended| ended.is_ok()), "the device has panicked");
    }
}

/// Both ends of a pseudo-terminal.
struct Ends {
    ours: TTYPort,
    _other: TTYPort,
}

impl Read for Ends {
    fn read(&mut self, bytes: &mut [u8]) -> std::io::Result<usize> {
        self.ours.read(bytes)
    }
}

impl Write for Ends {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.ours.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

fn serve(mut link: impl Read + Write, state: &Mutex<State>, quit: &AtomicBool) {
    let (mut command, mut last) = (Vec::new(), Instant::now());
    while !quit.load(Ordering::Relaxed) {
        let mut byte = [0];
        match link.read(&mut byte) {
            Ok(1) => {}
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock) => {
                let mut state = state.lock().unwrap();
                state.registers.watch();
                continue;
            }
            _ => return,
        }
        if last.elapsed() > BRIDGE_TIMEOUT {
            command.clear();
        }
        last = Instant::now();
        command.push(byte[0]);
        let Some(whole) = whole(&command) else { continue };
        let Some(answer) = answer(&mut state.lock().unwrap(), whole) else { return };
        command.clear();
        if link.write_all(&answer).is_err() {
            return;
        }
    }
}

/// Command, number of words and address of a whole command, and its data.
fn whole(bytes: &[u8]) -> Option<(u8, usize, u32, &[u8])> {
    let (head, data) = bytes.split_at_checked(6)?;
    let words = usize::from(head[1]);
    let is_write = matches!(head[0], 1 | 3);
    let address = u32::from_be_bytes(head[2..].try_into().unwrap());
    (!is_write || data.len() == 4 * words).then_some((head[0], words, address, data))
}

/// Does a command; `None` if the cable is out.
fn answer(
    state: &mut State,
    (command, words, first, data): (u8, usize, u32, &[u8]),
) -> Option<Vec<u8>> {
    state.commands += 1;
    if state.faults.unplugged_after.is_some_and(|most| state.commands > most) {
        return None;
    }
    state.registers.command();
    let address = |place: usize| first + if command < 3 { place as u32 } else { 0 };
    let mut answer = Vec::new();
    match command {
        1 | 3 => {
            for (place, word) in data.chunks(4).enumerate() {
                let word = u32::from_be_bytes(word.try_into().unwrap());
                state.registers.write(address(place), word);
            }
        }
        2 | 4 => {
            for place in 0..words {
                answer.extend(state.registers.read(address(place)).to_be_bytes());
            }
        }
        _ => {}
    }
    let faults = &mut state.faults;
    if faults.silent {
        answer.clear();
    }
    if !answer.is_empty() && faults.truncated > 0 {
        faults.truncated -= 1;
        answer.pop();
    }
    if !answer.is_empty() && faults.noise > 0 {
        answer.splice(0..0, vec![0xa5; std::mem::take(&mut faults.noise)]);
    }
    Some(answer)
}
