//! Shots at all rates and closer, with photons as in both modes and in bursts: exactly on edges and
//! on the boundaries of taps, before the shot and after its window, held over into the next; and a
//! sweep through every number of taps that a hit can have.

use crate::firmware::tdc::{In, Params};
use crate::firmware::tdc_decoder::code;
use crate::firmware::tof_top::TofTop;
use crate::golden::block::{Block, Latency, Parameter, Setting, Spec};
use crate::golden::cover::Cover;
use crate::golden::draw::Draw;
use crate::golden::record::record;
use crate::golden::roms;
use crate::golden::stops;
use crate::golden::timing::CLK_125;
use crate::kernel::Time;
use crate::network::mem::{self, Mem};
use crate::signals;

mod light;

use light::{Ages, Light};

pub(super) const SPEC: Spec = Spec {
    name: "tdc",
    scope: "tdc",
    timing: CLK_125,
    reset: Some("rst"),
    fast: &[],
    latency: &[
        Latency { from: "tdc_stop", to: "tdc_valid", cycles: 3 },
        Latency { from: "tdc_stop", to: "tdc_code", cycles: 3 },
    ],
    glue: None,
    record: |spec, setting| record(spec, setting, Tdc::new(setting)),
};

signals! {
    /// Input ports; `tdc_stop` is no part of a line.
    pub(super) struct Stimulus {
        /// Synchronous reset.
        rst: bool,
        /// A shot begins.
        start: bool,
    }
}

struct Tdc {
    params: Params,
    light: Light,
    /// Cycle of the last start, and of the next.
    started: usize,
    next: usize,
    /// Cycle after a start in which the next reset comes.
    reset: usize,
    last_code: Option<u64>,
    taps: Cover,
    codes: Cover,
    coarse: Cover,
    rises: Cover,
    resets: Cover,
    corners: Cover,
}

impl Tdc {
    fn new(setting: &Setting) -> Self {
        let params = setting.setup.params.tdc.clone();
        let light = Light::new(&params.delays);
        let code_of = |ages: &Ages| {
            Some(code(light::coarse(ages.first), ages.taps as usize, &params.cal)?.get())
        };
        Tdc {
            started: 0,
            next: 3,
            reset: 0,
            last_code: None,
            taps: Cover::new("taps of a hit", light.ages.iter().map(|ages| ages.taps)),
            codes: Cover::new("codes", light.ages.iter().filter_map(code_of)),
            coarse: Cover::new("coarse of a hit", 0..8),
            rises: Cover::new("edges from the one of start to the one that sees a rise", 0..10),
            resets: Cover::new("reset in cycle after start", 0..12),
            corners: Cover::new(
                "level held over, second hit, hit kept with start, last edge, equal codes",
                0..5,
            ),
            light,
            params,
        }
    }

    /// What has come to pass.
    fn see(&mut self, cycle: usize, start: bool, rst: bool, top: &TofTop) {
        let (latch, decoder) = (&top.tdc.tdc_latch, &top.tdc.tdc_decoder);
        let (window, coarse) = (top.tdc.coarse_counter.window, top.tdc.coarse_counter.coarse);
        let high = top.tdc.carry_chain.taps.tap(self.params.delays.tap_0_position());
        let (used, before) = latch.before();
        let rise = high && !before && !rst;
        self.rises.see_if(rise, cycle.saturating_sub(self.started + 1) as u64);
        self.corners.see_if(start && high && before, 0);
        self.corners.see_if(rise && window && used, 1);
        self.corners.see_if(rise && window && !used && start, 2);
        self.corners.see_if(rise && window && coarse == 7, 3);
        if let Some((taps, coarse)) = decoder.decoding().filter(|_| !rst) {
            self.taps.see(taps);
            self.coarse.see(coarse);
            self.light.counted(taps);
        }
        if decoder.tdc_valid {
            let code = decoder.tdc_code.get();
            self.codes.see(code);
            self.corners.see_if(self.last_code == Some(code), 4);
            self.last_code = Some(code);
        }
    }
}

impl Block for Tdc {
    type Stimulus = Stimulus;

    fn stimulus(&mut self, cycle: usize, top: &TofTop, draw: &mut Draw) -> Stimulus {
        let start = cycle == self.next;
        let since = if start { 0 } else { cycle - self.started };
        let rst = since == self.reset && draw.one_in(6);
        self.see(cycle, start, rst, top);
        if rst {
            self.resets.see(self.reset as u64);
            self.reset = (self.reset + 1) % 12;
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
            (self.started, self.next) = (cycle, cycle + period as usize);
            let edge = |cycle: usize| Time::from_ns(8 * cycle as u64);
            self.light.shoot(edge(self.started), edge(self.next), draw);
        }
        Stimulus { rst, start }
    }

    fn edge(&mut self, _: &Stimulus, _: &mut TofTop) {}

    fn cycle(
        &mut self,
        cycle: usize,
        i: &Stimulus,
        top: &mut TofTop,
        look: &mut dyn FnMut(&TofTop),
    ) {
        look(top);
        let (now, stops) = (stops::edge(cycle), &mut self.light.stops);
        stops.advance(now);
        let i = In { rst: i.rst, start: i.start, tdc_stop: stops.line.level() };
        top.tdc.rise(&i, &self.params, &mut stops.line, now);
    }

    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        let file = Parameter::File;
        vec![("DelaysFile", file("tap_delays.mem")), ("CalFile", file("tdc_cal.mem"))]
    }

    fn roms(&self) -> Vec<Mem> {
        vec![roms::tap_delays(&self.params.delays), mem::tdc_decoder(&self.params.cal)]
    }

    fn stops(&self) -> &[Time] {
        self.light.stops.times()
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.taps, self.codes, self.coarse, self.rises, self.resets, self.corners]
    }
}
