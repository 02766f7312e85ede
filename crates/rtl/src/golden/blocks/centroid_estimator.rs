//! Whole estimations of 32 histograms, which the bench reads out as the histogram builder would:
//! empty, level, full, all hits in one bin at either end or next to it, equal maxima, random and as
//! measured; starts while busy, and a reset in each part.

use tofsim::firmware::centroid_estimator::In;
use tofsim::sim::estimates::centroid::locate;

use crate::golden::estimations::{Estimations, memory};
use crate::golden::configuration;
use crate::golden::prelude::*;

mod histograms;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[Latency { from: "algo_start", to: "algo_done", cycles: |vectors| vectors.sizes.centroid_cycles.into() }],
    glue: Some(histograms::GLUE),
    configurations: &[LEVEL],
    model: Some(Model::new::<In>(|at| {
        at.top.centroid_estimator.rise(&at.input(), &at.params.estimators.centroid_estimator);
    })),
    ..Spec::new("centroid_estimator", "centroid_estimator", record)
};

/// The whole window counted, and a distance taken off.
pub(super) const LEVEL: Configuration = Configuration {
    name: "level",
    set: &[
        "estimator.kind=centroid",
        "estimator.centroid_half_width=9",
        "estimator.centroid_background=false",
        "estimator.centroid_offset_m=-0.1",
    ],
    parameters: &["HalfWidth", "Background", "Offset"],
    ..configuration::DEFAULTS
};

signals! {
    /// Input ports, and what the bench reads `count` from.
    struct Stimulus {
        /// Synchronous reset.
        rst: bool,
        /// Starts an estimation.
        algo_start: bool,
        /// Number of the histogram in the memory.
        histogram: U<5>,
    }
}

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let params = *setting.setup.params.estimators.centroid_estimator;
    let histograms = histograms::new(&params, &mut Draw::new(setting.seed, MEMORIES));
    // Words, no words, quotient, position and depth.
    let (bins, done) = (params.histogram.bins as u64, params.done());
    let (divide, place) = (params.divide(), params.place());
    let parts = [0..bins, bins..divide, divide..place, place..done];
    let all = histograms.len();
    let mut estimations = Estimations::new(parts, all, all as u64, setting);
    let reachable = histograms::reachable(&params).into_iter().zip(0..).filter(|(is, _)| *is);
    let mut cases = Cover::new(histograms::CASES, reachable.map(|(_, case)| case));
    let mut run = Recorder::new(spec, setting, Stimulus::list());
    for _ in 0..setting.cycles() {
        let phase = run.top.centroid_estimator.registers.phase(&params);
        if phase == Some(done) {
            let words = histograms[estimations.histogram as usize].iter();
            let words: Vec<_> = words.map(|count| count.get() as u32).collect();
            let met = histograms::cases(&params, &words, &locate(&params, &words));
            met.into_iter().zip(0..).for_each(|(met, case)| cases.see_if(met, case));
        }
        let (rst, algo_start) = estimations.next(phase, &mut run.draw);
        let i = Stimulus { rst, algo_start, histogram: U::new(estimations.histogram) };
        run.line(&i);
        let estimator = &mut run.top.centroid_estimator;
        let count = histograms[i.histogram.index()][estimator.registers.read_addr.index()];
        estimator.rise(&In { rst, algo_start, count }, &params);
    }
    Ok(Vectors {
        bench_memory: Some(memory(&histograms, &params.histogram)),
        ..run
            .vectors([vec![cases], estimations.coverage().into()].concat())
            .with(parameters::centroid_estimator(&params))
    })
}
