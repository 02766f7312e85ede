//! The thesis's peak detection (section 5.1): spline, one peak, straight line through the shift.
//!
//! 1. Listing 5.1: a not-a-knot spline through the bins' centres, on 100 points from the first to
//!    the last. At 64 ps a step it is coarser than the bins: it thins the noise out, it does not
//!    average it.
//! 2. Listing 5.2: peaks with a prominence of 0.003 of the shots and at most as wide as the pulse, at
//!    half height. Success is exactly one.
//! 3. Listing 5.3 and eq. 5.1 and 5.2: depth = K_d c/2 location + B_d, which takes out the mean shift
//!    by pile-up, not its change with signal and background.
//!
//! The thesis takes every bin for 25 ps ([`PeakDetection::new`]). Where a chain's bins are two or
//! three taps wide, the counts go up and down with them, and half of the histograms have several peaks
//! (7,355 of 15,000 at 0.2 to 0.6 m, chain `uniform`). [`PeakDetection::of_bins`] puts every bin where
//! it is and scales its count to the width that codes count, and so fails about as often as on even bins.

use tofsim::firmware::histogram_builder::BINS;
use tofsim::optics::Bins;

use super::acquisition::{ARRIVAL_PS_PER_M, spans_ps};
use super::estimator::{Estimator, Failure, hits};
use super::findpeaks::{Criteria, Peak, findpeaks};
use super::spline::Spline;

/// Peak detection with its constants.
#[derive(Clone, Debug, PartialEq)]
pub struct PeakDetection {
    /// Shots of the histogram, TCSPC [shots].
    pub shots: u64,
    /// `MinPeakProminence` as a part of the shots (Table 5.1) [1].
    pub prominence: f64,
    /// `MaxPeakWidth` at half height, FWHM_LASER (section 6.3) [ps].
    pub max_width_ps: f64,
    /// Points of the curve, MATLAB's `linspace` [points].
    pub points: usize,
    /// K_d of eq. 5.2 [1].
    pub slope: f64,
    /// B_d of eq. 5.2 [m].
    pub offset_m: f64,
    /// The bins, in order of time.
    bins: Vec<Bin>,
}

/// A bin of the histogram.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bin {
    code: u16,
    /// Middle of the times that give the code [ps].
    centre_ps: f64,
    /// Factor from a count to that of a nominal bin [1].
    scale: f64,
}

/// The thesis's bins [ps].
const BIN_PS: f64 = 25.0;

impl PeakDetection {
    /// With the thesis's constants and its bins, 25 ps each.
    pub fn new(shots: u64) -> Self {
        let bin = |code: u16| Bin { code, centre_ps: (code as f64 + 0.5) * BIN_PS, scale: 1.0 };
        PeakDetection {
            shots,
            prominence: 0.003,
            max_width_ps: 2000.0,
            points: 100,
            slope: 0.9496,
            offset_m: 0.0338,
            bins: (0..BINS as u16).map(bin).collect(),
        }
    }

    /// With the thesis's constants and the bins of a chain; a code that no time gives is left out.
    pub fn of_bins(shots: u64, bins: &Bins) -> Self {
        // Of each code: how long it is given, and that times the middle.
        let mut sums = vec![[0.0; 2]; bins.count()];
        for (code, from_ps, until_ps) in spans_ps(bins) {
            let [width_ps, moment] = &mut sums[code as usize];
            *width_ps += until_ps - from_ps;
            *moment += (until_ps - from_ps) * (from_ps + until_ps) / 2.0;
        }
        let nominal_ps = bins.bin_ps();
        let bin = |(code, [width_ps, moment]): (u16, [f64; 2])| Bin {
            code,
            centre_ps: moment / width_ps,
            scale: nominal_ps / width_ps,
        };
        let given = (0..).zip(sums).filter(|(_, [width_ps, _])| *width_ps > 0.0);
        let mut bins: Vec<_> = given.map(bin).collect();
        bins.sort_by(|a, b| a.centre_ps.total_cmp(&b.centre_ps));
        bins.dedup_by_key(|bin| bin.centre_ps);
        PeakDetection { bins, ..PeakDetection::new(shots) }
    }

    /// Listing 5.1: abscissas [ps] and ordinates [hits] of the smoothed curve. `counts` are by code
    /// and may be negative; `None` for less than two bins, or counts that are not finite.
    pub fn curve(&self, counts: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
        let centres: Vec<_> = self.bins.iter().map(|bin| bin.centre_ps).collect();
        let counts = self.bins.iter().map(|bin| counts[bin.code as usize] * bin.scale);
        let spline = Spline::new(&centres, &counts.collect::<Vec<_>>())?;
        let (first, last) = (centres[0], centres[centres.len() - 1]);
        let steps = self.points.saturating_sub(1);
        let step = (last - first) / steps.max(1) as f64;
        let place = |k| if k == steps { last } else { first + k as f64 * step };
        let x: Vec<_> = (0..self.points).map(place).collect();
        let y = x.iter().map(|&x| spline.at(x)).collect();
        Some((x, y))
    }

    /// Listing 5.2: the peaks of a histogram; locations and widths are in ps.
    pub fn peaks(&self, counts: &[f64]) -> Vec<Peak> {
        let (x, y) = self.curve(counts).unwrap_or_default();
        let min_prominence = self.prominence * self.shots as f64;
        findpeaks(&x, &y, &Criteria { min_prominence, max_width: self.max_width_ps })
    }

    /// Eq. 5.1 and 5.2: distance of a peak at `location_ps` [m].
    pub fn distance_m(&self, location_ps: f64) -> f64 {
        self.slope * location_ps / ARRIVAL_PS_PER_M + self.offset_m
    }

    /// Distance of the only peak [m].
    ///
    /// # Errors
    /// When there is not exactly one.
    pub fn detect(&self, counts: &[f64]) -> Result<f64, Failure> {
        match self.peaks(counts)[..] {
            [] => Err(Failure::NoPeak),
            [peak] => Ok(self.distance_m(peak.location)),
            ref peaks => Err(Failure::SeveralPeaks(peaks.len())),
        }
    }
}

impl Estimator for PeakDetection {
    fn name(&self) -> &'static str {
        "peak"
    }

    fn estimate(&self, histogram: &[u32]) -> Result<f64, Failure> {
        hits(histogram, u32::MAX)?;
        let counts: Vec<_> = histogram.iter().copied().map(f64::from).collect();
        self.detect(&counts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::firmware::carry_chain::{Delays, TAPS};
    use tofsim::firmware::tdc;
    use tofsim::kernel::Time;

    #[test]
    fn bins_of_a_chain_are_scaled_to_25_ps() {
        let delays = Delays::new(Time::from_fs(2_230_000), &[11_500; TAPS]).unwrap();
        let bins = Bins::of_tdc(&tdc::Params::of_chain(delays));
        let mut counts = [0.0; 256];
        for span in bins.spans() {
            counts[span.code as usize] += (span.until - span.from).fs() as f64 * 1e-3;
        }
        let swing = |detection: &PeakDetection| {
            let (_, y) = detection.curve(&counts).unwrap();
            y.iter().fold(0.0f64, |most, y| most.max((y - 25.0).abs()))
        };
        assert!(swing(&PeakDetection::of_bins(30_000, &bins)) < 1e-9);
        assert!(swing(&PeakDetection::new(30_000)) > 5.0);
    }

    #[test]
    fn codes_that_no_time_gives_are_left_out() {
        let delays = Delays::new(Time::from_fs(2_000_000), &[40_000; TAPS]).unwrap();
        let bins = Bins::of_tdc(&tdc::Params::of_chain(delays));
        let detection = PeakDetection::of_bins(30_000, &bins);
        assert!(detection.bins.len() < 256);
        assert!(detection.bins.windows(2).all(|pair| pair[0].centre_ps < pair[1].centre_ps));
        assert!(detection.curve(&[1.0; 256]).is_some());
    }

    /// A triangle of `height` around `centre`, 6 bins to either side, on `floor`.
    fn triangle(centre: usize, height: u32, floor: u32) -> Vec<u32> {
        let count = |bin: usize| {
            let part = 12u32.saturating_sub(2 * bin.abs_diff(centre) as u32);
            floor + height / 12 * part
        };
        (0..256).map(count).collect()
    }

    #[test]
    fn the_curve_runs_from_the_first_centre_to_the_last() {
        let (x, y) = PeakDetection::new(30_000).curve(&[1.0; 256]).unwrap();
        assert_eq!((x.len(), x[0], x[99]), (100, 12.5, 6387.5));
        assert!((x[50] - x[49] - 6375.0 / 99.0).abs() < 1e-9);
        assert!(y.iter().all(|y| (y - 1.0).abs() < 1e-12));
    }

    #[test]
    fn one_peak_is_a_distance_within_half_a_step() {
        let detection = PeakDetection::new(30_000);
        let distance_m = detection.estimate(&triangle(120, 600, 5)).unwrap();
        let expected_m = 0.9496 * 120.5 * 25e-12 * 299_792_458.0 / 2.0 + 0.0338;
        assert!((distance_m - expected_m).abs() < 0.005, "{distance_m} {expected_m}");
    }

    #[test]
    fn none_and_several_are_failures() {
        let detection = PeakDetection::new(30_000);
        assert_eq!(detection.estimate(&[0; 256]), Err(Failure::NoHits));
        assert_eq!(detection.estimate(&[100; 256]), Err(Failure::NoPeak));
        assert_eq!(detection.estimate(&triangle(120, 84, 5)), Err(Failure::NoPeak));
        let mut two = triangle(60, 600, 5);
        two.iter_mut().zip(triangle(180, 600, 0)).for_each(|(a, b)| *a += b);
        assert_eq!(detection.estimate(&two), Err(Failure::SeveralPeaks(2)));
        assert_eq!(
            PeakDetection { points: 0, ..detection.clone() }.estimate(&two),
            Err(Failure::NoPeak)
        );
    }

    #[test]
    fn a_peak_wider_than_the_pulse_is_none() {
        let hump = |bin| 1000 - (f64::from(bin) - 128.0).powi(2) as u32 / 17;
        let hump: Vec<_> = (0..256).map(hump).collect();
        let detection = PeakDetection::new(30_000);
        assert_eq!(detection.estimate(&hump), Err(Failure::NoPeak));
        let lenient = PeakDetection { max_width_ps: 1e4, ..detection };
        assert!(lenient.estimate(&hump).is_ok());
    }
}
