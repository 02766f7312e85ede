//! The word that the host reads.

use crate::kernel::U;
use crate::kernel::signals::Word;

use super::{In, Params, RegisterFile, Registers, map};

impl RegisterFile {
    /// Reads the word at the address, whether anybody wants it or not: reading has no side effects.
    pub(super) fn read(&self, d: &mut Registers, i: &In, p: &Params) {
        let q = &self.registers;
        let address = i.address.get() as u32;
        let is_known = address >> map::ADDRESS_BITS == 0;
        let within = |memory: map::Memory, words: usize| {
            let place = address.wrapping_sub(memory.address) as usize;
            (is_known && place < words).then_some(place)
        };
        let (bin, n) = (within(map::HISTOGRAM, p.bins), within(map::CODE_DENSITY, p.taps + 1));
        d.in_histogram = bin.is_some();
        d.in_density = n.is_some();
        let front = usize::from(!q.bank) * p.bins + address as usize % p.bins;
        d.histogram_word = self.histogram_ram[front];
        if let Some(n) = n {
            d.density_word = self.density_ram[n];
        }
        d.register_word = U::new(if is_known { q.word(address, i, p).into() } else { 0 });
        d.read_data = match () {
            () if q.in_histogram => U::new(q.histogram_word.get()),
            () if q.in_density => q.density_word,
            () => q.register_word,
        };
    }
}

impl Registers {
    /// The word at an address, 0 where there is no register.
    fn word(&self, address: u32, i: &In, p: &Params) -> u32 {
        let q = self;
        let own = |register: &&map::Register| {
            (register.address..register.address + register.words).contains(&address)
        };
        let Some(register) = map::ALL.iter().find(own) else { return 0 };
        let value = match *register {
            map::IDENTITY => map::IDENTITY_VALUE.into(),
            map::MAP_VERSION => map::MAP_VERSION_VALUE.into(),
            map::PARAMETERS_HASH => p.parameters_hash,
            map::SYSTEM_HZ => p.system_hz.into(),
            map::HOST_TIMEOUT => p.host_timeout.into(),
            map::SCRATCH => q.scratch.get(),
            map::CONTROL => self.control_word().into(),
            map::FRAMES_PERMITTED => q.frames_permitted.get(),
            map::ARM => i.armed.into(),
            map::STATUS => self.status_word(i).into(),
            map::LASER_FAULTS => fault_word(i).into(),
            map::FRAMES => q.frames.get(),
            map::SHOTS => q.shots.get(),
            map::HITS => q.hits.get(),
            map::HOLD => q.hold.into(),
            map::FRAME => q.frame.get(),
            map::DEPTH => q.frame_depth.get() as u64,
            map::SIGMA => q.frame_sigma.get(),
            map::ESTIMATE_STATUS => q.frame_status.get(),
            map::ESTIMATE_VALID => q.frame_valid.into(),
            map::ESTIMATE_CODE => q.frame_code.bits(),
            map::DENSITY_CLEAR => q.clearing.into(),
            map::DENSITY_HITS => q.density_hits.get(),
            _ => 0,
        };
        let lower = register.address + register.words - 1 - address;
        (value >> (32 * lower)) as u32
    }

    fn control_word(&self) -> u32 {
        let q = self;
        word([
            (map::LASER_EN, q.host_laser_en.into()),
            (map::DSP_EN, q.dsp_en_asked.into()),
            (map::DSP_RST, q.host_dsp_rst.into()),
            (map::MODE, q.host_mode.into()),
            (map::LASER_FREQ, q.host_laser_freq.get() as u32),
            (map::RING_ON, q.host_ring_on.into()),
            (map::FREE_RUNNING, q.free_running.into()),
        ])
    }

    fn status_word(&self, i: &In) -> u32 {
        word([
            (map::LOCKED, 1),
            (map::CALIBRATED, self.calibrated.into()),
            (map::ACQUIRING, i.acquire.into()),
            (map::PINS_SELECTED, i.pins_selected.into()),
            (map::ARMED, i.armed.into()),
            (map::INTERLOCK_OPEN, i.interlock_sync.into()),
        ])
    }
}

fn fault_word(i: &In) -> u32 {
    word([
        (map::HOST_SILENT, i.host_silent.into()),
        (map::UNLOCKED, i.unlocked.into()),
        (map::INTERLOCKED, i.interlocked.into()),
        (map::PULSE_TOO_LONG, i.pulse_too_long.into()),
        (map::RATE_TOO_HIGH, i.rate_too_high.into()),
    ])
}

/// A word of fields.
fn word<const FIELDS: usize>(fields: [(map::RegisterBit, u32); FIELDS]) -> u32 {
    fields.into_iter().fold(0, |word, (bit, value)| bit.with(word, value))
}
