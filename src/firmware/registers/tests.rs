use super::*;
use crate::firmware::forward2::Depth;

const PARAMS: Params = Params {
    parameters_hash: 0x0123_4567_89ab_cdef,
    system_hz: 125_000_000,
    host_timeout: 62_500_000,
    bins: 256,
    taps: 800,
};

/// The registers with a host.
struct Host(RegisterFile);

impl Host {
    fn new() -> Self {
        Host(RegisterFile::new(&PARAMS))
    }

    fn cycle(&mut self, i: In) -> &Registers {
        self.0.tick(&i, &PARAMS);
        &self.0.registers
    }

    fn write(&mut self, register: map::Register, value: u32) {
        let address = U::new(register.address.into());
        let write_data = U::new(value.into());
        self.cycle(In { address, write_en: true, write_data, ..In::default() });
    }

    fn word(&mut self, address: u32) -> u32 {
        let i = In { address: U::new(address.into()), ..In::default() };
        self.cycle(i);
        self.cycle(i).read_data.get() as u32
    }

    fn read(&mut self, register: map::Register) -> u64 {
        let words = register.address..register.address + register.words;
        words.fold(0, |value, address| value << 32 | u64::from(self.word(address)))
    }

    /// A frame with these counts in its first bins.
    fn frame(&mut self, counts: &[u64], depth: i64) {
        for (bin, &count) in counts.iter().enumerate() {
            let hist_bin = U::new(bin as u64);
            self.cycle(In {
                hist_valid: true,
                hist_bin,
                hist_count: U::new(count),
                ..In::default()
            });
        }
        self.cycle(In { frame_done: true, depth: Depth::new(depth), ..In::default() });
    }
}

#[test]
fn the_host_is_told_what_it_talks_to() {
    let mut host = Host::new();
    assert_eq!(host.read(map::IDENTITY), u64::from_be_bytes(*b"\0\0\0\0tofs"));
    assert_eq!(host.read(map::PARAMETERS_HASH), PARAMETERS);
    assert_eq!(host.read(map::CONTROL), 1 << map::DSP_RST.bit);
    host.write(map::SCRATCH, 0xdead_beef);
    assert_eq!(host.read(map::SCRATCH), 0xdead_beef);
    assert_eq!((host.word(0x7), host.word(0x4006), host.word(0x8000_0000)), (0, 0, 0));
}

const PARAMETERS: u64 = PARAMS.parameters_hash;

#[test]
fn a_frame_that_is_held_stays_while_others_end() {
    let mut host = Host::new();
    host.frame(&[1, 2], -3);
    assert_eq!((host.word(0x1000), host.word(0x1001)), (1, 2));
    assert_eq!(host.read(map::DEPTH) as i64, -3);
    host.write(map::HOLD, 1);
    host.frame(&[4, 5], 6);
    host.frame(&[7, 8], 9);
    assert_eq!((host.word(0x1000), host.read(map::FRAME)), (1, 1));
    host.write(map::HOLD, 0);
    assert_eq!((host.word(0x1000), host.read(map::FRAME)), (1, 1));
    host.frame(&[10, 11], 12);
    assert_eq!((host.word(0x1001), host.read(map::FRAME), host.read(map::DEPTH)), (11, 4, 12));
}

#[test]
fn as_many_frames_are_estimated_as_are_permitted() {
    let mut host = Host::new();
    host.write(map::CONTROL, 1 << map::DSP_EN.bit);
    host.write(map::FRAMES_PERMITTED, 2);
    for left in [2, 1] {
        host.cycle(In::default());
        assert!(host.0.registers.host_dsp_en, "{left}");
        assert_eq!(host.read(map::FRAMES_PERMITTED), left);
        host.frame(&[], 0);
    }
    assert!(!host.cycle(In::default()).host_dsp_en);
    host.write(map::CONTROL, 1 << map::DSP_EN.bit | 1 << map::FREE_RUNNING.bit);
    assert!(host.cycle(In::default()).host_dsp_en);
}

#[test]
fn hits_of_each_n_are_counted_and_cleared() {
    let mut host = Host::new();
    for n in [5, 5, 800, 0, 5] {
        host.cycle(In { n_valid: true, n: U::new(n), ..In::default() });
        host.cycle(In::default());
    }
    host.cycle(In::default());
    assert_eq!([0x2000, 0x2005, 0x2320, 0x2321].map(|at| host.word(at)), [1, 3, 1, 0]);
    assert_eq!(host.read(map::DENSITY_HITS), 5);
    host.write(map::DENSITY_CLEAR, 1);
    assert_eq!(host.read(map::DENSITY_CLEAR), 1);
    (0..801).for_each(|_| _ = host.cycle(In::default()));
    assert_eq!(host.read(map::DENSITY_CLEAR), 0);
    assert_eq!((host.word(0x2005), host.read(map::DENSITY_HITS)), (0, 0));
}

#[test]
fn only_the_key_arms() {
    let mut host = Host::new();
    for (word, arm, disarm) in [(map::ARM_KEY, true, false), (1, false, true), (0, false, true)] {
        host.write(map::ARM, word);
        assert_eq!((host.0.registers.arm, host.0.registers.disarm), (arm, disarm), "{word:#x}");
        host.cycle(In::default());
        assert!(!host.0.registers.arm && !host.0.registers.disarm);
    }
}
