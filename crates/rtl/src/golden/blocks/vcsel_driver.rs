//! Every change of rate at every phase, acquisition and laser switched on and off, both resets, each in
//! the last cycles before a laser edge too, and that of the laser from the middle of a cycle on.

use tofsim::firmware::vcsel_driver::{In, Params, Rate};

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    timing: timing::BOTH,
    reset: Some("rst"),
    fast: &["laser_on", "fire_last", "pulse_0", "pulse_1", "laser_pulse", "stretch", "ddr_output.q", "ddr_output.second"],
    latency: &[Latency { from: "acquire", to: "start", cycles: |_| 5 }],
    configurations: &[Configuration { parameters: &["PulseHalfCycles"], ..LONG_PULSE }, HOSTED],
    model: Some(Model {
        settle: |at| {
            let i = at.input();
            at.top.vcsel_driver.settle(&i);
        },
        ..Model::new::<In>(|at| {
            let (i, driver) = (at.input(), &mut at.top.vcsel_driver);
            match at.edge {
                Edge::Rise => driver.rise(&i, &at.params.vcsel_driver),
                Edge::Middle => driver.rise_laser(&i, &at.params.vcsel_driver),
                Edge::Fall => driver.fall_laser(),
            }
        })
    }),
    ..Spec::new("vcsel_driver", "vcsel_driver", record)
};

signals! {
    /// The input ports; the reset of the laser may be another from the middle of the cycle on.
    struct Stimulus {
        /// Reset of `clk_sys`.
        rst: bool,
        /// Reset of `clk_laser`, until the middle of the cycle.
        rst_laser: bool,
        /// Reset of `clk_laser`, from then on.
        rst_laser_late: bool,
        /// Lets the counter run.
        acquire: bool,
        /// Lets the laser fire.
        laser_en: bool,
        /// Repetition rate.
        #[size(RateBits)]
        laser_freq: Rate,
        /// The output is low.
        #[only_if(Hosted)]
        laser_off: bool,
        /// Enables that do not pass.
        #[only_if(Hosted)]
        #[size(Halves)]
        laser_block: U<2>,
    }
}

/// Longer periods are left to the whole, if there are others [cycles].
const LONG: u64 = 1000;
/// Mean spacing of random events [cycles]; in longer periods they come mostly near the ends.
const USUAL: u64 = 25;

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let p = &setting.setup.params.vcsel_driver;
    let codes = 1 << setting.setup.params.sizes().of(Size::RateBits);
    let usable = usable(p, codes);
    let longest = usable.iter().map(|&code| p.period(Rate::new(code))).max().unwrap_or_default();
    let mut phases = Cover::new(
        "laser_freq changes, rate x 2^16 + count",
        rates(p, &usable).flat_map(|(rate, period)| ends_of(period).map(move |n| (rate << 16) + n)),
    );
    let mut changes = Cover::new(
        "laser_freq from x codes + to, taken at a wrap",
        rates(p, &usable).flat_map(|(from, _)| usable.iter().map(move |to| from * codes + to)),
    );
    // Cycles to the laser edge x 8, and what comes.
    let mut endings = Cover::new(
        "cycles to the laser edge x 8 + rst, rst_laser, acquire low as bits, one of them",
        (0..4).flat_map(|left| [1, 2, 4].map(|what| left * 8 + what)),
    );
    let mut resets = Cover::new("rst_laser in the first half of a cycle x 2 + in the second", 0..4);
    let is_hosted = setting.setup.params.is_hosted;
    let mut run = Recorder::new(spec, setting, Stimulus::list());
    let laser_freq = Rate::new(usable[usable.len() - 1]);
    let mut i = In { rst: true, rst_laser: true, acquire: true, laser_en: true, laser_freq, ..In::default() };
    let lines = Setting::CYCLES.max((800 * longest).min(10 * USUAL * LONG) as usize);
    for cycle in 0..setting.cycles.unwrap_or(lines) {
        let place = run.top.vcsel_driver.registers.place(p);
        let rare = place.map_or(1, |(rate, count, _)| rareness(p.periods[rate as usize], count));
        let before = i.laser_freq;
        if run.draw.one_in(12 * rare) {
            let any = run.draw.bits() % codes;
            i.laser_freq = Rate::new(if usable.contains(&any) { any } else { usable[0] });
        }
        i.laser_en ^= run.draw.one_in(40);
        i.acquire = if i.acquire { !run.draw.one_in(100 * rare) } else { run.draw.one_in(5) };
        (i.rst, i.rst_laser) = (run.draw.one_in(200 * rare), run.draw.one_in(200));
        if cycle == FIRST_RESET {
            (i.rst, i.rst_laser) = (true, true);
        }
        let late = i.rst_laser ^ run.draw.one_in(if is_hosted { 30 } else { 100 });
        resets.see(bits([i.rst_laser, late]));
        if let Some((rate, count, wraps)) = place {
            changes.see_if(wraps && i.acquire, rate * codes + i.laser_freq.get());
            phases.see_if(before != i.laser_freq, (rate << 16) + count);
            let left = p.periods[rate as usize] - 1 - count;
            endings.see(left * 8 + bits([i.rst, i.rst_laser, !i.acquire]));
        }
        if is_hosted {
            i.laser_off ^= run.draw.one_in(if i.laser_off { 8 } else { 60 });
            i.laser_block = U::new(if run.draw.one_in(3) { run.draw.bits() } else { 0 });
        }
        run.top.vcsel_driver.settle(&i);
        let In { rst, rst_laser, acquire, laser_en, laser_freq, laser_off, laser_block } = i;
        run.line(&Stimulus {
            rst, rst_laser, rst_laser_late: late, acquire, laser_en, laser_freq, laser_off, laser_block,
        });
        run.top.vcsel_driver.fall_laser();
        run.sample();
        if cycle > 0 {
            run.top.vcsel_driver.rise_laser(&i, p);
        }
        run.sample();
        run.top.vcsel_driver.fall_laser();
        run.sample();
        run.top.vcsel_driver.rise(&In { rst_laser: late, ..i }, p);
    }
    Ok(run.vectors([changes, phases, endings, resets]))
}

/// Codes whose periods are short enough to go through again and again.
fn usable(p: &Params, codes: u64) -> Vec<u64> {
    let shortest = p.periods.iter().copied().min().unwrap_or_default();
    (0..codes).filter(|&code| p.period(Rate::new(code)) <= shortest.max(LONG)).collect()
}

/// Returns the rates of those codes, each with its period.
fn rates<'a>(p: &'a Params, usable: &'a [u64]) -> impl Iterator<Item = (u64, u64)> + Clone + 'a {
    let periods = p.periods.iter().zip(0..);
    // Of equal periods the first is used.
    let is_first = move |&(period, rate): &(&u64, usize)| !p.periods[..rate].contains(period);
    let rates = periods.filter(is_first).map(|(&period, rate)| (rate as u64, period));
    rates.filter(move |(rate, _)| usable.contains(rate))
}

/// Places in a period: all, or those near the ends of a long one.
fn ends_of(period: u64) -> impl Iterator<Item = u64> + Clone {
    (0..period).filter(move |&n| period <= 2 * USUAL || n < 8 || period - n <= 8)
}

/// Returns by how much rarer than usual random events are there.
fn rareness(period: u64, count: u64) -> u64 {
    let near = count < 8 || period - count <= 8;
    if near || period <= 2 * USUAL { 1 } else { period / USUAL }
}
