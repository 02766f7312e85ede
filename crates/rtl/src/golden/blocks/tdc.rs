//! Shots at all rates and closer, with photons as in both modes and in bursts: exactly on edges and
//! on the boundaries of taps, before the shot and after its window, held over into the next; and a
//! sweep through every number of taps that a hit can have.

use tofsim::firmware::tdc::In;
use tofsim::firmware::tdc_decoder::{Age, Decoder};

use crate::golden::prelude::*;

mod light;

use light::{Ages, Light};

/// Cycles in which every hit counts, and after which they come again.
const FREE: (usize, usize) = (60, 500);
/// Last cycle after a start in which there is a reset.
const LAST_RESET: usize = 15;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[
        Latency { from: "tdc_stop", to: "tdc_valid", cycles: |vectors| u64::from(vectors.sizes.count_stages) + 4 },
        Latency { from: "tdc_stop", to: "tdc_code", cycles: |vectors| u64::from(vectors.sizes.count_stages) + 4 },
    ],
    configurations: &[COUNT_STAGES_2, LEADING, REORDERED, CALIBRATED],
    model: Some(Model::new::<In>(|at| {
        let i = In { tdc_stop: at.top.pins.tdc_stop, ..at.input() };
        let taps = at.taps();
        at.top.tdc.rise(&i, &at.params.tdc, taps);
    })),
    ..Spec::new("tdc", "tdc", record)
};

signals! {
    /// Input ports; `tdc_stop` is no part of a line.
    struct Stimulus {
        /// Synchronous reset.
        rst: bool,
        /// A shot begins.
        start: bool,
        /// Every hit counts.
        #[only_if(Calibrated)]
        free: bool,
        /// Age for the last hit's `n` [units].
        #[only_if(Calibrated)]
        #[size(AgeBits)]
        calibrated_age: Age,
    }
}

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let params = &setting.setup.params.tdc;
    let mut light = Light::new(&params.delays, &params.decoder.encoder, setting.setup.cycle());
    let code_of = |ages: &Ages| {
        Some(params.decoder.code_of_rank(light.coarse(ages.first), ages.taps as usize)?.get())
    };
    let number = |ages: &Ages| params.decoder.encoder.of_rank(ages.taps as usize) as u64;
    let mut hits = Cover::new("taps of a hit", light.ages.iter().map(number));
    // Some code of an uneven chain has a single, narrow number; `tdc_decoder` reaches those of other decoders.
    let counts_ones = params.decoder.encoder.decoder() == Decoder::Ones;
    let all_codes = light.ages.iter().filter(|_| counts_ones);
    let mut codes = Cover::new("codes", all_codes.filter_map(code_of));
    let window = params.coarse_counter.window();
    let mut coarses = Cover::new("coarse of a hit", 0..window.min(8));
    let mut rises = Cover::new("edges from the one of start to the one that sees a rise", 0..10);
    let mut resets = Cover::new("reset in cycle after start", 0..=LAST_RESET as u64);
    let mut corners = Cover::new(
        "level held over, second hit, hit kept with start, last edge, equal codes",
        // Few shots are as long as a long window.
        (0..5).filter(|corner| *corner != 3 || window <= 16),
    );
    // So that ages that are calibrated are none of the ROM.
    let rom = params.clone().with_calibration(params.decoder.beside_calibration().cal);
    let (calibrates, mut last_age) = (params.decoder.calibrated.is_some(), U::new(0));
    let (tap_0, mut last_code) = (params.delays.tap_0_position(), None);
    let mut run = Recorder::new(spec, setting, Stimulus::list());
    // Cycle of the last start and of the next; cycle after a start in which the next reset comes.
    let (mut started, mut next, mut reset) = (0, 3, LAST_RESET);
    for cycle in 0..setting.cycles_of_chain() {
        let draw = &mut run.draw;
        let start = cycle == next;
        let since = if start { 0 } else { cycle - started };
        let rst = cycle == FIRST_RESET || since == reset && draw.one_in(6);
        let tdc = &run.top.tdc;
        let (open, coarse) = (tdc.coarse_counter.window, tdc.coarse_counter.coarse);
        let (used, before) = tdc.tdc_latch.before();
        let high = tdc.carry_chain.taps.tap(tap_0);
        let rise = high && !before && !rst;
        rises.see_if(rise && cycle > started, (cycle - started).saturating_sub(1) as u64);
        resets.see_if(rst, since as u64);
        corners.see_if(start && high && before, 0);
        corners.see_if(rise && open && used, 1);
        corners.see_if(rise && open && !used && start, 2);
        corners.see_if(rise && open && coarse == window - 1, 3);
        if tdc.tdc_decoder.tdc_valid {
            let code = tdc.tdc_decoder.tdc_code.get();
            codes.see(code);
            corners.see_if(last_code == Some(code), 4);
            last_code = Some(code);
        }
        if let Some((taps, coarse)) = tdc.tdc_decoder.counted().filter(|_| !rst) {
            hits.see(taps);
            coarses.see(coarse);
            light.counted(taps);
        }
        if rst {
            reset = (reset + 1) % (LAST_RESET + 1);
        }
        if start {
            let period = match draw.below(8) {
                0 => 6,
                1 => 8,
                2 => 13,
                3 => 25,
                4 => 1 + draw.below(3),
                5 => 9 + draw.below(6),
                _ => 3 + draw.below(3),
            };
            (started, next) = (cycle, cycle + period as usize);
            let [begin, end] = [started, next].map(|line| light.stops.edge(line - 1));
            light.shoot(begin, end, draw);
        }
        let free = calibrates && cycle % FREE.1 < FREE.0;
        let calibrated_age = last_age;
        if let Some((n, _)) = run.top.tdc.tdc_decoder.counted() {
            last_age = params.decoder.cal[n as usize];
        }
        run.line(&Stimulus { rst, start, free, calibrated_age });
        let (now, stops) = (light.stops.edge(cycle), &mut light.stops);
        stops.advance(now);
        let i = In { rst, start, tdc_stop: stops.level(), free, calibrated_age };
        run.top.tdc.rise(&i, &rom, stops.sample(now, &rom.delays));
    }
    let memories = [parameters::tap_delays(&params.delays), mem::tdc_decoder(&rom.decoder)];
    let own = files(["DelaysFile", "CalFile"], memories);
    let stops = light.stops.times().to_vec();
    let coverage = [hits, codes, coarses, rises, resets, corners];
    Ok(Vectors { stops, ..run.vectors(coverage).with(own) })
}
