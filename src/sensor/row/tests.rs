use super::*;

const DEAD: Time = Time::from_ns(20);

fn row(count: usize, effects: Effects) -> SpadRow {
    SpadRow::new(count, effects, 1)
}

#[test]
fn an_avalanche_traps_a_carrier_with_its_chance_and_for_an_exponential_time() {
    let mut row =
        row(1, Effects { trap_probability: 0.3, afterpulse_fs: 5e7, ..Effects::default() });
    let mut held_ns = Vec::new();
    for shot in 0..20_000 {
        let now = Time::from_ns(1000 * shot);
        row.begin_shot();
        row.arm_all();
        assert!(row.carrier(0, now, DEAD, false));
        if row.release() != Time::NEVER {
            held_ns.push((row.release() - now).seconds() * 1e9);
            assert_eq!(row.released(), Some(0));
        }
    }
    let trapped = held_ns.len() as f64;
    assert!((trapped - 6000.0).abs() < 4.0 * (20_000.0f64 * 0.21).sqrt(), "{trapped}");
    let mean_ns = held_ns.iter().sum::<f64>() / trapped;
    assert!((mean_ns / 50.0 - 1.0).abs() < 4.0 / trapped.sqrt(), "{mean_ns} ns");
    let long = held_ns.iter().filter(|&&ns| ns > 100.0).count() as f64 / trapped;
    assert!((long - (-2.0f64).exp()).abs() < 4.0 * 0.34 / trapped.sqrt(), "{long}");
}

/// Effects with two kinds of trap.
fn two_kinds(share: f64) -> Effects {
    Effects {
        trap_probability: 0.6,
        afterpulse_fs: 3e7,
        afterpulse_second_fs: 4e8,
        afterpulse_second_share: share,
        ..Effects::default()
    }
}

/// Returns the lifetimes of the carriers trapped by `avalanches` avalanches, in ascending order [fs].
fn held_fs(effects: &Effects, avalanches: u64) -> Vec<u64> {
    let mut row = row(1, effects.clone());
    let mut held = Vec::new();
    for shot in 0..avalanches {
        let now = Time::from_ns(10_000 * shot);
        row.begin_shot();
        row.arm_all();
        assert!(row.carrier(0, now, DEAD, false));
        held.extend((row.release() != Time::NEVER).then(|| (row.release() - now).fs()));
        row.trapped.clear();
    }
    held.sort_unstable();
    held
}

/// Computes the Kolmogorov statistic of lifetimes; it exceeds 1.95 with a probability of 0.001.
fn kolmogorov(held_fs: &[u64], effects: &Effects) -> f64 {
    let count = held_fs.len() as f64;
    let off = held_fs.iter().enumerate().map(|(k, &fs)| {
        let part = 1.0 - effects.released_after(fs as f64) / effects.trap_probability;
        (part - k as f64 / count).abs().max((part - (k + 1) as f64 / count).abs())
    });
    off.fold(0.0, f64::max) * count.sqrt()
}

#[test]
fn with_traps_of_two_kinds_release_times_are_those_of_the_mixture() {
    for share in [0.0, 0.25, 0.7, 1.0] {
        let effects = two_kinds(share);
        let held = held_fs(&effects, 40_000);
        let count = held.len() as f64;
        assert!((count - 24_000.0).abs() < 4.0 * (40_000.0f64 * 0.24).sqrt(), "{share}: {count}");
        let off = kolmogorov(&held, &effects);
        assert!(off < 1.95, "{share}: {off}");
        // It would tell a mixture of other parts.
        let other = kolmogorov(&held, &two_kinds((share - 0.05f64).abs()));
        assert!(other > 1.95, "{share}: {other}");
    }
}

#[test]
fn traps_of_a_second_kind_that_nothing_is_in_move_no_draw() {
    let one = Effects { trap_probability: 0.6, afterpulse_fs: 3e7, ..Effects::default() };
    let held = held_fs(&one, 1000);
    assert_eq!(held_fs(&two_kinds(0.0), 1000), held);
    let all = Effects { afterpulse_fs: 1.0, afterpulse_second_fs: 3e7, ..two_kinds(1.0) };
    assert_eq!(held_fs(&all, 1000), held);
    assert_eq!(two_kinds(0.0).longest_trap_fs(), 3e7);
    assert_eq!(two_kinds(0.1).longest_trap_fs(), 4e8);
}

#[test]
fn a_carrier_at_rest_is_lost_or_starts_the_dead_time_again() {
    let mut row = row(2, Effects::default());
    let [begin, later] = [10, 15].map(Time::from_ns);
    assert!(row.carrier(0, begin, DEAD, false));
    assert!(!row.carrier(0, later, DEAD, false));
    assert!(row.carrier(1, later, DEAD, false));
    assert_eq!(row.fired().collect::<Vec<_>>(), [begin + DEAD, later + DEAD]);
    assert!(!row.carrier(0, later, DEAD, true));
    assert_eq!(row.fired().collect::<Vec<_>>(), [later + DEAD, later + DEAD]);
    row.recover(later + DEAD);
    assert_eq!(row.fired().count(), 0);
}

#[test]
fn crosstalk_reaches_neighbours_and_theirs_and_nobody_else() {
    let mut row = row(5, Effects { crosstalk_probability: 0.25, ..Effects::default() });
    let mut fired = [0; 5];
    let shots = 40_000;
    for _ in 0..shots {
        row.begin_shot();
        row.arm_all();
        row.carrier(2, Time::ZERO, DEAD, false);
        for (count, dead) in fired.iter_mut().zip(&row.dead) {
            *count += u32::from(dead.is_some());
        }
    }
    // A neighbour is set off by the one in the middle alone, and sets off the outer one.
    for (diode, chance) in [(0, 0.0625), (1, 0.25), (2, 1.0), (3, 0.25), (4, 0.0625f64)] {
        let expected = f64::from(shots) * chance;
        let off = f64::from(fired[diode]) - expected;
        let allowed = 4.0 * (expected * (1.0 - chance)).sqrt();
        assert!(off.abs() <= allowed, "diode {diode}: {} for {expected}", fired[diode]);
    }
}

#[test]
fn carriers_of_the_dark_come_to_diodes_by_their_rates_and_photons_to_all_alike() {
    let mut row = row(4, Effects { dark_rates: vec![1.0, 2.0, 0.0, 5.0], ..Effects::default() });
    let mut picked = [0.0; 4];
    let draws = 80_000;
    for _ in 0..draws {
        picked[row.pick(0.5)] += 1.0;
    }
    for (found, rate) in picked.into_iter().zip([1.0, 2.0, 0.0, 5.0]) {
        let chance: f64 = 0.5 / 4.0 + 0.5 * rate / 8.0;
        let expected = f64::from(draws) * chance;
        let allowed = 4.0 * (expected * (1.0 - chance)).sqrt();
        assert!((found - expected).abs() < allowed, "{found} for {expected}");
    }
}

#[test]
fn what_a_shot_draws_does_not_hang_on_how_much_the_one_before_drew() {
    let effects = Effects { trap_probability: 0.5, afterpulse_fs: 5e7, ..Effects::default() };
    let release = |avalanches: u64| {
        let mut row = row(1, effects.clone());
        row.begin_shot();
        for k in 0..avalanches {
            row.arm_all();
            row.carrier(0, Time::from_ns(k), DEAD, false);
        }
        row.trapped.clear();
        let drawn = |shot: u64| {
            row.begin_shot();
            row.arm_all();
            row.carrier(0, Time::from_ns(1000 * shot), DEAD, false);
            row.trapped.clone()
        };
        (1..9).map(drawn).collect::<Vec<_>>()
    };
    assert_eq!(release(1), release(7));
    assert!(release(1).last().is_some_and(|trapped| trapped.len() > 1));
}

/// Effects of a row whose SPADs `on_tdc` are connected to the TDC.
fn whole_row(on_tdc: std::ops::Range<usize>, crosstalk_probability: f64) -> Effects {
    Effects { on_tdc: Some(on_tdc), crosstalk_probability, ..Effects::default() }
}

#[test]
fn crosstalk_goes_through_diodes_that_are_not_on_the_tdc() {
    let mut row = row(5, whole_row(2..3, 0.5));
    let (mut seen, mut alone) = (0, 0);
    let shots = 40_000;
    for _ in 0..shots {
        row.begin_shot();
        row.arm_all();
        let fires = row.carrier(0, Time::ZERO, DEAD, false);
        assert_eq!(fires, row.outputs() & 1 << 2 != 0);
        assert_eq!(row.unwired(), (row.outputs() & 0b11011).count_ones() as usize);
        seen += u32::from(fires);
        alone += u32::from(row.outputs() == 1);
    }
    for (found, chance) in [(seen, 0.25f64), (alone, 0.5)] {
        let expected = f64::from(shots) * chance;
        let off = (f64::from(found) - expected) / (expected * (1.0 - chance)).sqrt();
        assert!(off.abs() < 4.0, "{found} for {expected}");
    }
}

#[test]
fn a_quiet_diode_beside_a_hot_one_fires_of_light() {
    let rates = vec![1.0, 0.0, 9.0, 10.0];
    let row = row(4, Effects { dark_rates: rates, ..whole_row(0..2, 0.0) });
    // Of 8 carriers to all, 4 are of the dark, and each diode has one of the others.
    let parts = [0, 1, 2, 3].map(|diode| row.dark_part(diode, 0.5));
    for (found, expected) in parts.into_iter().zip([0.2 / 1.2, 0.0, 1.8 / 2.8, 2.0 / 3.0]) {
        assert!((found - expected).abs() < 1e-12, "{parts:?}");
    }
    assert_eq!(row.dark_part(1, 1.0), 0.0);
    assert_eq!(SpadRow::new(2, whole_row(0..1, 0.0), 1).dark_part(0, 0.3), 0.3);
}
