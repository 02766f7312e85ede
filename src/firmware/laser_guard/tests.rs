use super::*;

const PARAMS: Params =
    Params { halves: 2, host_timeout: 100, longest_pulse: 3, shortest_period: 12 };

/// A guard with the laser's output behind it, two cycles of `clk_laser` to one of `clk_sys`.
struct Laser {
    guard: LaserGuard,
    i: In,
    /// Enables that pass, half cycle by half cycle.
    passed: Vec<bool>,
}

impl Laser {
    fn new() -> Self {
        let i = In { locked: true, ..In::default() };
        Laser { guard: LaserGuard::new(&PARAMS), i, passed: Vec::new() }
    }

    /// Armed by the host.
    fn armed() -> Self {
        let mut laser = Laser::new();
        laser.arm();
        assert!(laser.guard.registers.armed && !laser.guard.registers.laser_off);
        laser
    }

    fn arm(&mut self) {
        self.i.arm = true;
        self.cycle();
        self.i.arm = false;
        (0..6).for_each(|_| self.cycle());
    }

    fn cycle(&mut self) {
        self.pulses([0, 0]);
    }

    /// A cycle with these enables in its two cycles of `clk_laser`.
    fn pulses(&mut self, pulses: [u64; 2]) {
        self.guard.settle(&self.i);
        for (half, pulse) in pulses.into_iter().enumerate() {
            self.i.laser_pulse = U::new(pulse);
            let passes = pulse & !self.guard.registers_laser.laser_block.get();
            let is_off = self.guard.registers.laser_off;
            self.passed.extend([0, 1].map(|bit| passes >> bit & 1 == 1 && !is_off));
            match half {
                0 => self.guard.rise_laser(&self.i, &PARAMS),
                _ => self.guard.rise(&self.i, &PARAMS),
            }
        }
    }

    /// The enables as a line of text.
    fn shown(&self) -> String {
        self.passed.iter().map(|&high| if high { '#' } else { '.' }).collect()
    }
}

#[test]
fn nothing_passes_before_the_laser_is_armed() {
    let mut laser = Laser::new();
    (0..20).for_each(|_| laser.pulses([3, 1]));
    assert!(laser.guard.registers.laser_off && !laser.passed.contains(&true));
    let q = &laser.guard.registers;
    assert!(!q.pulse_too_long && !q.rate_too_high && q.unlocked);
}

#[test]
fn allowed_pulses_pass() {
    let mut laser = Laser::armed();
    laser.passed.clear();
    for _ in 0..3 {
        laser.pulses([3, 1]);
        (0..5).for_each(|_| laser.cycle());
    }
    assert_eq!(laser.shown(), format!("###{}", ".".repeat(21)).repeat(3));
    assert!(laser.guard.registers.armed);
}

#[test]
fn the_rest_of_a_pulse_that_is_too_long_is_not_emitted_and_the_laser_goes_off() {
    let mut laser = Laser::armed();
    laser.passed.clear();
    laser.pulses([3, 3]);
    (0..3).for_each(|_| laser.cycle());
    assert_eq!(laser.shown(), format!("###{}", ".".repeat(13)));
    let q = &laser.guard.registers;
    assert!(!q.armed && q.laser_off && q.pulse_too_long && !q.rate_too_high);
}

#[test]
fn a_pulse_that_comes_too_soon_is_not_emitted_and_the_laser_goes_off() {
    let mut laser = Laser::armed();
    laser.passed.clear();
    laser.pulses([1, 0]);
    (0..4).for_each(|_| laser.cycle());
    laser.pulses([0, 1]);
    (0..2).for_each(|_| laser.cycle());
    assert_eq!(laser.shown(), format!("#{}", ".".repeat(31)));
    let q = &laser.guard.registers;
    assert!(!q.armed && q.laser_off && q.rate_too_high && !q.pulse_too_long);
}

#[test]
fn a_silent_host_loses_the_laser_and_one_that_is_heard_keeps_it() {
    let mut laser = Laser::armed();
    for _ in 0..5 {
        (0..90).for_each(|_| laser.cycle());
        laser.i.heard = true;
        laser.cycle();
        laser.i.heard = false;
    }
    assert!(laser.guard.registers.armed);
    (0..102).for_each(|_| laser.cycle());
    let q = &laser.guard.registers;
    assert!(!q.armed && q.laser_off && q.host_silent);
}

#[test]
fn without_lock_or_interlock_the_laser_is_off_without_a_clock_and_stays_off() {
    let cuts: [fn(&mut In, bool); 2] = [|i, cut| i.locked = !cut, |i, cut| i.interlock = cut];
    for (place, cut) in cuts.into_iter().enumerate() {
        let mut laser = Laser::armed();
        cut(&mut laser.i, true);
        laser.guard.settle(&laser.i);
        assert!(laser.guard.registers.laser_off);
        cut(&mut laser.i, false);
        (0..10).for_each(|_| laser.cycle());
        let q = laser.guard.registers;
        assert!(q.laser_off && !q.armed);
        assert_eq!((q.unlocked, q.interlocked), (place == 0, place == 1));
        cut(&mut laser.i, true);
        laser.arm();
        assert!(!laser.guard.registers.armed, "while it lasts");
        cut(&mut laser.i, false);
        laser.arm();
        assert!(laser.guard.registers.armed && !laser.guard.registers.laser_off);
    }
}

#[test]
fn with_the_switch_at_the_pins_a_rise_of_laser_en_arms_and_its_fall_disarms() {
    let mut laser = Laser::new();
    (laser.i.select_pins, laser.i.laser_en, laser.i.rst) = (true, true, true);
    (0..10).for_each(|_| laser.cycle());
    laser.i.rst = false;
    (0..10).for_each(|_| laser.cycle());
    assert!(!laser.guard.registers.armed, "it has been high since the reset");
    for level in [false, true] {
        laser.i.laser_en = level;
        (0..10).for_each(|_| laser.cycle());
    }
    assert!(laser.guard.registers.armed);
    (0..200).for_each(|_| laser.cycle());
    assert!(laser.guard.registers.armed, "no host has to be heard");
    laser.i.laser_en = false;
    (0..5).for_each(|_| laser.cycle());
    assert!(!laser.guard.registers.armed && laser.guard.registers.laser_off);
}
