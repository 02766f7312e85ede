use super::super::histogram_builder::BINS;
use super::*;

const IDLE: In = In { rst: false, algo_start: false, count: U::new(0) };
const GO: In = In { algo_start: true, ..IDLE };

/// The block in each cycle from e0 on, over a histogram, with the inputs `at` says.
fn cycles(histogram: &[u64; BINS], at: impl Fn(u64) -> In) -> Vec<Registers> {
    let mut block = CentroidEstimator::default();
    block.rise(&GO, &Params::default());
    (0..700)
        .map(|cycle| {
            let now = block.registers;
            let count = if now.read_en { histogram[now.read_addr.index()] } else { 999 };
            block.rise(&In { count: U::new(count), ..at(cycle) }, &Params::default());
            now
        })
        .collect()
}

fn one(bin: usize) -> [u64; BINS] {
    std::array::from_fn(|k| if k == bin { 50 } else { 0 })
}

#[test]
fn the_depth_is_ready_311_edges_after_the_start_is_taken() {
    let cycles = cycles(&one(100), |_| IDLE);
    let done: Vec<_> = (0..700).filter(|&cycle| cycles[cycle].algo_done).collect();
    assert_eq!(done, [312]);
    let metres = cycles[312].depth.to_f64();
    assert!((metres - 100.5 * 0.003_747_405_725).abs() < 1e-6, "{metres}");
    assert_eq!(cycles[699].depth, cycles[312].depth);
}

#[test]
fn each_word_is_read_once_and_in_order() {
    let cycles = cycles(&one(100), |_| IDLE);
    let read = cycles.iter().filter(|now| now.read_en).map(|now| now.read_addr.get());
    assert!(read.eq(0..256));
}

#[test]
fn a_start_while_busy_is_ignored_and_one_with_algo_done_is_taken() {
    let at = |again| move |cycle| if cycle == again { GO } else { IDLE };
    assert_eq!(cycles(&one(100), at(311)), cycles(&one(100), |_| IDLE));
    let again = cycles(&one(100), at(312));
    assert!(again[313].read_en && again[312 + 313].algo_done);
}

#[test]
fn a_reset_drops_everything_and_leaves_no_trace_in_the_next_estimation() {
    let reset = |cycle| In { rst: cycle == 200, algo_start: cycle == 210, ..IDLE };
    let cycles = cycles(&one(100), reset);
    assert_eq!(cycles[201], Registers::default());
    assert_eq!(cycles.iter().position(|now| now.algo_done), Some(211 + 312));
    let metres = cycles[211 + 312].depth.to_f64();
    assert!((metres - 100.5 * 0.003_747_405_725).abs() < 1e-6, "{metres}");
}

#[test]
fn nothing_stands_out_of_an_empty_or_a_full_histogram() {
    for histogram in [[0; BINS], [65_535; BINS]] {
        assert_eq!(cycles(&histogram, |_| IDLE)[312].depth, Depth::new(0));
    }
}
