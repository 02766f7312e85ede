use tofsim::firmware::tof_top::status::StatusSet;
use tofsim::scenario;
use tofsim::sim::image::{Expected, PixelFrame};

use super::*;

fn array(rows: usize, columns: usize) -> ArraySetup {
    let set = [format!("array.rows={rows}"), format!("array.columns={columns}")];
    ArraySetup::new(scenario::load("array", &set).unwrap()).unwrap()
}

/// A pixel with a true depth and its depths in some images, invalid ones as `None` [mm].
fn pixel(true_mm: f64, depths_mm: &[Option<f64>]) -> Pixel {
    let frame = |depth_mm: &Option<f64>| PixelFrame {
        radial_m: 1e-3 * depth_mm.unwrap_or(0.0),
        sigma_m: Some(0.002),
        valid: depth_mm.is_some(),
        status: StatusSet::default(),
        second: None,
        hits: 100,
    };
    let expected =
        Expected { radial_m: Some(1e-3 * true_mm), signal_hits: Some(true_mm), ambient_hits: None };
    Pixel { expected, frames: depths_mm.iter().map(frame).collect(), notes: Vec::new() }
}

fn near(figure: Figure, expected: f64) {
    assert!((figure.value.unwrap() - expected).abs() < 1e-9, "{figure:?} for {expected}");
}

#[test]
fn rates_are_those_of_each_image() {
    let array = array(1, 4);
    let pixels = vec![
        pixel(300.0, &[Some(300.0), Some(306.0)]),
        pixel(300.0, &[Some(500.0), Some(300.0)]),
        pixel(700.0, &[Some(700.0), None]),
        pixel(700.0, &[Some(500.0), None]),
    ];
    let images = Images::new(array, pixels, 0.1);
    near(images.fill_rate(), 0.75);
    assert_eq!(images.fill_rate().se, Some(0.25));
    // Of the two between the surfaces only one has a neighbour on the other surface.
    near(images.flying_rate(), 0.125);
    near(images.root_mse(), ((80_000.0 / 4.0 + 36.0 / 2.0) / 2.0f64).sqrt());
    near(images.median_sigma(), 2.0);
    near(images.expected(|pixel| pixel.expected.signal_hits), 500.0);
    assert_eq!(images.expected(|pixel| pixel.expected.ambient_hits), Figure::default());
}

#[test]
fn bias_and_spread_are_those_of_each_pixel() {
    let array = array(1, 3);
    let pixels = vec![
        pixel(300.0, &[Some(301.0), Some(303.0)]),
        pixel(400.0, &[Some(397.0), Some(399.0)]),
        pixel(500.0, &[Some(600.0), None]),
    ];
    let images = Images::new(array, pixels, 0.1);
    near(images.sd_by_pixel(), 2f64.sqrt());
    near(images.bias_by_pixel(), (4.0f64 - 2.0 / 2.0).sqrt());
    let squares = [
        (0.5f64.powi(2) + 1.5f64.powi(2) + 50f64.powi(2)) / 3.0,
        (1.5f64.powi(2) + 0.5f64.powi(2)) / 2.0,
    ];
    near(images.error_over_sigma(), ((squares[0] + squares[1]) / 2.0).sqrt());
}

#[test]
fn what_no_image_has_has_no_figure() {
    let array = array(1, 2);
    let pixels = vec![pixel(300.0, &[None]), pixel(300.0, &[None])];
    let images = Images::new(array, pixels, 0.1);
    near(images.fill_rate(), 0.0);
    for none in
        [images.flying_rate(), images.root_mse(), images.bias_by_pixel(), images.median_sigma()]
    {
        assert_eq!(none.value, None);
    }
}

#[test]
fn only_an_array_that_firmware_can_scan_has_a_rate() {
    let figures = [(40, 30), (41, 30)]
        .map(|(rows, columns)| Images::new(array(rows, columns), Vec::new(), 0.1).rate().value);
    assert!(figures[0].is_some_and(|rate| (17.3..17.4).contains(&rate)), "{figures:?}");
    assert_eq!(figures[1], None);
}
