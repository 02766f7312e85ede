use super::*;

/// Runs for `cycles` of clk_sys and returns, for each, `pre_start`, `start`, the pulse in the
/// first and in the second half, and `laser_on` in the first quarter and anywhere later.
fn run(driver: &mut VcselDriver, i: &In, cycles: usize) -> Vec<[bool; 6]> {
    let mut seen = Vec::new();
    for _ in 0..cycles {
        driver.rise(i, &Params::default());
        let pulse_first = driver.registers_laser.laser_pulse != 0;
        let on_first = driver.laser_on();
        driver.fall_laser();
        let mut on_later = driver.laser_on();
        driver.rise_laser(i, &Params::default());
        let pulse_second = driver.registers_laser.laser_pulse != 0;
        on_later |= driver.laser_on();
        driver.fall_laser();
        on_later |= driver.laser_on();
        let registers = driver.registers;
        seen.push([
            registers.pre_start,
            registers.start,
            pulse_first,
            pulse_second,
            on_first,
            on_later,
        ]);
    }
    seen
}

fn input(laser_freq: u64) -> In {
    let laser_freq = U::new(laser_freq);
    In { rst: false, rst_laser: false, acquire: true, laser_en: true, laser_freq, ..In::default() }
}

fn ready(i: &In) -> VcselDriver {
    let mut driver = VcselDriver::default();
    run(&mut driver, &In { acquire: false, ..*i }, 1);
    driver
}

#[test]
fn the_first_laser_edge_comes_a_period_after_acquire_and_then_every_period() {
    for (code, period) in PERIODS.into_iter().enumerate() {
        let i = input(code as u64);
        let seen = run(&mut ready(&i), &i, 3 * period as usize);
        let at = |k: usize| (1..=3).map(|shot| shot * period as usize - 1 - k).collect::<Vec<_>>();
        let cycles = |signal: usize| -> Vec<usize> {
            (0..seen.len()).filter(|&cycle| seen[cycle][signal]).collect()
        };
        assert_eq!(cycles(0), at(2), "pre_start");
        assert_eq!(cycles(1), at(0), "start");
        assert!(cycles(2).is_empty(), "laser_pulse in a first half");
        assert_eq!(cycles(3), at(1), "laser_pulse in the half before the laser edge");
        assert_eq!(cycles(4), at(0), "laser_on in the 2 ns after the laser edge");
        assert!(cycles(5).is_empty(), "laser_on later");
    }
}

#[test]
fn a_new_rate_waits_for_the_wrap() {
    let mut driver = ready(&input(3));
    run(&mut driver, &input(3), 3);
    let seen = run(&mut driver, &input(1), 3 + 13);
    let starts: Vec<_> = (0..seen.len()).filter(|&cycle| seen[cycle][1]).collect();
    assert_eq!(starts, [2, 15]);
}

#[test]
fn without_laser_en_shots_go_on_in_the_dark() {
    let i = In { laser_en: false, ..input(3) };
    let seen = run(&mut ready(&i), &i, 12);
    assert_eq!(seen.iter().filter(|cycle| cycle[1]).count(), 2);
    assert!(seen.iter().all(|cycle| !cycle[2..].contains(&true)));
}

#[test]
fn a_pulse_lasts_as_many_half_cycles_as_are_asked_for() {
    for pulse_half_cycles in 1..=LONGEST_PULSE {
        let (i, p) = (input(0), Params { pulse_half_cycles, ..Params::default() });
        let mut driver = ready(&i);
        let mut halves = Vec::new();
        for _ in 0..60 {
            driver.rise(&i, &p);
            for again in [false, true] {
                if again {
                    driver.rise_laser(&i, &p);
                }
                halves.push(driver.laser_on());
                driver.fall_laser();
                halves.push(driver.laser_on());
            }
        }
        let on: Vec<_> = (0..halves.len()).filter(|&half| halves[half]).collect();
        let of_shot = |edge: usize| 4 * edge..4 * edge + pulse_half_cycles as usize;
        assert_eq!(on, of_shot(24).chain(of_shot(49)).collect::<Vec<_>>());
    }
}

#[test]
fn a_rate_past_the_last_is_the_last() {
    let p = Params { periods: vec![9, 5, 7], ..Params::default() };
    assert_eq!([0, 1, 2, 3, 7].map(|rate| p.period(U::new(rate))), [9, 5, 7, 7, 7]);
}
