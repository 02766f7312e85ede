//! Every number that the decoder can make of a hit, of ones in one run or several, at every coarse count; with
//! the scenario's calibration but for the last words, which give times exactly at both ends of the range.

use tofsim::firmware::carry_chain::Taps;
use tofsim::firmware::tdc_decoder::{Decoder, In, Params};

use crate::golden::prelude::*;

/// Coarse counts that are swept with all ones counts.
const SWEPT: u64 = 3;
/// Coarse counts at which a word of the ROM makes each end of the range.
const AT_ENDS: usize = 3;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[
        Latency { from: "hit", to: "tdc_valid", cycles: |vectors| u64::from(vectors.sizes.count_stages) + 2 },
        Latency { from: "hit_taps", to: "tdc_code", cycles: |vectors| u64::from(vectors.sizes.count_stages) + 2 },
    ],
    configurations: &[COUNT_STAGES_2, LEADING, REORDERED, CALIBRATED],
    model: Some(Model::new::<In>(|at| {
        at.top.tdc.tdc_decoder.tick(&at.input(), &at.params.tdc.decoder);
    })),
    ..Spec::new("tdc_decoder", "tdc.tdc_decoder", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let (mut params, taps) = (setting.setup.params.tdc.decoder.clone(), setting.places());
    let count = params.taps();
    let window = setting.setup.params.tdc.coarse_counter.window();
    let coarse_used = SWEPT.min(window);
    // Coarse and ones count for a time at an end of the range.
    let mut edges = Vec::new();
    let ages = ages_at_ends(&params, window);
    let ages = ages.into_iter().filter(|_| !setting.constants.has("CalFile"));
    let encoder = params.encoder.clone();
    let of_rank = |rank: usize| encoder.of_rank(rank);
    // The last number of taps with each number of the decoder's.
    let mut last_ranks: Vec<_> = (0..=taps).rev().collect();
    last_ranks.dedup_by_key(|rank| of_rank(*rank));
    for (&rank, (coarse, age)) in last_ranks.iter().zip(ages) {
        params.cal[of_rank(rank)] = U::new(age);
        edges.push((coarse, rank));
    }
    let all = (0..=taps).flat_map(|rank| (0..coarse_used).map(move |coarse| (coarse, rank)));
    let reachable = all.filter_map(|(coarse, rank)| Some(params.code_of_rank(coarse, rank)?.get()));
    // Of an uneven chain some code has a single number at a single coarse count, which few lines reach.
    let counts_ones = encoder.decoder() == Decoder::Ones;
    let reachable = reachable.filter(|_| counts_ones);
    let mut codes = Cover::new("codes", reachable);
    let mut ones = Cover::new("numbers of taps", (0..=taps).map(|rank| of_rank(rank) as u64));
    let mut coarses = Cover::new("coarse", ends(window));
    let mut times = Cover::new("times at both ends of the range", 0..edges.len() as u64);
    let mut situations = Cover::new("rst, hit, hit before as bits", 0..8);
    // So that ages that are calibrated are none of the ROM.
    let rom = params.beside_calibration();
    let mut run = Recorder::new(spec, setting, In::list());
    let (mut hits_swept, mut last_age) = (0, U::new(0));
    // Whether the line before had a hit, and the hits counted one and two lines ago.
    let (mut hit_before, mut counted) = (false, [None; 2]);
    for cycle in 0..setting.cycles_of_chain() {
        let (decoder, draw) = (run.top.tdc.tdc_decoder, &mut run.draw);
        let (rst, hit) = (cycle > 0 && draw.one_in(40), draw.one_in(2));
        let rst = rst || cycle == FIRST_RESET;
        let (round, n) = (hits_swept / (taps + 1), hits_swept % (taps + 1));
        let special = if edges.is_empty() { 1 + draw.below(7) } else { draw.below(8) };
        let (coarse, n) = match special {
            0 => edges[draw.below(edges.len() as u64) as usize],
            1 if window > 16 => (draw.near_ends(window), n),
            1 => (draw.below(window), n),
            _ => (round as u64 % coarse_used, n),
        };
        hits_swept += usize::from(hit && !rst && special > 1);

        situations.see(bits([rst, hit, hit_before]));
        hit_before = hit && !rst;
        codes.see_if(decoder.tdc_valid, decoder.tdc_code.get());
        if let Some((n, coarse)) = counted[1].filter(|_| !rst) {
            ones.see(n);
            coarses.see(coarse);
            let edges = edges.iter().zip(0..).filter(|((at, rank), _)| {
                (*at, of_rank(*rank) as u64) == (coarse, n)
            });
            edges.for_each(|(_, case)| times.see(case));
        }
        counted = if rst { [None; 2] } else { [decoder.counted(), counted[0]] };
        // Other decoders see what most hits are: a single transition.
        let hit_taps = if counts_ones || special > 0 && draw.one_in(4) {
            with_ones(n, (taps, count), draw)
        } else {
            Taps::clipped(count, true, [n])
        };
        // Of the RAM as of the ROM: a cycle after `n`.
        let calibrated_age = last_age;
        last_age = decoder.counted().map_or(last_age, |(n, _)| params.cal[n as usize]);
        let i = In { rst, hit, hit_coarse: U::new(coarse), hit_taps, calibrated_age };
        run.line(&i);
        run.top.tdc.tdc_decoder = decoder.next(&i, &rom);
    }
    let memory = files(["CalFile"], [mem::tdc_decoder(&rom)]);
    Ok(run.vectors([ones, coarses, codes, times, situations]).with(memory))
}

/// Coarse counts, each with an age that makes the last time before the range, its first, its last, or the
/// first after it.
fn ages_at_ends(p: &Params, window: u64) -> Vec<(u64, u64)> {
    let (cycle, range) = (p.scale.cycle() as i64, p.scale.range() as i64);
    let mut ages: Vec<_> = [-1, 0, range - 1, range].into_iter()
        .flat_map(|end| {
            let age = move |coarse: u64| (coarse, cycle * (coarse as i64 + 1) - end);
            let fits = |(_, age): &(u64, i64)| (0..1 << p.age_bits()).contains(age);
            (0..window).map(age).filter(fits).take(AT_ENDS)
        })
        .map(|(coarse, age)| (coarse, age as u64))
        .collect();
    ages.sort_by_key(|(coarse, _)| *coarse);
    ages
}

/// Draws `n` ones among the first `taps` of a chain of `count`, in one run or two, with the gaps anywhere.
fn with_ones(n: usize, (taps, count): (usize, usize), draw: &mut Draw) -> Taps {
    let zeros = taps - n;
    let mut below = |n: usize| draw.below(n as u64 + 1) as usize;
    let (begin, first) = (below(zeros), below(n));
    let gap = below(zeros - begin);
    let second = begin + first + gap;
    match below(2) {
        0 => Taps::clipped(count, true, [n]),
        1 => Taps::clipped(count, false, [begin, begin + n]),
        _ => Taps::clipped(count, false, [begin, begin + first, second, second + n - first]),
    }
}
