use super::*;

const TAPS: usize = 16;

fn params() -> Params {
    let (begin, start) = (1280 << FRACTION, 5120 << FRACTION);
    Params { taps: TAPS, cycle: 5120, hits_log2: 10, frames: 2, begin, start }
}

const CLEAR: In = In { rst: false, clear: true, frame_done: false, n_valid: false, n: U::new(0) };

/// The block after a calibration with that `n` for the hit of each number, and its cycles.
fn calibrated(block: &mut TdcCalibration, p: &Params, n_of: impl Fn(u64) -> u64) -> u64 {
    let (mut given, mut cycles) = (0, 0);
    block.tick(&CLEAR, p);
    assert!(block.registers.ring_on && block.registers.calibrating);
    while block.registers.calibrating {
        let n_valid = cycles % 3 == 0;
        let counts = block.state() == State::Count && block.registers.hits != p.hits();
        block.tick(&In { n_valid, n: U::new(n_of(given)), ..CLEAR }, p);
        given += u64::from(n_valid && counts);
        cycles += 1;
    }
    cycles
}

#[test]
fn ages_are_those_that_counts_come_to() {
    let (p, mut counts) = (params(), vec![0; TAPS + 1]);
    let n_of = |hit: u64| 1 + hit * hit % 13;
    (0..p.hits()).for_each(|hit| counts[n_of(hit) as usize] += 1);
    let mut block = TdcCalibration::new(&p);
    let cycles = calibrated(&mut block, &p, n_of);
    let ages: Vec<_> = block.ram.iter().map(|word| word.get()).collect();
    assert_eq!(ages, p.ages(&counts));
    assert_eq!(ages[0], 1280);
    assert_eq!(ages[TAPS], 1280 + 5120, "after all hits");
    let words = TAPS as u64 + 1;
    assert!(cycles.abs_diff(words + 3 * p.hits() + BEATS * words) < 6, "{cycles}");
}

#[test]
fn the_age_that_holds_the_laser_edge_is_limited() {
    // 3 of 4 hits are younger than 1280 + 3840 units, which is the edge, and then there is one tap.
    let n_of = |hit: u64| if hit % 4 < 3 { 5 } else { 6 };
    let (p, mut block) = (params(), TdcCalibration::new(&params()));
    calibrated(&mut block, &p, n_of);
    assert_eq!(block.ram[5], 1280 + 1920);
    assert_eq!(block.ram[6], 5120, "begins with the edge");
    assert_eq!(block.ram[7], 6400, "begins after it");
}

#[test]
fn it_calibrates_after_a_reset_and_after_so_many_frames() {
    let (p, mut block) = (params(), TdcCalibration::new(&params()));
    calibrated(&mut block, &p, |_| 3);
    let done = In { frame_done: true, ..CLEAR };
    block.tick(&done, &p);
    block.tick(&CLEAR, &p);
    assert_eq!(block.state(), State::Idle);
    block.tick(&done, &p);
    block.tick(&CLEAR, &p);
    assert_eq!(block.state(), State::Zero);
    block.tick(&In { rst: true, ..CLEAR }, &p);
    assert!(!block.registers.calibrating && !block.registers.ring_on);
    block.tick(&In { clear: false, ..CLEAR }, &p);
    assert_eq!(block.state(), State::Idle, "not while shots are fired");
    block.tick(&CLEAR, &p);
    assert_eq!(block.state(), State::Zero);
}

#[test]
fn the_decoder_reads_the_word_of_its_hit() {
    let (p, mut block) = (params(), TdcCalibration::new(&params()));
    calibrated(&mut block, &p, |hit| 1 + hit % 16);
    for n in 0..=TAPS as u64 {
        block.tick(&In { clear: false, n_valid: true, n: U::new(n), ..CLEAR }, &p);
        assert_eq!(block.registers.calibrated_age, block.ram[n as usize]);
    }
}
