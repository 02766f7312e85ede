use super::*;
use crate::optics::{Budget, Hazard};

/// Light on a SPAD with so many ambient carriers per second, and as many again in a pulse of each shot.
fn optics(rate_hz: f64, seed: u64) -> Optics {
    let mean_arrival = Time::from_ns(5);
    let signal_per_shot = rate_hz * 48e-9;
    let budget =
        Budget { signal_per_shot, ambient_rate_hz: rate_hz, mean_arrival, ..Budget::default() };
    Optics::new(Hazard::new(&budget), Hazard::dark(&budget), seed)
}

fn spads() -> Vec<Optics> {
    [(2e8, 1), (1e6, 2), (5e7, 3)].map(|(rate_hz, seed)| optics(rate_hz, seed)).into()
}

/// Begin of a shot.
fn begin(shot: u64) -> Time {
    Time::from_ns(48 * shot)
}

#[test]
fn every_spad_has_the_carriers_that_it_has_by_itself() {
    let mut row = RowLight::new(spads());
    let mut found = [const { Vec::new() }; 3];
    row.begin_frame(4);
    for shot in 0..200 {
        row.begin_shot(begin(shot), true);
        let mut now = row.next_avalanche(begin(shot));
        while now < begin(shot + 1) {
            row.take(now);
            found[row.last()].push(now);
            now = row.next_avalanche(now);
        }
    }
    for (mut optics, found) in spads().into_iter().zip(found) {
        let mut alone = Vec::new();
        optics.begin_frame(4);
        for shot in 0..200 {
            optics.begin_shot(begin(shot), true);
            let mut now = optics.next_avalanche(begin(shot), 1.0);
            while now < begin(shot + 1) {
                optics.take(now);
                alone.push(now);
                now = optics.next_avalanche(now, 1.0);
            }
        }
        assert!(alone.len() > 10);
        assert_eq!(found, alone);
    }
}

#[test]
fn carriers_that_come_while_the_spads_are_off_are_lost_and_later_ones_are_not() {
    let mut row = RowLight::new(spads());
    row.begin_shot(Time::ZERO, true);
    let first = row.next_avalanche(Time::ZERO);
    let drawn = row.coming.clone();
    let armed = first + Time::from_ns(3);
    assert!(row.next_avalanche(armed) >= armed);
    for (before, after) in drawn.into_iter().zip(&row.coming) {
        assert_eq!(before.is_some_and(|at| at >= armed), before == *after);
    }
}
