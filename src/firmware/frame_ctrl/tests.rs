use super::*;

const SHORT: Params = Params {
    shots_per_frame: 2,
    histogram: histogram_builder::Params { bins: 256, count_bits: 16 },
    preloaded: false,
    drain_cycles: DRAIN_CYCLES,
    scan: Scan { rows: 1, columns: 1, banks: 1 },
};
const ENABLED: In = In {
    rst: false,
    start: false,
    dsp_rst: false,
    dsp_en: true,
    algo_done: false,
    calibrating: false,
};

fn after(mut ctrl: FrameCtrl, edges: usize, i: In, p: &Params) -> FrameCtrl {
    for _ in 0..edges {
        ctrl = ctrl.next(&i, p);
    }
    ctrl
}

fn draining() -> FrameCtrl {
    let acquiring = after(FrameCtrl::default(), 256, ENABLED, &SHORT);
    assert!(acquiring.acquire && !acquiring.clear);
    after(acquiring, 2, In { start: true, ..ENABLED }, &SHORT)
}

#[test]
fn clear_takes_256_cycles_and_then_shots_are_counted() {
    assert!(after(FrameCtrl::default(), 255, ENABLED, &SHORT).clear);
    let ctrl = draining();
    assert_eq!(ctrl.state, State::Drain);
    assert!(!ctrl.acquire);
}

#[test]
fn the_estimator_starts_after_sixteen_cycles_of_drain() {
    assert!(!after(draining(), 15, ENABLED, &SHORT).algo_start);
    assert!(after(draining(), 16, ENABLED, &SHORT).algo_start);
    assert!(!after(draining(), 17, ENABLED, &SHORT).algo_start);
}

#[test]
fn dsp_en_low_holds_the_frame_before_the_estimator() {
    let held = after(draining(), 500, In { dsp_en: false, ..ENABLED }, &SHORT);
    assert_eq!(held.state, State::Drain);
    assert!(after(held, 1, ENABLED, &SHORT).algo_start);
}

#[test]
fn a_calibration_holds_the_last_cycle_of_clear() {
    for p in [SHORT, Params { preloaded: true, ..SHORT }] {
        let calibrating = In { calibrating: true, ..ENABLED };
        let held = after(FrameCtrl::default(), 500, calibrating, &p);
        assert!(held.clear && held.clear_addr == 255 && held.state == State::Clear);
        assert!(!after(held, 1, ENABLED, &p).clear);
    }
}

#[test]
fn dsp_rst_returns_to_clear_from_anywhere() {
    let reset = In { dsp_rst: true, ..ENABLED };
    assert_eq!(draining().next(&reset, &SHORT), FrameCtrl::default());
}

/// Runs 40,000 cycles with a shot in every third cycle and an estimator of `cycles`. Returns row and column of each
/// depth, with the bank that is filled meanwhile, the cycles from frame to frame, and those from the fall of
/// `acquire` to the last depth of each row.
fn scanned(p: &Params, cycles: u64) -> (Vec<[u64; 3]>, Vec<u64>, Vec<u64>) {
    let (mut ctrl, mut due, mut since, mut ended, mut handed) =
        (FrameCtrl::default(), None, 0, 0, 0);
    let (mut depths, mut frames, mut latencies) = (Vec::new(), Vec::new(), Vec::new());
    for cycle in 0..40_000 {
        if ctrl.algo_start {
            due = Some(cycle + 1 + cycles);
            handed = if ctrl.depth_column == 0 { ended } else { handed };
        }
        let algo_done = due == Some(cycle);
        if algo_done {
            let place = [ctrl.depth_row, ctrl.depth_column].map(|place| place.get());
            depths.push([place[0], place[1], ctrl.bank.into()]);
            if place[1] == p.scan.last_column() {
                latencies.push(cycle - handed);
            }
        }
        if ctrl.frame_done {
            frames.push(cycle);
        }
        let (start, acquired) = (ctrl.acquire && since == 3, ctrl.acquire);
        since = if start || !acquired { 1 } else { since + 1 };
        ctrl = ctrl.next(&In { start, algo_done, ..ENABLED }, p);
        if ctrl.acquire != acquired {
            (since, ended) = (0, cycle + 1);
        }
    }
    let periods = frames.windows(2).map(|pair| pair[1] - pair[0]).collect();
    (depths, periods, latencies)
}

#[test]
fn an_array_is_estimated_row_by_row_in_as_many_cycles_as_it_promises() {
    for (banks, columns, cycles) in [(1, 1, 267), (1, 2, 50), (2, 1, 20), (2, 4, 50), (2, 4, 500)] {
        let p = Params { scan: Scan { rows: 3, columns, banks }, ..SHORT };
        let (depths, periods, latencies) = scanned(&p, cycles);
        let (columns, banks) = (u64::from(columns), u64::from(banks));
        let place = |k: u64| [k / columns % 3, k % columns, (k / columns + 1) % banks];
        assert_eq!(depths, (0..depths.len() as u64).map(place).collect::<Vec<_>>());
        let timing::RowTiming { row, latency, .. } = p.timing(3, cycles);
        let (first, others) = latencies.split_first().unwrap();
        assert!(*first <= latency && others.len() > 15, "{p:?}");
        assert!(others.iter().all(|&cycles| cycles == latency), "{p:?}: {others:?}");
        assert!(periods.iter().all(|&cycles| cycles == row), "{p:?}: {periods:?}");
    }
}

#[test]
fn an_image_of_40_rows_takes_57_7_ms() {
    let scan = Scan { rows: 40, columns: 30, banks: 2 };
    let p = Params { shots_per_frame: 30_000, scan, ..SHORT };
    // The network and the likelihood estimator at 125 MHz, with a shot in six cycles.
    for (cycles, estimation) in [(267, 8_070), (3_779, 113_430)] {
        let timing = p.timing(6, cycles);
        assert_eq!([timing.estimation, timing.row, timing.image], [estimation, 180_273, 7_210_920]);
    }
    let p = Params { scan: Scan { banks: 1, ..scan }, ..p };
    assert_eq!(p.timing(6, 267).row, 180_273 + 8_070);
}

#[test]
fn a_preloaded_histogram_needs_no_acquisition() {
    let preloaded = Params { preloaded: true, ..SHORT };
    let ctrl = after(FrameCtrl::default(), 256, ENABLED, &preloaded);
    assert!(ctrl.algo_start && !ctrl.acquire);
    let done = ctrl.next(&In { algo_done: true, ..ENABLED }, &preloaded);
    assert!(done.frame_done && done.clear);
}
