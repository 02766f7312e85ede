use proptest::prelude::*;

use super::*;

const ANY: Criteria = Criteria { min_prominence: 0.0, max_width: f64::INFINITY };

fn peaks(y: &[f64], criteria: Criteria) -> Vec<Peak> {
    let x: Vec<_> = (0..y.len()).map(|k| k as f64).collect();
    findpeaks(&x, y, &criteria)
}

/// Index, width and prominence of each peak.
fn table(y: &[f64]) -> Vec<(usize, f64, f64)> {
    peaks(y, ANY).iter().map(|peak| (peak.index, peak.width, peak.prominence)).collect()
}

#[test]
fn a_triangle_is_half_as_wide_at_half_its_height() {
    assert_eq!(table(&[0.0, 1.0, 2.0, 3.0, 4.0, 2.0, 0.0]), [(4, 3.0, 4.0)]);
}

#[test]
fn a_plateau_is_a_peak_at_its_first_sample() {
    assert_eq!(table(&[0.0, 2.0, 2.0, 2.0, 0.0]), [(1, 3.0, 2.0)]);
    assert_eq!(table(&[0.0, 2.0, 2.0, 3.0, 0.0])[0].0, 3, "a step is none");
}

#[test]
fn the_ends_are_no_peaks_whatever_their_height() {
    assert_eq!(table(&[5.0, 1.0, 3.0, 1.0, 9.0]), [(2, 4.0 / 3.0 + 1.0 / 6.0, 2.0)]);
    assert_eq!(table(&[3.0, 2.0, 1.0]), []);
    assert_eq!(table(&[3.0, 3.0, 3.0]), []);
    assert_eq!(table(&[1.0, 2.0, 2.0]), []);
    assert_eq!(table(&[]), []);
    assert_eq!(table(&[1.0]), []);
}

#[test]
fn equal_peaks_have_their_full_prominence_and_part_at_the_valley_between() {
    let found = table(&[0.0, 4.0, 3.0, 4.0, 0.0]);
    assert_eq!(found, [(1, 1.5, 4.0), (3, 1.5, 4.0)]);
}

#[test]
fn the_prominence_is_above_the_higher_valley() {
    let found = table(&[0.0, 10.0, 2.0, 6.0, 5.0, 7.0, 1.0]);
    let prominences: Vec<_> = found.iter().map(|peak| (peak.0, peak.2)).collect();
    assert_eq!(prominences, [(1, 9.0), (3, 1.0), (5, 5.0)]);
}

#[test]
fn only_prominent_peaks_border_one_another() {
    let y = [0.0, 8.0, 7.0, 7.5, 6.0, 5.0, 0.0];
    let found = table(&y);
    assert_eq!(found[0].1, 1.5, "from 0.5 to the valley at 2");
    let prominent = peaks(&y, Criteria { min_prominence: 1.0, ..ANY });
    assert_eq!(prominent.len(), 1);
    assert_eq!(prominent[0].width, 5.2 - 0.5);
}

#[test]
fn a_border_is_the_deeper_of_the_neighbours_valleys() {
    let found = table(&[0.0, 9.0, 5.0, 6.0, 5.5, 10.0, 0.0]);
    let widths: Vec<_> = found.iter().map(|peak| peak.1).collect();
    assert_eq!(widths, [2.0 - 0.5, 2.0, 5.5 - 4.0]);
}

#[test]
fn criteria_hold_at_their_very_value() {
    let y = [0.0, 1.0, 2.0, 3.0, 4.0, 2.0, 0.0];
    let with = |min_prominence, max_width| peaks(&y, Criteria { min_prominence, max_width }).len();
    assert_eq!([with(4.0, 3.0), with(4.001, 3.0), with(4.0, 2.999)], [1, 0, 0]);
}

#[test]
fn peaks_below_zero_are_dropped() {
    assert_eq!(table(&[-5.0, -1.0, -5.0, -3.0, 2.0, -3.0]).len(), 1);
}

#[test]
fn the_noise_of_a_slope_is_not_prominent() {
    let y: Vec<_> = (0..100).map(|k| 500.0 - 4.0 * k as f64 + [0.0, 9.0, -7.0][k % 3]).collect();
    assert!(peaks(&y, ANY).len() > 20);
    assert_eq!(peaks(&y, Criteria { min_prominence: 90.0, ..ANY }), []);
}

proptest! {
    #[test]
    fn any_curve_has_its_highest_inner_peak_and_sound_widths(
        y in prop::collection::vec(-3i8..4, 0..40),
    ) {
        let y: Vec<_> = y.into_iter().map(f64::from).collect();
        for peak in peaks(&y, ANY) {
            prop_assert!(peak.prominence > 0.0);
            prop_assert!(peak.width >= 0.0 && peak.width <= y.len() as f64);
            prop_assert_eq!(peak.height, y[peak.index]);
            prop_assert!(y[peak.index - 1] < peak.height && y[peak.index + 1] <= peak.height);
        }
    }
}
