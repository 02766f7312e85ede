//! A host that reads and writes every register and words of both memories, whole histograms, frames that end with and
//! without hold, hits of every `n`, and resets; addresses that nothing has, too.

use tofsim::firmware::registers::{In, Params, RegisterFile, map};

use crate::golden::prelude::*;

/// Lines, unless the setting has a number of its own.
const CYCLES: usize = 40_000;
/// Cycles from a hit to the next, at least.
const APART: u64 = 2;
/// Places in the order of the map: words of registers, then the memories and their ends.
const STRANGE: [u32; 6] = [0x7, 0x3f, 0x0fff, 0x3fff, 0x4000, 0x8000_0008];

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[
        Latency { from: "address", to: "read_data", cycles: |_| 1 },
        Latency { from: "write_en", to: "arm", cycles: |_| 0 },
        Latency { from: "frame_done", to: "host_dsp_en", cycles: |_| 1 },
    ],
    ..Spec::new("registers", "registers", record)
};

/// Parameters beside the sizes of the design.
fn params(all: &tofsim::firmware::tof_top::Params) -> Params {
    Params {
        // VHDL has no larger number.
        parameters_hash: 0x7654_3210,
        system_hz: 125_000_000,
        host_timeout: 62_500_000,
        bins: all.histogram.bins,
        taps: all.tdc.delays.taps(),
    }
}

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut setting = setting.clone();
    setting.setup.params.is_hosted = true;
    let p = params(&setting.setup.params);
    let (bins, taps) = (p.bins as u64, p.taps as u64);
    let sizes = setting.setup.params.sizes();
    let (rates, counts) = (1 << sizes.of(Size::RateBits), 1 << sizes.of(Size::CountBits));
    let words = |r: &map::Register| r.address..r.address + r.words;
    let all: Vec<_> = map::ALL.iter().flat_map(words).chain(STRANGE).collect();
    let mut reads = Cover::new("addresses that are read", all.iter().map(|&at| at.into()));
    let mut writes = Cover::new("addresses that are written", all.iter().map(|&at| at.into()));
    let mut held = Cover::new("frame_done x 2 + hold", 0..4);
    let mut permitted = Cover::new("frames permitted at frame_done, up to 2", 0..3);
    let mut counted = Cover::new("n of a hit and address of its count, in 16ths", 0..32);
    let mut cleared = Cover::new("counts were cleared", 0..=1);
    let mut run = Recorder::new(spec, &setting, In::list());
    run.top.registers = RegisterFile::new(&p);
    let mut i = In::default();
    let (mut since, mut bin, mut kept) = (APART, 0, 0);
    for cycle in 0..setting.cycles.unwrap_or(CYCLES) {
        let draw = &mut run.draw;
        i.rst = cycle == FIRST_RESET || draw.one_in(4000);
        // An address stays for a few cycles, as it does with the bridge.
        i.write_en = false;
        if kept == 0 {
            let place = match draw.below(8) {
                0 | 1 => u64::from(map::HISTOGRAM.address) + draw.below(bins),
                2 | 3 => u64::from(map::CODE_DENSITY.address) + draw.below(taps + 2),
                _ => all[draw.below(all.len() as u64) as usize].into(),
            };
            (i.address, kept) = (U::new(place), 1 + draw.below(4));
            i.write_en = draw.one_in(2);
            i.write_data = U::new(written(draw, place, rates));
            writes.see_if(i.write_en, place);
            let n = place.wrapping_sub(map::CODE_DENSITY.address.into());
            counted.see_if(n <= taps, 16 + n.min(taps) * 15 / taps);
        } else {
            kept -= 1;
            reads.see_if(kept == 0, i.address.get());
        }
        for level in [&mut i.pins_selected, &mut i.armed, &mut i.interlock_sync, &mut i.host_silent] {
            *level ^= draw.one_in(50);
        }
        for level in [&mut i.unlocked, &mut i.interlocked, &mut i.pulse_too_long, &mut i.rate_too_high] {
            *level ^= draw.one_in(50);
        }
        (i.start, i.tdc_valid) = (draw.one_in(6), draw.one_in(8));
        i.calibrating ^= draw.one_in(if i.calibrating { 40 } else { 400 });
        i.acquire ^= draw.one_in(60);
        i.n_valid = since >= APART && draw.one_in(3);
        i.n = U::new(draw.below(taps + 1));
        since = if i.n_valid { 1 } else { since + 1 };
        counted.see_if(i.n_valid, i.n.get() * 15 / taps);
        i.frame_done = draw.one_in(150);
        i.hist_valid = !i.frame_done && draw.one_in(2);
        (i.hist_bin, i.hist_count) = (U::new(bin % bins), U::new(draw.below(counts)));
        bin += u64::from(i.hist_valid);
        if i.frame_done || draw.one_in(100) {
            (i.depth, i.sigma) = (S::new(draw.bits() as i64), U::new(draw.bits()));
            (i.status, i.valid) = (U::new(draw.bits()), draw.one_in(2));
        }
        let q = &run.top.registers;
        held.see(bits([i.frame_done, q.is_held()]));
        permitted.see_if(i.frame_done, q.frames_permitted().min(2));
        cleared.see(q.is_clearing().into());
        run.line(&i);
        run.top.registers.tick(&i, &p);
    }
    let vectors = run.vectors([reads, writes, held, permitted, counted, cleared]);
    Ok(vectors.with(vec![
        ("ParametersHash", Parameter::Number(p.parameters_hash)),
        ("SystemHz", Parameter::Number(p.system_hz.into())),
        ("HostTimeout", Parameter::Number(p.host_timeout.into())),
    ]))
}

/// A word for a register: now and then one that arms, seldom one that clears, few frames.
fn written(draw: &mut Draw, place: u64, rates: u64) -> u64 {
    let is = |register: map::Register| place == u64::from(register.address);
    if is(map::ARM) && draw.one_in(2) {
        map::ARM_KEY.into()
    } else if is(map::FRAMES_PERMITTED) {
        draw.below(4)
    } else if is(map::DENSITY_CLEAR) {
        u64::from(draw.one_in(8))
    } else if is(map::CONTROL) {
        // A rate of the design.
        let word = draw.bits() as u32;
        map::LASER_FREQ.with(word, map::LASER_FREQ.of(word) % rates as u32).into()
    } else {
        draw.bits()
    }
}
