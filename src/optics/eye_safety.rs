//! Class 1 limits of IEC 60825-1:2014, as stated in the thesis (Table 3.1).

use std::ops::RangeInclusive;

/// Longest exposure of Table 3.1 [s].
pub const LONGEST_S: f64 = 10.0;
/// Wavelengths for which Table 3.1 states C4 [nm].
pub const C4_NM: RangeInclusive<f64> = 700.0..=1050.0;

/// Time within which pulses count as one, T_i for 400 to 1050 nm [s].
const ADDED_UP_S: f64 = 5e-6;
/// Exposure and number of pulses past which C5 lowers the limit of each [s], [1].
const C5_FROM_S: f64 = 0.25;
const C5_FROM_PULSES: f64 = 600.0;
/// The lowest C5 [1].
const LEAST_C5: f64 = 0.4;

/// Returns the accessible emission limit for a pulse or exposure of the given length: Table 3.1 [J].
///
/// C4 is a factor: the exponent -1 printed with it is the mark of the table's footnote, because only then does eq.
/// 3.3 yield 12.77 mW. Returns `None` outside the table (1e-13 to 10 s) and outside the range of C4 (700 to 1050 nm).
pub fn accessible_emission_limit_j(exposure_s: f64, wavelength_nm: f64) -> Option<f64> {
    let c4 = correction_c4(wavelength_nm)?;
    match exposure_s {
        t if (1e-13..1e-11).contains(&t) => Some(3.8e-8),
        t if (1e-11..5e-6).contains(&t) => Some(7.7e-8 * c4),
        t if (5e-6..=LONGEST_S).contains(&t) => Some(7e-4 * libm::pow(t, 0.75) * c4),
        _ => None,
    }
}

/// Returns the highest average power over an exposure: eq. 3.2 [W].
pub fn maximum_average_power_w(exposure_s: f64, wavelength_nm: f64) -> Option<f64> {
    Some(accessible_emission_limit_j(exposure_s, wavelength_nm)? / exposure_s)
}

/// Returns the longest exposure to an average power within Class 1: eq. 3.2 with the last row of Table 3.1, which
/// ends at 10 s [s].
///
/// Returns `None` if it would lie before that row, or if no limit is known.
pub fn longest_exposure_s(average_w: f64, wavelength_nm: f64) -> Option<f64> {
    let at_one_second_w = maximum_average_power_w(1.0, wavelength_nm)?;
    let longest_s = (at_one_second_w / average_w).powi(4).min(LONGEST_S);
    (longest_s >= 5e-6).then_some(longest_s)
}

/// An exposure of the eye to the laser, with the Class 1 limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposure {
    /// Duration [s].
    pub exposure_s: f64,
    /// Average power during the exposure [W].
    pub average_w: f64,
    /// Highest average power within Class 1; `None` if no limit is known [W].
    pub limit_w: Option<f64>,
}

impl Exposure {
    /// Creates an exposure of the given duration and average power.
    pub fn new(exposure_s: f64, average_w: f64, wavelength_nm: f64) -> Self {
        let limit_w = maximum_average_power_w(exposure_s, wavelength_nm);
        Exposure { exposure_s, average_w, limit_w }
    }

    /// Limit over average power: from 1 on it is Class 1 [1].
    pub fn margin(&self) -> Option<f64> {
        self.limit_w.map(|limit_w| limit_w / self.average_w)
    }

    /// Returns whether the exposure is within the limit, if one is known.
    pub fn is_within(&self) -> Option<bool> {
        self.limit_w.map(|limit_w| self.average_w <= limit_w)
    }
}

/// The pulses of an exposure, each by itself and as a train: IEC 60825-1:2014, 4.3 f.
///
/// Pulses that come within 5 us count as one with their energies added. The limit of each is that of a single one,
/// lowered by C5 for the number of them, in an exposure of more than 0.25 s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PulseTrain {
    /// Energy of a laser pulse [J].
    pub pulse_j: f64,
    /// Energy of the pulses that count as one [J].
    pub energy_j: f64,
    /// Pulses that count, in the exposure [1].
    pub count: f64,
    /// Limit of a single pulse; `None` if no limit is known [J].
    pub single_limit_j: Option<f64>,
    /// C5, by which the number of pulses lowers it [1].
    pub c5: f64,
}

impl PulseTrain {
    /// Creates the train of `pulses` of that energy and full width at half maximum, `period_s` apart, during an exposure.
    pub fn new(
        [pulse_j, width_s]: [f64; 2],
        [pulses, period_s, exposure_s]: [f64; 3],
        wavelength_nm: f64,
    ) -> Self {
        let together = (ADDED_UP_S / period_s).floor().max(1.0).min(pulses.max(1.0));
        let count = (pulses / together).ceil();
        let many = exposure_s > C5_FROM_S && count > C5_FROM_PULSES;
        PulseTrain {
            pulse_j,
            energy_j: pulse_j * together,
            count,
            // A pulse is timed no shorter than the table is.
            single_limit_j: accessible_emission_limit_j(width_s.max(1e-13), wavelength_nm),
            c5: if many { (5.0 * libm::pow(count, -0.25)).max(LEAST_C5) } else { 1.0 },
        }
    }

    /// Limit of what counts as one pulse; `None` if no limit is known [J].
    pub fn limit_j(&self) -> Option<f64> {
        self.single_limit_j.map(|limit_j| limit_j * self.c5)
    }

    /// Limit over energy: from 1 on it is Class 1 [1].
    pub fn margin(&self) -> Option<f64> {
        self.limit_j().map(|limit_j| limit_j / self.energy_j)
    }
}

/// Returns C4 of IEC 60825-1: 3.02 at 940 nm.
fn correction_c4(wavelength_nm: f64) -> Option<f64> {
    C4_NM.contains(&wavelength_nm).then(|| libm::pow(10.0, 0.002 * (wavelength_nm - 700.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rows_of_table_3_1() {
        let at_700 = |t| accessible_emission_limit_j(t, 700.0);
        assert_eq!(at_700(1e-12), Some(3.8e-8));
        assert_eq!(at_700(1e-9), Some(7.7e-8));
        assert_eq!(at_700(1.0), Some(7e-4));
        let at_940 = |t| accessible_emission_limit_j(t, 940.0).unwrap();
        assert_eq!(at_940(1e-12), 3.8e-8, "the first row is without C4");
        assert!((at_940(1e-9) / 7.7e-8 - 3.01995).abs() < 1e-5);
        assert!((at_940(1.0) / 7e-4 - 3.01995).abs() < 1e-5);
    }

    #[test]
    fn a_row_begins_where_the_one_before_ends() {
        let at_700 = |t| accessible_emission_limit_j(t, 700.0);
        assert_eq!(at_700(1e-13), Some(3.8e-8));
        assert_eq!(at_700(1e-11), Some(7.7e-8));
        assert!(at_700(5e-6).unwrap() < 7.5e-8, "the table steps down by 4 %");
        assert!(at_700(10.0).is_some());
    }

    #[test]
    fn a_power_is_within_up_to_the_exposure_where_it_is_the_limit() {
        for average_w in [3.82e-3, 20e-3] {
            let longest_s = longest_exposure_s(average_w, 940.0).unwrap();
            let limit_w = maximum_average_power_w(longest_s, 940.0).unwrap();
            assert!((limit_w / average_w - 1.0).abs() < 1e-9, "{longest_s}");
            let within = |part: f64| Exposure::new(part * longest_s, average_w, 940.0).is_within();
            assert_eq!((within(0.999), within(1.001)), (Some(true), Some(false)));
        }
        assert_eq!(longest_exposure_s(1e-6, 940.0), Some(LONGEST_S));
        assert_eq!(longest_exposure_s(0.0, 940.0), Some(LONGEST_S));
        assert_eq!(longest_exposure_s(1.0, 940.0), None, "0.02 ns");
        assert_eq!(longest_exposure_s(1e-3, 1100.0), None);
        assert_eq!(Exposure::new(11.0, 0.0, 940.0).is_within(), None);
    }

    #[test]
    fn pulses_within_five_microseconds_count_as_one_and_many_lower_the_limit() {
        let train = |period_s: f64, exposure_s: f64| {
            let pulses = exposure_s / period_s;
            PulseTrain::new([1e-9, 3e-10], [pulses, period_s, exposure_s], 940.0)
        };
        let slow = train(1e-3, 0.25);
        assert_eq!((slow.energy_j, slow.count, slow.c5), (1e-9, 250.0, 1.0));
        assert!((slow.limit_j().unwrap() - 232.5e-9).abs() < 1e-10, "{slow:?}");
        assert_eq!(train(1e-3, 0.5).c5, 1.0, "500 pulses");
        let middling = train(1e-3, 10.0);
        assert!((middling.c5 - 0.5).abs() < 1e-12, "5 / 10000^(1/4): {middling:?}");
        let fast = train(48e-9, 10.0);
        assert!((fast.energy_j - 104e-9).abs() < 1e-18, "{fast:?}");
        assert_eq!((fast.c5, fast.count.round()), (0.4, (10.0f64 / 48e-9 / 104.0).ceil()));
        assert!((fast.margin().unwrap() - 0.4 * 232.5 / 104.0).abs() < 1e-3);
        assert_eq!(train(48e-9, 1e-3).c5, 1.0, "a short exposure");
        assert_eq!(
            PulseTrain::new([1e-9, 0.0], [1.0, 1.0, 1.0], 940.0).single_limit_j,
            Some(3.8e-8)
        );
        assert_eq!(PulseTrain::new([1e-9, 1e-10], [1.0, 1.0, 1.0], 1550.0).margin(), None);
    }

    #[test]
    fn outside_the_table_there_is_no_limit_to_tell() {
        for exposure_s in [0.0, -1.0, 0.9e-13, 10.1, f64::NAN, f64::INFINITY] {
            assert_eq!(accessible_emission_limit_j(exposure_s, 940.0), None);
        }
        assert_eq!(maximum_average_power_w(1e-3, 699.0), None);
        assert_eq!(maximum_average_power_w(1e-3, 1051.0), None);
    }
}
