//! Opening of a serial port.

use std::ops::RangeInclusive;
use std::time::Duration;

use serialport::{ErrorKind, SerialPort};

use tofsim::error::{Input, Result};

/// Rate of the firmware's bridge unless its parameter `Baud` says otherwise [baud].
pub const BAUD: u32 = 921_600;
/// Rates that a port may have [baud].
pub const BAUDS: RangeInclusive<u32> = 300..=20_000_000;
/// Longest waits for an answer that may be asked for [s].
pub const TIMEOUTS_S: RangeInclusive<f64> = 0.01..=86_400.0;
/// Longest wait for an answer, unless the board is simulated.
pub const PATIENCE: Duration = Duration::from_secs(1);
/// Time-out of a single read of the port.
const READ_TIMEOUT: Duration = Duration::from_millis(20);

/// A serial port, and how to speak over it.
#[derive(Clone, Debug, PartialEq)]
pub struct PortOptions {
    /// Its name, e.g. `/dev/ttyUSB0`.
    pub port: String,
    /// Its rate [baud].
    pub baud: u32,
    /// Longest wait for an answer.
    pub patience: Duration,
}

impl PortOptions {
    /// A port of that name with the firmware's usual rate.
    pub fn new(port: impl Into<String>) -> Self {
        PortOptions { port: port.into(), baud: BAUD, patience: PATIENCE }
    }

    /// Opens the port: 8 data bits, no parity, one stop bit, no flow control.
    pub(crate) fn open(&self) -> Result<Box<dyn SerialPort>> {
        let opened = serialport::new(&self.port, self.baud).timeout(READ_TIMEOUT).open();
        opened.map_err(|error| {
            let others = match others(&self.port) {
                Some(ports) if error.kind() != ErrorKind::InvalidInput => {
                    format!("; ports of this machine: {ports}")
                }
                _ => String::new(),
            };
            let cause = error.description.trim_end_matches('.');
            let expected =
                format!("cannot open it: {cause}; expected the board's serial port{others}");
            Input::new(&self.port, expected).into()
        })
    }
}

/// Returns the names of the machine's other serial ports.
fn others(own: &str) -> Option<String> {
    let ports = serialport::available_ports().ok()?;
    let names: Vec<_> =
        ports.into_iter().map(|port| port.port_name).filter(|name| name != own).collect();
    (!names.is_empty()).then(|| names.join(", "))
}
