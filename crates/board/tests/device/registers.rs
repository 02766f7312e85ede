//! The registers of the device in software.

use std::time::{Duration, Instant};

use tofsim::firmware::registers::map::{
    ARM, ARM_KEY, ARMED, CODE_DENSITY, CONTROL, DENSITY_CLEAR, DENSITY_HITS, DEPTH, DSP_EN,
    DSP_RST, ESTIMATE_CODE, ESTIMATE_STATUS, ESTIMATE_VALID, FRAME, FRAMES, FRAMES_PERMITTED,
    FREE_RUNNING, HISTOGRAM, HITS, HOLD, HOST_SILENT, HOST_TIMEOUT, IDENTITY, IDENTITY_VALUE,
    INTERLOCK_OPEN, INTERLOCKED, LASER_EN, LASER_FAULTS, LOCKED, MAP_VERSION, PARAMETERS_HASH,
    PINS_SELECTED, RING_ON, SCRATCH, SHOTS, SIGMA, STATUS, SYSTEM_HZ,
};

/// Commands in which a frame is taken.
const COMMANDS_OF_A_FRAME: u32 = 3;

/// Results of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeldFrame {
    pub depth: i64,
    pub sigma: u64,
    pub status: u32,
    pub valid: bool,
    pub code: u32,
    pub histogram: Vec<u32>,
}

/// State of the firmware, as far as a host sees it.
#[derive(Clone, Debug)]
pub struct Registers {
    pub identity: u32,
    pub map_version: u32,
    pub parameters_hash: u64,
    /// Silence after which the laser goes off.
    pub host_timeout: Duration,
    /// Results of the frames, one after the other, from the first one again.
    pub results: Vec<HeldFrame>,
    /// Hits that each `n` gets in a command while the ring runs.
    pub ring: Vec<u32>,
    pub interlock_open: bool,
    /// The switch selects the control pins.
    pub pins_selected: bool,
    /// No frame goes on.
    pub stalls: bool,
    /// Frames that end where one is permitted.
    pub frames_at_once: u32,
    pub control: u32,
    pub armed: bool,
    pub laser_faults: u32,
    /// Commands in which the laser was armed and enabled.
    pub lit: u32,
    pub scratch: u32,
    pub permitted: u32,
    pub hold: u32,
    pub frames: u32,
    pub frame: u32,
    pub held: HeldFrame,
    pub elapsed: u32,
    pub shots: u32,
    pub density: Vec<u32>,
    pub last_command: Instant,
}

impl Registers {
    /// At power-up, with a hash of parameters and results of frames.
    pub fn new(parameters_hash: u64, results: Vec<HeldFrame>) -> Self {
        Registers {
            identity: IDENTITY_VALUE,
            map_version: 1,
            parameters_hash,
            host_timeout: Duration::from_millis(500),
            results,
            ring: vec![0; 801],
            interlock_open: false,
            pins_selected: false,
            stalls: false,
            frames_at_once: 1,
            control: DSP_RST.with(0, 1),
            armed: false,
            laser_faults: 0,
            lit: 0,
            scratch: 0,
            permitted: 0,
            hold: 0,
            frames: 0,
            frame: 0,
            held: HeldFrame::default(),
            elapsed: 0,
            shots: 0,
            density: vec![0; 801],
            last_command: Instant::now(),
        }
    }

    /// Looks whether the host is still there.
    pub fn watch(&mut self) {
        if self.armed && self.last_command.elapsed() > self.host_timeout {
            (self.armed, self.laser_faults) = (false, HOST_SILENT.with(self.laser_faults, 1));
        }
        if self.armed && self.interlock_open {
            (self.armed, self.laser_faults) = (false, INTERLOCKED.with(self.laser_faults, 1));
        }
    }

    /// Goes on while a command comes.
    pub fn command(&mut self) {
        self.watch();
        self.last_command = Instant::now();
        self.lit += u32::from(self.armed && LASER_EN.of(self.control) == 1);
        let runs = DSP_RST.of(self.control) == 0;
        if runs && RING_ON.of(self.control) == 1 {
            self.density.iter_mut().zip(&self.ring).for_each(|(sum, hits)| *sum += hits);
        }
        let permitted = self.permitted > 0 || FREE_RUNNING.of(self.control) == 1;
        if !runs || !permitted || DSP_EN.of(self.control) == 0 || self.stalls {
            return;
        }
        self.elapsed += 1;
        self.shots += 100;
        if self.elapsed == COMMANDS_OF_A_FRAME {
            self.elapsed = 0;
            self.permitted = self.permitted.saturating_sub(1);
            for _ in 0..self.frames_at_once {
                self.end_frame();
            }
        }
    }

    fn end_frame(&mut self) {
        let result = self.results[self.frames as usize % self.results.len()].clone();
        self.frames += 1;
        if self.hold == 0 {
            (self.frame, self.held) = (self.frames, result);
        }
    }

    pub fn read(&self, address: u32) -> u32 {
        let [upper, lower] = [32, 0].map(|shift| move |value: u64| (value >> shift) as u32);
        let is = |register: tofsim::firmware::registers::map::Register, word: u32| {
            address == register.address + word
        };
        let found = |list: &[u32], first: u32| list.get((address - first) as usize).copied();
        match address {
            _ if address >= CODE_DENSITY.address => {
                found(&self.density, CODE_DENSITY.address).unwrap_or(0)
            }
            _ if address >= HISTOGRAM.address => {
                found(&self.held.histogram, HISTOGRAM.address).unwrap_or(0)
            }
            _ if is(IDENTITY, 0) => self.identity,
            _ if is(MAP_VERSION, 0) => self.map_version,
            _ if is(PARAMETERS_HASH, 0) => upper(self.parameters_hash),
            _ if is(PARAMETERS_HASH, 1) => lower(self.parameters_hash),
            _ if is(SYSTEM_HZ, 0) => 125_000_000,
            _ if is(HOST_TIMEOUT, 0) => (self.host_timeout.as_secs_f64() * 125e6) as u32,
            _ if is(SCRATCH, 0) => self.scratch,
            _ if is(CONTROL, 0) => self.control,
            _ if is(FRAMES_PERMITTED, 0) => self.permitted,
            _ if is(ARM, 0) => self.armed.into(),
            _ if is(STATUS, 0) => self.status(),
            _ if is(LASER_FAULTS, 0) => self.laser_faults,
            _ if is(FRAMES, 0) => self.frames,
            _ if is(SHOTS, 0) => self.shots,
            _ if is(HITS, 0) => self.held.histogram.iter().sum(),
            _ if is(HOLD, 0) => self.hold,
            _ if is(FRAME, 0) => self.frame,
            _ if is(DEPTH, 0) => upper(self.held.depth as u64),
            _ if is(DEPTH, 1) => lower(self.held.depth as u64),
            _ if is(SIGMA, 0) => upper(self.held.sigma),
            _ if is(SIGMA, 1) => lower(self.held.sigma),
            _ if is(ESTIMATE_STATUS, 0) => self.held.status,
            _ if is(ESTIMATE_VALID, 0) => self.held.valid.into(),
            _ if is(ESTIMATE_CODE, 0) => self.held.code,
            _ if is(DENSITY_HITS, 0) => self.density.iter().sum(),
            _ => 0,
        }
    }

    fn status(&self) -> u32 {
        let bits = [
            (LOCKED, true),
            (PINS_SELECTED, self.pins_selected),
            (ARMED, self.armed),
            (INTERLOCK_OPEN, self.interlock_open),
        ];
        bits.iter().fold(0, |word, (bit, is_set)| bit.with(word, (*is_set).into()))
    }

    pub fn write(&mut self, address: u32, word: u32) {
        match address {
            _ if address == SCRATCH.address => self.scratch = word,
            _ if address == CONTROL.address => self.control = word,
            _ if address == FRAMES_PERMITTED.address => self.permitted = word,
            _ if address == HOLD.address => self.hold = word & 1,
            _ if address == ARM.address => {
                self.armed = word == ARM_KEY;
                self.laser_faults *= u32::from(!self.armed);
                self.watch();
            }
            _ if address == DENSITY_CLEAR.address && word == 1 => self.density.fill(0),
            _ => {}
        }
    }
}
