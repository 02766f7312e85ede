//! An estimator of one's own beside the built-in ones: on the frames of a run, and evaluated over the
//! test grid.

use tofsim::error::Result;
use tofsim::scenario;
use tofsim::sim::Run;
use tofsim::sim::frames::Frame;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;
use tofsim_learn::dataset::{Grid, HistogramSource, Rows, Subset};
use tofsim_learn::estimation::{Estimator, EstimatorKind, Failure, Panel, acquisition};
use tofsim_learn::evaluation::{Evaluation, Figures};

/// The mean time of all hits: simple, and drawn towards the middle by ambient light.
struct CentreOfGravity {
    /// Width of a bin [ps].
    bin_ps: f64,
}

impl Estimator for CentreOfGravity {
    fn name(&self) -> &'static str {
        "gravity"
    }

    fn estimate(&self, histogram: &[u32]) -> std::result::Result<f64, Failure> {
        let hits: f64 = histogram.iter().copied().map(f64::from).sum();
        if hits == 0.0 {
            return Err(Failure::NoHits);
        }
        let weighed = histogram.iter().enumerate().map(|(k, &n)| (k as f64 + 0.5) * f64::from(n));
        let mean_ps = weighed.sum::<f64>() / hits * self.bin_ps;
        Ok(mean_ps / acquisition::ARRIVAL_PS_PER_M)
    }
}

fn main() -> Result<()> {
    let dark_room = ["ambient.irradiance_w_m2_nm=0".to_owned()];
    let setup = Setup::new(scenario::load("kc705", &dark_room)?)?;

    let mut panel = Panel::new(&[EstimatorKind::Network, EstimatorKind::Matched], &setup)?;
    panel.add(Box::new(CentreOfGravity { bin_ps: setup.scenario.tdc.bin_ps }));
    let mut show = |frame: &Frame| {
        for reading in panel.read(&frame.histogram) {
            println!("frame {}  {:<8} {:.4?} m", frame.index, reading.estimator, reading.depth_m);
        }
        Ok(())
    };
    Run::new(&setup).observe(2, Observers { frames: Some(&mut show), ..Observers::default() })?;

    let source = HistogramSource::new(&setup)?;
    let rows = Rows::Subset(Subset::new(Grid::test(), 1020, 1));
    let estimators = panel.into_estimators();
    let evaluation = Evaluation::new(&source, &rows, 1, &estimators, None, |_| ())?;
    println!("\nestimator  mean error [mm]  2σ [mm]  failures");
    for errors in &evaluation.columns {
        let all = Figures::new(&evaluation, errors, 0.1).all;
        let [mean, two_sd] = [all.mean_mm, all.two_sd_mm].map(Option::unwrap_or_default);
        println!("{:<9}  {mean:15.2}  {two_sd:9.2}  {:8}", errors.name, all.failures);
    }
    Ok(())
}
