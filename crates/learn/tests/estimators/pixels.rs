//! The depths of an array's pixels against each pixel's own Cramér-Rao bound.

use tofsim::scenario::{self, DEFAULT};
use tofsim::sim::image::ImageFidelity;
use tofsim::sim::setup::array::ArraySetup;
use tofsim_learn::estimation::Acquisition;
use tofsim_learn::estimation::likelihood::Model;

/// A wall before an array, with 500 hits of laser photons in each pixel at least.
const WALL: [&str; 9] = [
    "array.rows=8",
    "array.columns=6",
    "target.width_m=2",
    "target.length_m=2",
    "target.reflectance=0.5",
    "ambient.irradiance_w_m2_nm=0.01",
    "laser.average_power_w=0.0023",
    "lens.area_m2=9.5e-4",
    "estimator.kind=likelihood",
];

#[test]
fn pixels_reach_their_own_bounds_and_state_standard_deviations_that_hold() {
    let set = WALL.map(str::to_owned);
    let array = ArraySetup::new(scenario::load(DEFAULT, &set).unwrap()).unwrap();
    let pixels = array.images(ImageFidelity::Histograms, 100, None, &|_| ()).unwrap();
    let (mut over_bound, mut over_sigma, mut count) = (0.0, 0.0, 0);
    for (place, pixel) in pixels.iter().enumerate() {
        let setup = array.pixel(place / 6, place % 6);
        let bins = setup.bins();
        let acquisition = Acquisition::of(&setup, &bins, setup.shots(1));
        let bound_m = Model::new(&acquisition).unwrap().cramer_rao_m(&(&setup.budget).into());
        let true_m = pixel.expected.radial_m.unwrap();
        assert!(pixel.expected.signal_hits.unwrap() > 500.0, "{place}: {:?}", pixel.expected);
        for frame in pixel.frames.iter().filter(|frame| frame.valid) {
            let error_m = frame.radial_m - true_m;
            over_bound += (error_m / bound_m.unwrap()).powi(2);
            over_sigma += (error_m / frame.sigma_m.unwrap()).powi(2);
            count += 1;
        }
    }
    let [bound, sigma] = [over_bound, over_sigma].map(|sum| (sum / f64::from(count)).sqrt());
    println!("{count} depths: rms error {bound:.3} of the bound, {sigma:.3} of sigma");
    // A ratio of 4,800 depths has a standard error of 1 %.
    assert!(count > 4_750 && (0.95..1.1).contains(&bound) && (0.9..1.1).contains(&sigma));
}
