//! Pulses of a driver that keeps the rules, and of one that does not; a host that arms, disarms and falls silent; the
//! PLL, the interlock and the switch at any time.

use tofsim::firmware::laser_guard::{In, LaserGuard, Params};

use crate::golden::prelude::*;

/// Silence that trips, few cycles [cycles of clk_sys].
const HOST_TIMEOUT: u32 = 60;
/// Shortest period [cycles of clk_laser].
const SHORTEST_PERIOD: u64 = 12;

pub(super) const SPEC: Spec = Spec {
    timing: timing::BOTH_WITH_PULSE,
    fast: &[
        "laser_off", "laser_block", "unlocked", "interlocked", "armed_last", "checks", "run", "gap", "gap_lasts", "too_long", "too_soon",
    ],
    configurations: &[Configuration { parameters: &["Halves"], ..LONG_PULSE }],
    ..Spec::new("laser_guard", "laser_guard", record)
};

fn params(pulse_half_cycles: u64) -> Params {
    Params {
        halves: pulse_half_cycles.min(2) as u32,
        host_timeout: HOST_TIMEOUT,
        longest_pulse: pulse_half_cycles,
        shortest_period: SHORTEST_PERIOD,
    }
}

signals! {
    /// The input ports; `laser_pulse` may be another from the middle of the cycle on.
    struct Stimulus {
        /// Reset of `clk_sys`.
        rst: bool,
        /// Reset of `clk_laser`.
        rst_laser: bool,
        /// The PLL has locked.
        locked: bool,
        /// The interlock is open.
        interlock: bool,
        /// The switch selects the control pins.
        select_pins: bool,
        /// `laser_en` of the pins.
        laser_en: bool,
        /// A command of the host is complete.
        heard: bool,
        /// Arms the laser.
        arm: bool,
        /// Disarms it.
        disarm: bool,
        /// Enables of the output register, until the middle of the cycle.
        #[size(Halves)]
        laser_pulse: U<2>,
        /// Enables of the output register, from then on.
        #[size(Halves)]
        laser_pulse_late: U<2>,
    }
}

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut setting = setting.clone();
    setting.setup.params.is_hosted = true;
    let p = params(setting.setup.params.vcsel_driver.pulse_half_cycles.into());
    // Half cycles that follow each other are pulses that come too soon.
    let possible = (0..5).filter(|fault| *fault != 3 || p.halves > 1);
    let mut faults = Cover::new("faults that come while armed", possible);
    let mut arming = Cover::new("arming: by the host, by the pins, while it is cut", 0..3);
    let usual = p.shortest_period..p.shortest_period + 4;
    let mut passed = Cover::new(
        "cycles of clk_laser from a pulse to the next, while armed",
        usual.chain([p.longest_pulse.div_ceil(2)]),
    );
    let mut resets = Cover::new("rst while armed, rst_laser while armed", 0..2);
    let mut run = Recorder::new(spec, &setting, Stimulus::list());
    run.top.laser_guard = LaserGuard::new(&p);
    let mut i = In { locked: true, ..In::default() };
    let mut driver = Driver { until: 0, left: 0, since: 0 };
    for cycle in 0..setting.cycles() {
        let (draw, before) = (&mut run.draw, run.top.laser_guard.registers);
        i.rst = draw.one_in(700);
        i.rst_laser = draw.one_in(700);
        i.locked = if i.locked { !draw.one_in(900) } else { draw.one_in(4) };
        i.interlock = if i.interlock { draw.one_in(2) } else { draw.one_in(900) };
        i.select_pins ^= draw.one_in(1500);
        i.laser_en ^= draw.one_in(if i.laser_en { 300 } else { 20 });
        i.heard = draw.one_in(if cycle / 2000 % 2 == 0 { 15 } else { 30 });
        i.arm = draw.one_in(match () {
            () if !i.locked || i.interlock => 3,
            () if before.armed => 500,
            () => 20,
        });
        i.disarm = draw.one_in(800);
        resets.see_if(before.armed && i.rst, 0);
        resets.see_if(before.armed && i.rst_laser, 1);
        arming.see_if(i.arm && !i.select_pins, if !i.locked || i.interlock { 2 } else { 0 });
        arming.see_if(i.select_pins && i.laser_en, 1);
        let guard = &mut run.top.laser_guard;
        guard.settle(&i);
        let pulses = [(); 2].map(|()| driver.pulse(&mut run.draw, &p, &mut passed, guard.registers.armed));
        i.laser_pulse = pulses[0];
        let In { rst, rst_laser, locked, interlock, select_pins, laser_en, heard, arm, disarm, .. } = i;
        let [laser_pulse, laser_pulse_late] = pulses;
        run.line(&Stimulus {
            rst, rst_laser, locked, interlock, select_pins, laser_en, heard, arm, disarm, laser_pulse, laser_pulse_late,
        });
        run.sample();
        if cycle > 0 {
            run.top.laser_guard.rise_laser(&i, &p);
        }
        run.sample();
        run.sample();
        i.laser_pulse = laser_pulse_late;
        run.top.laser_guard.rise(&i, &p);
        let now = run.top.laser_guard.registers;
        let [then, now] = [before, now].map(|q| {
            [q.host_silent, q.unlocked, q.interlocked, q.pulse_too_long, q.rate_too_high]
        });
        for (fault, (then, now)) in then.into_iter().zip(now).enumerate() {
            faults.see_if(before.armed && !then && now, fault as u64);
        }
    }
    let vectors = run.vectors([faults, arming, passed, resets]);
    Ok(vectors.with(vec![
        ("HostTimeout", Parameter::Number(HOST_TIMEOUT.into())),
        ("LongestPulse", Parameter::Number(p.longest_pulse)),
        ("ShortestPeriod", Parameter::Number(p.shortest_period)),
    ]))
}

/// A laser driver that mostly keeps the rules.
struct Driver {
    /// Cycles of clk_laser until the next pulse.
    until: u64,
    /// Half cycles that are left of the pulse.
    left: u64,
    /// Cycles of clk_laser since the last one began.
    since: u64,
}

impl Driver {
    /// The enables of a cycle of clk_laser.
    fn pulse(&mut self, draw: &mut Draw, p: &Params, passed: &mut Cover, armed: bool) -> U<2> {
        self.since += 1;
        if self.left == 0 && self.until == 0 {
            passed.see_if(armed, self.since);
            self.left = p.longest_pulse + if draw.one_in(60) { 1 + draw.below(3) } else { 0 };
            self.until = if draw.one_in(60) { draw.below(11) } else { p.shortest_period - 1 + draw.below(4) };
            self.since = 0;
        } else {
            self.until = self.until.saturating_sub(1);
        }
        let halves = self.left.min(p.halves.into());
        self.left -= halves;
        U::new((1 << halves) - 1)
    }
}
