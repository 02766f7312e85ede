//! The pulse as a ROM has it.
//!
//! A word holds the part of the pulse that came before, between two words of which it is straight, and two
//! slopes: that of the logarithm of the pulse, for a bin in it, and that of the logarithm of the part before, for
//! bin 0. Only the parts have to be exact: with slopes that are a little wrong the residuals still are zero in the
//! mean.

use crate::kernel::pulse::Pulse;

/// Words of the ROM: 1024 steps to either side of the middle.
pub const WORDS: usize = 2048;
/// Steps in 16/3 deviations at most, so that tails end within the ROM.
const STEPS_OF_TAIL: f64 = 1024.0;
/// All of the pulse.
const ALL: f64 = 131_071.0;
/// Largest slope.
const STEEPEST: f64 = 255.0;

/// One word.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PulseWord {
    /// Part of the pulse that came before, of 131,071: 17 bits.
    pub part: i64,
    /// -f'/f, times deviation and the deviation in z: 9 bits, signed.
    pub slope: i64,
    /// -f/F, times the same: 9 bits, signed.
    pub first: i64,
}

/// Logarithm of the ROM's step, of which a unit of time is so long [units].
pub fn step_log2(pulse: &Pulse, unit_ps: f64) -> u32 {
    let [begin_ps, end_ps] = pulse.ends_ps();
    // 16/3 deviations of a Gaussian, which ends at 4.5.
    let reach = (-begin_ps).max(end_ps) * (16.0 / 3.0 / 4.5) / unit_ps;
    (0..).find(|&log2: &u32| reach <= STEPS_OF_TAIL * (log2 as f64).exp2()).unwrap_or_default()
}

/// The ROM's words, by the step from the middle as a signed number plus 1024.
pub fn words(pulse: &Pulse, unit_ps: f64, step_log2: u32) -> Vec<PulseWord> {
    let sigma_ps = pulse.sigma_ps();
    let step = f64::from(1u32 << step_log2);
    let deviation = sigma_ps / unit_ps / step / 4.0;
    let word = |k: usize| {
        let t_ps = (k as f64 - 1024.0) * step * unit_ps;
        let (part, density) = (pulse.part(t_ps), pulse.density(t_ps));
        let slope = |of: f64, over: f64| match over > 1e-30 {
            true => -of / over * sigma_ps * deviation,
            false => t_ps / sigma_ps * deviation,
        };
        let slope = |of, over| libm::round(slope(of, over)).clamp(-STEEPEST, STEEPEST) as i64;
        PulseWord {
            part: libm::round(part * ALL) as i64,
            slope: slope(pulse.slope(t_ps), density),
            first: slope(density, part),
        }
    };
    (0..WORDS).map(word).collect()
}

#[cfg(test)]
mod tests {
    use crate::kernel::pulse::Samples;

    use super::*;

    #[test]
    fn the_rom_of_a_sampled_gaussian_is_nearly_that_of_one() {
        let (gaussian, step_ps) = (Pulse::default(), 5.0);
        let density: Vec<_> =
            (0..300).map(|k| gaussian.density((k as f64 - 150.0) * step_ps)).collect();
        let sampled = Pulse::Sampled(Samples::new(step_ps, &density).unwrap());
        let unit_ps = 25.0 / 64.0;
        let [mine, theirs] = [&sampled, &gaussian].map(|pulse| words(pulse, unit_ps, 1));
        for (mine, theirs) in mine.iter().zip(&theirs).skip(300).take(1448) {
            assert!((mine.part - theirs.part).abs() < 30, "{mine:?} {theirs:?}");
            assert!((mine.slope - theirs.slope).abs() < 4, "{mine:?} {theirs:?}");
        }
        assert_eq!(step_log2(&sampled, unit_ps), step_log2(&gaussian, unit_ps));
    }
}
