//! The calibration in the firmware beside the one that is made offline of the same counts, and beside the chain's own
//! delays.

use tofsim::Setup;
use tofsim::firmware::tdc_calibration::State;
use tofsim::firmware::tdc_decoder::Params;
use tofsim::sim::device::Off;
use tofsim_learn::characterisation::rom::{CalibratedRom, RomEntry};

/// Counts of a calibration by `n`, and the ages that the firmware computed [units].
struct Calibrated {
    setup: Setup,
    counts: Vec<u64>,
    ages: Vec<u64>,
}

impl Calibrated {
    /// The first calibration of a run.
    fn new(keys: &[&str]) -> Self {
        let keys: Vec<_> = keys.iter().copied().chain(["tdc.recalibrate_frames=1"]).collect();
        let setup = Setup::load("kc705", &keys).unwrap();
        let (mut device, p) = (setup.device(), setup.params.tdc_calibration.clone().unwrap());
        let mut counts = vec![0; p.taps + 1];
        device.power_up(&mut Off, &mut Off);
        let mut began = false;
        loop {
            let block = &device.top.tdc_calibration;
            if began && block.state() == State::Idle {
                break;
            }
            began |= block.state() != State::Idle;
            if block.state() == State::Count && block.progress().1 < p.hits() {
                let hit = device.top.tdc.tdc_decoder.counted();
                hit.into_iter().for_each(|(n, _)| counts[n as usize] += 1);
            }
            device.step(&setup.params, &mut Off, &mut Off);
        }
        assert_eq!(counts.iter().sum::<u64>(), p.hits());
        let ages = device.top.tdc_calibration.ram.iter().map(|age| age.get()).collect();
        Calibrated { setup, counts, ages }
    }

    /// The same offline.
    fn offline(&self) -> Vec<RomEntry> {
        CalibratedRom::new("counts", &self.counts, &self.setup.params.tdc).unwrap().entries
    }

    /// How far the ages of those `n` that hits came to are off the chain's own [ps], rms and in standard errors at
    /// most; a unit of rounding is nothing. The last one's ages end with the period, and not with its tap.
    fn error(&self) -> (f64, f64) {
        let decoder = &self.setup.params.tdc.decoder;
        let (delays, scale) = (&self.setup.params.tdc.delays, &decoder.scale);
        let own = Params::calibration(delays, decoder.encoder.decoder(), scale);
        let last = self.counts.iter().rposition(|count| *count > 0);
        let hit = self.offline().into_iter();
        let hit = hit.filter(|entry| entry.count > 0 && Some(entry.n) != last);
        let unit_ps = scale.ps(1) - scale.ps(0);
        let errors: Vec<_> = hit
            .map(|entry| {
                let off_ps = (self.ages[entry.n] as f64 - own[entry.n].get() as f64) * unit_ps;
                (off_ps, (off_ps.abs() - unit_ps).max(0.0) / entry.age_se_ps)
            })
            .collect();
        let square = errors.iter().map(|(ps, _)| ps * ps).sum::<f64>() / errors.len() as f64;
        (square.sqrt(), errors.iter().map(|(_, parts)| *parts).fold(0.0, f64::max))
    }
}

#[test]
fn in_the_firmware_and_offline_the_same_counts_come_to_the_same_words() {
    for keys in [
        &["tdc.profile=kintex7"][..],
        &["tdc.profile=kintex7", "tdc.decoder=leading", "tdc.calibration_hits_log2=12"],
        &["tdc.profile=ecp5", "tdc.ring_ns=97.3", "tdc.calibration_hits_log2=10"],
        &["tdc.bin_ps=43", "tdc.first_bin_ps=700", "tdc.calibration_hits_log2=11"],
    ] {
        let found = Calibrated::new(keys);
        let offline: Vec<_> = found.offline().iter().map(|entry| entry.units).collect();
        assert_eq!(found.ages, offline, "{keys:?}");
    }
}

#[test]
fn the_ages_are_those_of_the_chain_within_the_counting_error() {
    for keys in [
        &["tdc.profile=kintex7"][..],
        &["tdc.profile=kintex7", "tdc.decoder=reordered"],
        &["tdc.profile=ecp5", "tdc.ring_ns=97.3"],
        &["tdc.profile=table6_3"],
    ] {
        let (rms_ps, most) = Calibrated::new(keys).error();
        println!("{keys:?}: {rms_ps:.2} ps rms, {most:.2} standard errors at most");
        assert!(most < 5.0 && rms_ps < 12.0, "{keys:?}: {rms_ps} ps, {most}");
    }
}

#[test]
fn a_calibration_follows_the_temperature() {
    let keys = ["tdc.profile=kintex7", "tdc.temperature_c=65"];
    let (rms_ps, most) = Calibrated::new(&keys).error();
    assert!(most < 5.0, "{rms_ps} ps, {most}");
    // The ROM of 25 degrees is 4 % of up to 10 ns off.
    let stale = Setup::load("kc705", &[keys[0], keys[1], "tdc.calibrated_at_c=25"]).unwrap();
    let now = Setup::load("kc705", &keys).unwrap();
    let cal = |setup: &Setup| setup.params.tdc.decoder.cal.clone();
    let far =
        cal(&stale).iter().zip(cal(&now)).map(|(then, now)| now.get().abs_diff(then.get())).max();
    assert!(far.unwrap() as f64 * 1.5625 > 10.0 * rms_ps, "{far:?} units");
}
