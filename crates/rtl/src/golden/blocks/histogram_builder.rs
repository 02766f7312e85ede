//! Clear, hits and readout as in a frame, each overlapped by the others; all three at once at equal
//! and different addresses; and then hits of one word until it wraps. After a hit there is none for two
//! lines, and its code holds: that is what the TDC promises.

use tofsim::firmware::histogram_builder::{Bin, In, Place};

use crate::golden::prelude::*;

/// Lines before one word is hit until it wraps, and how many a bin at least.
const MIXED: usize = 40_000;
const MIXED_A_BIN: usize = 156;
/// Bits of the widest word that is hit until it wraps: wider ones are not in the time.
const WRAPS: u32 = 16;
/// Hits in which a word of that width wraps, with those that are kept from it.
const HITS: usize = 68_500;
/// Hits of that word before it is cleared.
const MANY: u64 = 600;
/// Lines of a hit: the one of `tdc_valid` and two more.
const HIT: usize = 3;
/// Longest way from hit to hit that is a goal of its own.
const APART: usize = 8;

pub(super) const SPEC: Spec = Spec {
    latency: &[
        Latency { from: "clear", to: "count", cycles: |_| 0 },
        Latency { from: "tdc_valid", to: "count", cycles: |_| 2 },
    ],
    configurations: &[SECOND],
    model: Some(Model {
        settle: |at| at.top.nets.count = at.top.histogram_builder.count(&at.input()),
        ..Model::new::<In>(|at| at.top.histogram_builder.tick(&at.input(), &at.params.histogram))
    }),
    ..Spec::new("histogram_builder", "histogram_builder", record)
};

/// The second bank of the third column of an array.
const SECOND: Configuration = Configuration {
    name: "second_bank",
    parameters: &["Columns", "Banks", "Column", "Bank"],
    ..ARRAY
};

/// Returns which of the three addresses are equal: none, two of them, all.
fn equal(i: &In) -> u64 {
    let [clear, hit, read] = [i.clear_addr, i.tdc_code, i.read_addr];
    match (clear == hit, hit == read, read == clear) {
        (true, true, _) => 4,
        (true, false, _) => 1,
        (false, true, _) => 2,
        (false, false, true) => 3,
        (false, false, false) => 0,
    }
}

/// Lists what can meet in each line of a hit: as bits, `clear` and `read_en`. Where reads have to keep away,
/// `clear` meets a hit only in its first line: others may have counted it by the second.
fn phases(reads_apart: bool) -> Vec<u64> {
    if reads_apart { vec![0, 2, 4, 8] } else { (0..4 * HIT as u64).collect() }
}

/// Clears, hits and reads at random, while the banks change their roles and columns are read in turn.
fn in_array(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let (size, bins) = (setting.histogram(), setting.bins);
    let place = Place { scan: setting.setup.params.frame_ctrl.scan, column: 2, bank: true };
    let mut shown = Cover::new("own bank filled, own column read, read_en as bits, word is not 0", 0..16);
    let mut taken = Cover::new("own bank filled, clear, tdc_valid as bits", 0..8);
    let mut run = Recorder::new(spec, setting, In::list());
    let (mut since, mut i) = (HIT, In::default());
    // Every word is cleared first, as its bank is filled.
    let cleared = bins as usize;
    for cycle in 0..setting.cycles() + cleared {
        let draw = &mut run.draw;
        let is_clearing = cycle < cleared;
        let hit = since + 1 >= HIT && draw.one_in(3) && !is_clearing;
        since = if hit { 0 } else { since + 1 };
        let any = |draw: &mut Draw| U::new(draw.below(bins.min(16)));
        i = In {
            clear: is_clearing || draw.one_in(8),
            clear_addr: if is_clearing { U::new(cycle as u64) } else { any(draw) },
            bank: is_clearing || i.bank ^ (since >= HIT && draw.one_in(16)),
            depth_column: U::new(draw.below(place.scan.columns.into())),
            tdc_valid: hit,
            tdc_code: if hit { any(draw) } else { i.tdc_code },
            read_en: draw.one_in(2),
            read_addr: any(draw),
        };
        let histogram = &mut run.top.histogram_builder;
        let own = i.at(&place);
        let (fills, is_own) = (i.bank == place.bank, i.depth_column == place.column);
        let word = histogram.ram[i.read_addr.index()] != 0;
        shown.see(bits([fills, is_own, i.read_en, word]));
        taken.see_if(!is_clearing, bits([fills, i.clear, i.tdc_valid]));
        run.top.nets.count = histogram.count(&own);
        run.line(&i);
        run.top.histogram_builder.tick(&own, &size);
    }
    let own = vec![("Column", Parameter::Number(place.column)), ("Bank", Parameter::Number(1))];
    Ok(Vectors { settles: cleared, ..run.vectors([shown, taken]).with(own) })
}

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    if !setting.setup.params.frame_ctrl.scan.is_single() {
        return in_array(spec, setting);
    }
    let size = setting.histogram();
    let (bins, words) = (setting.bins, 0..setting.bins);
    let mixed = MIXED.max(MIXED_A_BIN * bins as usize);
    let cycles = setting.cycles.unwrap_or(mixed + HIT * HITS);
    let (most, many) = (size.most_hits(), MANY.min(size.most_hits() / 2));
    let mut cleared = Cover::new("words cleared that were not 0", words.clone());
    let mut hits = Cover::new("words hit", words.clone());
    let mut seen = Cover::new("words shown that are not 0", words);
    let mut overlaps = Cover::new(
        "clear, tdc_valid, read_en as bits x 5 + equal addresses",
        (0..40).filter(|case| !setting.reads_apart || ![3, 5, 7].contains(&(case / 5))),
    );
    let mut phases = Cover::new("line of a hit x 4 + clear, read_en as bits", phases(setting.reads_apart));
    let mut spans = Cover::new(
        "lines from hit to hit x 2 + to the same word",
        2 * HIT as u64..=2 * APART as u64 + 1,
    );
    // Apart from its hits, that word is looked at only now and then.
    let (apart, close) = if setting.reads_apart { (true, 512) } else { (false, 64) };
    let widest = u64::from(size.count_bits.min(WRAPS + 1));
    let wrapped = u64::from(size.count_bits) + 1;
    let wraps = (size.count_bits <= WRAPS).then_some(wrapped);
    let mut sizes = Cover::new("bits of a count shown, or one more than it has: wrapped", (1..=widest).chain(wraps));
    let mut run = Recorder::new(spec, setting, In::list());
    // The word that counts on, and whether it has been seen close to its highest count.
    let (hot, mut full) = (setting.seed % bins, false);
    // Lines since the last hit, and its code; the next code of a sweep.
    let (mut since, mut last, mut swept) = (APART, U::new(0), 0);
    for cycle in 0..cycles {
        let (histogram, draw) = (&mut run.top.histogram_builder, &mut run.draw);
        let (round, word) = (cycle as u64 / bins, cycle as u64 % bins);
        let near = draw.below(bins);
        let any = |draw: &mut Draw| U::new(if draw.one_in(2) { near } else { draw.below(bins) });
        let mut i = In {
            clear_addr: any(draw),
            tdc_code: if draw.one_in(3) { last } else { any(draw) },
            read_addr: any(draw),
            clear: draw.one_in(2),
            tdc_valid: draw.one_in(3),
            read_en: draw.one_in(2),
            ..In::default()
        };
        let count = |address: Bin| histogram.ram[address.index()].get();
        // A count of each length, but not before every word has been cleared.
        let at_its_end = round > 0 && (count(U::new(hot)) + 1).is_power_of_two();
        let looks = apart && at_its_end && draw.one_in(2);
        let hammers = cycle >= mixed && !draw.one_in(64) && !looks;
        match round % 10 {
            _ if hammers => (i.clear, i.tdc_valid, i.tdc_code) = (false, true, U::new(hot)),
            _ if looks || apart && cycle >= mixed => {
                (i.clear, i.tdc_valid) = (false, false);
                (i.read_en, i.read_addr) = (true, U::new(hot));
            }
            0 => (i.clear, i.clear_addr) = (true, U::new(word)),
            1 | 2 | 5 | 6 => {
                let code = if round % 2 == 1 { swept % bins } else { hot };
                swept += 1;
                (i.clear, i.tdc_valid, i.tdc_code) = (false, !draw.one_in(8), U::new(code));
            }
            3 | 7 => {
                (i.clear, i.tdc_valid) = (false, word != hot && draw.one_in(4));
                (i.read_en, i.read_addr) = (true, U::new(word));
            }
            _ => {}
        }
        // The word that counts on is cleared at first, and then not before it has many hits.
        let may_clear = round == 0 || cycle < mixed && count(U::new(hot)) >= many;
        i.clear &= i.clear_addr != hot || may_clear;

        since += 1;
        // Nothing is counted before every word has been cleared.
        i.tdc_valid &= round > 0;
        if since < HIT {
            (i.tdc_valid, i.tdc_code) = (false, last);
        }
        if i.tdc_valid {
            spans.see_if(since <= APART, 2 * since as u64 + u64::from(i.tdc_code == last));
            (since, last) = (0, i.tdc_code);
        }
        i.clear &= !apart || since == 0 || since >= HIT;
        i.read_en &= !apart || !i.clear && since >= HIT;
        phases.see_if(since < HIT, since as u64 * 4 + bits([i.clear, i.read_en]));
        let [clear, hit] = [i.clear, i.tdc_valid && !i.clear];
        let shown = histogram.count(&i).get();
        cleared.see_if(clear && count(i.clear_addr) > 0, i.clear_addr.get());
        hits.see_if(hit, i.tdc_code.get());
        let is_counting = histogram.has_hit();
        seen.see_if(shown > 0 && !clear && !is_counting, i.read_addr.get());
        sizes.see(64 - u64::from(shown.leading_zeros()));
        let shown_word = if is_counting { i.tdc_code } else { i.read_addr };
        let shows_hot = i.read_en && !clear && shown_word == hot;
        sizes.see_if(full && shows_hot && shown < close, wrapped);
        full |= shown + close > most;
        overlaps.see(bits([i.clear, i.tdc_valid, i.read_en]) * 5 + equal(&i));
        run.top.nets.count = U::new(shown);
        run.line(&i);
        run.top.histogram_builder.tick(&i, &size);
    }
    let coverage = [cleared, hits, seen, overlaps, phases, spans, sizes];
    Ok(Vectors { settles: bins as usize, ..run.vectors(coverage) })
}
