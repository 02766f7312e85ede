//! Tests of a TDC's characterization against closed forms and the firmware.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use tofsim::Setup;
use tofsim::firmware::carry_chain::Transitions;
use tofsim::firmware::tdc;
use tofsim::kernel::Time;
use tofsim_learn::characterisation::Characterisation;
use tofsim_learn::characterisation::decoders::Comparison;
use tofsim_learn::characterisation::density::{CodeDensity, Spread};
use tofsim_learn::characterisation::rom::CalibratedRom;

const HITS: u64 = 1_000_000;

fn params(keys: &[&str]) -> tdc::Params {
    Setup::load("kc705", keys).unwrap().params.tdc
}

fn of(keys: &[&str]) -> Characterisation {
    Characterisation::new((&params(keys), None), HITS, 1)
}

#[test]
fn a_million_hits_find_the_true_widths_within_their_counting_error() {
    for profile in ["uniform", "table6_3", "kintex7"] {
        let density = of(&[&format!("tdc.profile={profile}")]).density;
        let sum: f64 = density.true_ps().iter().sum();
        assert!((sum - 8000.0).abs() < 1e-6, "{profile}: {sum}");
        assert_eq!(density.bins.iter().map(|bin| bin.count).sum::<u64>(), HITS);
        let (mut chi_square, mut cells, mut rest) = (0.0, 0.0, (0.0, 0.0));
        for bin in &density.bins {
            let expected = HITS as f64 * bin.true_width_ps / 8000.0;
            rest = (rest.0 + bin.count as f64, rest.1 + expected);
            if rest.1 >= 10.0 {
                chi_square += (rest.0 - rest.1).powi(2) / rest.1;
                (cells, rest) = (cells + 1.0, (0.0, 0.0));
            }
        }
        let chance = ChiSquared::new(cells - 1.0).unwrap().sf(chi_square);
        assert!(cells > 500.0 && chance > 1e-3, "{profile}: {chi_square} of {cells}");
        let off = |bin| {
            let (ps, se_ps): (f64, f64) = density.width_ps(bin);
            (ps - bin.true_width_ps).abs() / se_ps.max(0.008)
        };
        assert!(density.bins.iter().map(off).fold(0.0, f64::max) < 5.0, "{profile}");
    }
}

#[test]
fn equal_taps_are_equal_and_their_precision_is_a_tap_over_the_root_of_twelve() {
    let found = of(&["tdc.profile=ideal"]);
    let density = &found.density;
    assert_eq!((density.bins.len(), density.empty(), density.narrow()), (640, 0, 0));
    assert!(density.true_ps().iter().all(|ps| *ps == 12.5));
    assert!((CodeDensity::equivalent_ps(&density.true_ps()) - 12.5).abs() < 1e-9);
    let sigma_ps = 12.5 / 12f64.sqrt();
    for error in [&found.raw, &found.calibrated] {
        assert!((error.precision_ps - sigma_ps).abs() < 0.01, "{}", error.precision_ps);
    }
    assert_eq!((found.bubbles.share, found.bubbles.longest), (0.0, 0));
    assert_eq!(found.bubbles.transitions.keys().copied().collect::<Vec<_>>(), [1]);
    // A code is two taps wide.
    assert!((found.transfer.code_precision_ps - 25.0 / 12f64.sqrt()).abs() < 0.1);
}

#[test]
fn the_silicon_chain_is_as_measured_ones_are() {
    let found = of(&["tdc.profile=kintex7"]);
    let density = &found.density;
    let bins = density.bins.len() as f64;
    let narrow = density.narrow() as f64 / bins;
    assert!((0.38..0.52).contains(&narrow), "{narrow}");
    let dnl = density.dnl(&density.true_ps());
    let spread = Spread::of(&dnl);
    assert!((0.8..1.2).contains(&spread.rms), "{spread:?}");
    assert!((2.5..5.5).contains(&spread.largest), "{spread:?}");
    let inl = Spread::of(&density.inl(&dnl));
    assert!((6.0..28.0).contains(&(inl.largest - inl.least)), "{inl:?}");
    let widest_ps = Spread::of(&density.true_ps()).largest;
    assert!((40.0..70.0).contains(&widest_ps), "{widest_ps}");
    let equivalent_ps = CodeDensity::equivalent_ps(&density.true_ps());
    assert!((23.0..34.0).contains(&equivalent_ps), "{equivalent_ps}");
    // CO3, CO1, CO2, CO0: a bubble unless all four of a slice are reached, and two that are wide.
    let mut levels: Vec<_> =
        found.bubbles.patterns[..2].iter().map(|pattern| pattern.levels.as_str()).collect();
    levels.sort_unstable();
    assert_eq!(levels, ["0001", "0111"]);
    assert!(found.bubbles.share > 0.9 && found.bubbles.longest >= 4, "{:?}", found.bubbles);
}

#[test]
fn a_calibration_comes_to_the_precision_that_the_widths_allow() {
    let raw = of(&["tdc.profile=kintex7", "tdc.calibration=uniform"]);
    let own = of(&["tdc.profile=kintex7"]);
    let sigma_ps = CodeDensity::equivalent_ps(&own.density.true_ps()) / 12f64.sqrt();
    let ratio = own.calibrated.precision_ps / sigma_ps;
    assert!((1.0..1.02).contains(&ratio), "{ratio}");
    assert_eq!(raw.calibrated, own.raw);
    assert!(raw.calibrated.precision_ps > 1.5 * sigma_ps, "{:?}", raw.calibrated.precision_ps);
    // By a million hits.
    let p = params(&["tdc.profile=kintex7"]);
    let mut counts = vec![0; p.delays.taps() + 1];
    own.density.bins.iter().for_each(|bin| counts[bin.n] = bin.count);
    let rom = CalibratedRom::new("counts", &counts, &p).unwrap();
    assert!(rom.note().is_none());
    let cal = rom.entries.iter().map(|entry| tofsim::kernel::U::new(entry.units)).collect();
    let found = Characterisation::new((&p.clone().with_calibration(cal), None), HITS, 2);
    let ratio = found.calibrated.precision_ps / sigma_ps;
    assert!((1.0..1.15).contains(&ratio), "{ratio}");
    // Each age is within its standard error of the truth, as often as it should be.
    let bins = own.density.bins.iter();
    let off: Vec<_> = bins
        .map(|bin| (rom.entries[bin.n], bin))
        .filter(|(entry, _)| entry.age_se_ps > 0.1)
        .map(|(entry, bin)| (entry.age_ps - bin.true_age_ps) / entry.age_se_ps)
        .collect();
    assert!(off.iter().all(|off| off.abs() < 4.5));
    let enough = rom.enough();
    assert!((100_000..130_000).contains(&enough), "{enough}");
    let few: Vec<_> = counts.iter().map(|count| count / 100).collect();
    let note = CalibratedRom::new("counts", &few, &p).unwrap().note().unwrap().to_string();
    assert!(note.contains("standard errors up to 4") && note.contains("[few-hits]"), "{note}");
}

/// The standard errors of ages are the spread of many tests.
#[test]
fn the_standard_error_of_an_age_is_what_tests_spread_by() {
    let p = params(&["tdc.profile=kintex7"]);
    let roms: Vec<_> = (0..200)
        .map(|seed| {
            let density = CodeDensity::new(&p, 20_000, seed);
            let mut counts = vec![0; p.delays.taps() + 1];
            density.bins.iter().for_each(|bin| counts[bin.n] = bin.count);
            CalibratedRom::new("counts", &counts, &p).unwrap()
        })
        .collect();
    for n in [40, 150, 340, 500, 650] {
        let ages: Vec<_> = roms.iter().map(|rom| rom.entries[n].age_ps).collect();
        let mean = ages.iter().sum::<f64>() / 200.0;
        let deviation = (ages.iter().map(|age| (age - mean).powi(2)).sum::<f64>() / 199.0).sqrt();
        let said = roms[0].entries[n].age_se_ps;
        assert!((deviation / said - 1.0).abs() < 0.2, "{n}: {deviation} {said}");
    }
}

/// The time of a hit as the registers have it: line, taps at tap 0's place, ones, ROM.
fn sampled(t: u64, p: &tdc::Params) -> Option<f64> {
    let (scale, delays) = (&p.decoder.scale, &p.delays);
    let mut transitions = Transitions::default();
    transitions.push(Time::from_fs(t));
    for coarse in 0..p.coarse_counter.window() {
        let edge = Time::from_fs((coarse + 1) * scale.period().fs());
        if edge.fs() < t {
            continue;
        }
        let taps = transitions.sample(true, edge, delays);
        if taps.tap(delays.tap_0_position()) {
            let age = p.decoder.cal[taps.ones(delays.taps())].get() as i64;
            return Some(scale.ps((scale.cycle() * (coarse + 1)) as i64 - age));
        }
    }
    None
}

#[test]
fn no_hit_at_any_of_a_million_phases_is_off_by_a_period() {
    for keys in [
        &["tdc.profile=uniform"][..],
        &["tdc.profile=ideal"],
        &["tdc.profile=kintex7"],
        &["tdc.profile=kintex7", "tdc.calibration=uniform"],
        &["tdc.profile=ecp5", "pll.output_divide=10"],
    ] {
        let p = params(keys);
        let period = p.decoder.scale.period().fs();
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let end = p.coarse_counter.window() * period - p.delays.tap_0().fs();
        let mut largest = 0.0f64;
        for _ in 0..HITS {
            let t = random.random_range(0..=end);
            let time = sampled(t, &p).unwrap();
            largest = largest.max((time - t as f64 * 1e-3).abs());
        }
        assert!(largest < 0.03 * period as f64 * 1e-3, "{keys:?}: {largest}");
        let found = Characterisation::new((&p, None), 100_000, 1);
        assert!(found.is_coarse_right(), "{keys:?}");
        assert!(found.phases.largest_error_ps <= largest + 5.0, "{keys:?}: {:?}", found.phases);
        assert_eq!(found.edges.len() as u64, p.coarse_counter.window() - 1, "{keys:?}");
    }
}

/// Registers that sample up to half of their window early or late take a hit for one as much older or younger, and no
/// more: each decoder's number lies between those of the two.
#[test]
fn metastable_taps_add_half_of_their_window_to_the_largest_error_at_any_of_a_million_phases() {
    for (keys, window_ps) in [
        (&["tdc.profile=uniform"][..], 40.0),
        (&["tdc.profile=kintex7"], 19.0),
        (&["tdc.profile=kintex7", "tdc.decoder=leading"], 19.0),
        (&["tdc.profile=kintex7", "tdc.decoder=reordered"], 19.0),
        (&["tdc.profile=ecp5", "pll.output_divide=10"], 100.0),
    ] {
        let phases = |window_ps: f64| {
            let window = format!("tdc.setup_window_ps={window_ps}");
            let setup = Setup::load("kc705", &[keys, &[&window]].concat()).unwrap();
            let converter = (&setup.params.tdc, setup.disturbance());
            Characterisation::new(converter, HITS, 1).phases
        };
        let (none, wide) = (phases(0.0), phases(window_ps));
        println!("{keys:?} {window_ps} ps: {none:?} {wide:?}");
        assert_eq!(wide.off, 0, "{keys:?}");
        let most_ps = none.largest_error_ps + window_ps / 2.0;
        assert!(wide.largest_error_ps > none.largest_error_ps, "{keys:?}: {wide:?}");
        // A million phases do not come to the worst one.
        assert!(wide.largest_error_ps < most_ps + 1.0, "{keys:?}: {wide:?} {none:?}");
    }
}

#[test]
fn a_coarse_count_that_does_not_go_with_the_taps_is_found() {
    // A ROM that folds ages at a period, as one for a stop that reaches counter and taps at other times.
    let p = params(&["tdc.profile=kintex7"]);
    let cal = p.decoder.cal.iter().enumerate();
    let folded = cal.map(|(n, age)| match n {
        n if n > 400 => tofsim::kernel::U::new(age.get().saturating_sub(5120)),
        _ => *age,
    });
    let folded = p.clone().with_calibration(folded.collect());
    let found = Characterisation::new((&folded, None), 10_000, 1);
    assert!(!found.is_coarse_right() && found.phases.off > 1_000, "{:?}", found.phases);
}

#[test]
fn table_6_3_is_what_the_thesis_has() {
    let found = of(&["tdc.profile=table6_3"]);
    let stops: Vec<_> = found.stops.iter().map(|stop| (stop.t2_ns, stop.n, stop.t1_ns)).collect();
    assert_eq!(stops, [(2, 328, 8.0), (4, 154, 8.0), (8, 492, 16.0)]);
}

#[test]
fn counts_for_more_taps_than_the_chain_has_are_refused() {
    let p = params(&["tdc.profile=uniform"]);
    let counts = vec![1; 900];
    let error = CalibratedRom::new("c.csv", &counts, &p).unwrap_err().to_string();
    assert_eq!(
        error,
        "c.csv: count of n 899 = 1: expected 0 for more than the 800 taps of the chain"
    );
}

#[test]
fn decoders_that_sort_the_taps_tell_every_pattern_apart_and_the_leading_bit_does_not() {
    let p = params(&["tdc.profile=kintex7"]);
    let found = Comparison::new(&p, 20_000, 1);
    let [ones, leading, reordered, states] = &found.decoders[..] else { panic!() };
    assert_eq!([ones.name, leading.name, reordered.name], ["ones", "leading", "reordered"]);
    // Every step of the hit from tap to tap shows another pattern, of which each has one ones count.
    assert_eq!(ones.density, reordered.density);
    assert_eq!((ones.codes, ones.precision_ps), (states.codes, states.precision_ps));
    assert!(leading.codes < ones.codes && leading.equivalent_ps > ones.equivalent_ps);
    for one in &found.decoders {
        assert_eq!(one.density.bins.iter().map(|bin| bin.count).sum::<u64>(), 20_000);
        let widths: f64 = one.density.true_ps().iter().sum();
        assert!((widths - 8000.0).abs() < 1e-6, "{}: {widths}", one.name);
    }
    // By age, femtosecond by femtosecond in steps that no arrival divides: as many codes.
    let numbers = |of: &dyn Fn(usize) -> usize| {
        let ages = (p.delays.tap_0().fs()..p.delays.tap_0().fs() + 8_000_000).step_by(7);
        let mut all: Vec<_> = ages.map(|fs| of(p.delays.rank(Time::from_fs(fs)))).collect();
        all.dedup();
        all.len()
    };
    let highest =
        |rank: usize| p.delays.order()[..rank].iter().max().map_or(0, |tap| tap + 1).into();
    assert!(numbers(&|rank| rank).abs_diff(ones.codes) <= 2);
    assert!(numbers(&highest).abs_diff(leading.codes) <= 2);
    let shares: f64 = found.patterns.iter().map(|read| read.share).sum();
    assert!((shares - 1.0).abs() < 1e-9, "{shares}");
}

#[test]
fn a_converter_s_error_is_that_of_its_decoder() {
    for decoder in ["leading", "reordered"] {
        let found = of(&["tdc.profile=kintex7", &format!("tdc.decoder={decoder}")]);
        assert!(found.is_coarse_right(), "{decoder}");
        assert!(found.calibrated.mean_ps.abs() < 0.5, "{decoder}: {}", found.calibrated.mean_ps);
        let sigma_ps = CodeDensity::equivalent_ps(&found.density.true_ps()) / 12f64.sqrt();
        let precision_ps = found.calibrated.precision_ps;
        assert!((precision_ps / sigma_ps - 1.0).abs() < 0.15, "{decoder}: {precision_ps}");
        let counts = (0..=found.taps).map(|n| found.density.bins.iter().find(|bin| bin.n == n));
        let counts: Vec<u64> = counts.map(|bin| bin.map_or(0, |bin| bin.count)).collect();
        let p = params(&["tdc.profile=kintex7", &format!("tdc.decoder={decoder}")]);
        let rom = CalibratedRom::new("counts", &counts, &p).unwrap();
        // A million hits find the words to some standard errors, but for the last, which a period ends.
        let last = found.density.bins.last().map_or(0, |bin| bin.n);
        for entry in rom.entries.iter().filter(|entry| entry.count > 0 && entry.n < last) {
            let unit_ps = 25.0 / 16.0;
            let own_ps = p.decoder.cal[entry.n].get() as f64 * unit_ps;
            let off_ps = (entry.units as f64 * unit_ps - own_ps).abs();
            assert!(
                off_ps < 5.0 * entry.age_se_ps + 2.0 * unit_ps,
                "{decoder} {}: {off_ps}",
                entry.n
            );
        }
    }
}

/// A file of ages, and where the bins begin by it [ps].
fn edges_by_counts(counts: &[u64]) -> Vec<f64> {
    let rom = CalibratedRom::new("counts", counts, &params(&["tdc.profile=kintex7"])).unwrap();
    let rows = rom.entries.iter();
    let rows =
        rows.map(|entry| format!("{},{:.3},{:.3}\n", entry.n, entry.age_ps, entry.age_se_ps));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cal.csv");
    std::fs::write(&path, format!("n,age_ps,age_se_ps\n{}", rows.collect::<String>())).unwrap();
    let key = format!("tdc.calibration={}", path.display());
    Setup::load("kc705", &["tdc.profile=kintex7", &key]).unwrap().known_bins().edges_ps()
}

/// An estimator that reckons with the bins knows what the calibration found of them.
#[test]
fn the_bins_that_an_estimator_is_told_are_those_of_the_calibration() {
    let own = Setup::load("kc705", &["tdc.profile=kintex7"]).unwrap();
    let edges_ps = own.bins().edges_ps();
    assert_eq!(own.known_bins(), own.bins());
    let off = |known_ps: &[f64], edges_ps: &[f64]| {
        let pairs = known_ps.iter().zip(edges_ps);
        let offs: Vec<_> = pairs.map(|(known, own)| known - own).collect();
        Spread::of(&offs)
    };
    let density = CodeDensity::new(&own.params.tdc, HITS, 1);
    let mut counts = vec![0; own.params.tdc.delays.taps() + 1];
    // As many hits as femtoseconds: the widths themselves.
    density.bins.iter().for_each(|bin| counts[bin.n] = (bin.true_width_ps * 1e3).round() as u64);
    let exact = off(&edges_by_counts(&counts), &edges_ps);
    assert!(exact.largest < 0.1 && exact.least > -0.1, "{exact:?}");
    density.bins.iter().for_each(|bin| counts[bin.n] = bin.count);
    // Standard errors are up to 4 ps; a word of the ROM may put a tap into the next bin.
    let counted = off(&edges_by_counts(&counts), &edges_ps);
    assert!((0.1..8.0).contains(&counted.rms), "{counted:?}");
    let raw = Setup::load("kc705", &["tdc.profile=kintex7", "tdc.calibration=uniform"]).unwrap();
    let known_ps = raw.known_bins().edges_ps();
    let widths: Vec<_> = known_ps.windows(2).map(|pair| pair[1] - pair[0] - 25.0).collect();
    let widths = Spread::of(&widths[1..]);
    assert!(widths.largest < 12.5 && widths.least > -12.5, "{widths:?}");
    let raw = off(&known_ps, &raw.bins().edges_ps());
    assert!(raw.rms > 20.0, "{raw:?}");
}
