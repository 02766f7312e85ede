//! Histograms without an echo.

use rand::RngExt;
use rayon::prelude::*;

use tofsim::kernel::pulse::Pulse;
use tofsim::sensor::streams::{Source, stream};

use super::*;

fn says_no_echo(instruments: &[Instrument], number: u64) -> bool {
    let mut random = stream(24, Source::Histogram, number);
    let instrument = &instruments[random.random_range(0..instruments.len())];
    let mut scenario = instrument.setup.scenario.clone();
    scenario.ambient.irradiance_w_m2_nm = random.random();
    scenario.target.reflectance = random.random_range(0.03..0.95);
    let shots = (3000.0 * 20f64.powf(random.random())) as u64;
    let codes = BinProbabilities::new(
        &Hazard::dark(&Budget::new(&scenario, Pulse::default())),
        &instrument.bins,
    );
    let scene = Scene { instrument, shots, codes, bound_m: 0.0, signal: 0.0 };
    scene.look(&scene.draw(&mut random)).status.contains(Status::NoEcho)
}

#[test]
fn without_light_it_says_no_echo() {
    let load = |(chain, ps)| {
        let set = [format!("tdc.profile={chain}"), format!("laser.pulse_sigma_ps={ps}")];
        Instrument::load("kc705", &[&set[0], &set[1]])
    };
    let kinds = ["uniform", "table6_3", "ideal"]
        .into_iter()
        .flat_map(|chain| [80, 137, 200, 400].into_iter().map(move |ps| (chain, ps)));
    let instruments: Vec<_> = kinds.map(load).collect();
    let missing =
        (0..10_000).into_par_iter().filter(|&number| !says_no_echo(&instruments, number)).count();
    println!("{missing} of 10000 without `no echo`");
    assert!(missing <= 10, "{missing} of 10000");
}
