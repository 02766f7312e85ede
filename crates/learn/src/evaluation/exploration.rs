//! Accuracy against cost: one network in many datapaths, on the same histograms (thesis Fig. 6.16
//! and Table 6.4).

use std::sync::atomic::AtomicBool;

use serde::Serialize;

use tofsim::error::Result;
use tofsim::firmware::depth_estimator::datapath::Datapath;
use tofsim::kernel::WordFormat;
use tofsim::network::Network;

use crate::dataset::{HistogramSource, Rows};
use crate::estimation::Estimator;
use crate::estimation::network::{self, of_pass};
use crate::quantize::circuit::Circuit;
use crate::quantize::cost::Cost;

use super::errors::Evaluation;
use super::figures::Figures;
use super::spread::OUTLIER_M;

/// A datapath and what it does to the depth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExploredDatapath {
    /// Difference from the network's datapath.
    pub variant: String,
    /// Twice the standard deviation of the depth at each of the distances asked for [mm].
    pub two_sd_mm: Vec<Option<f64>>,
    /// Root mean square of fixed point less float, over all histograms [mm].
    pub rms_to_float_mm: f64,
    /// Largest magnitude of that [mm].
    pub largest_to_float_mm: f64,
    /// Weights that no word holds, and were saturated.
    pub saturated_weights: usize,
    /// Sums past the table, for each histogram [1].
    pub saturated_sums: f64,
    /// Bits that the sums of the hidden layer and of the depth can take, with sign.
    pub sum_bits: [u32; 2],
    /// Resources of the device.
    #[serde(flatten)]
    pub cost: Cost,
}

/// The datapaths that are swept: one thing at a time, around a network's own.
pub fn sweep(own: &Datapath) -> Vec<(String, Datapath)> {
    let own = *own;
    let mut points = vec![("the network's own".to_owned(), own)];
    for range_log2 in [2, 3] {
        for address_bits in 8..=14 {
            let range = 1 << range_log2;
            let name = format!("table of {address_bits} address bits over +-{range}");
            points.push((name, Datapath { address_bits, range_log2, ..own }));
        }
    }
    // A word that keeps its range has a fraction bit less for each bit less.
    let shorter = |format: WordFormat, width: u32| WordFormat {
        width,
        fraction: format.fraction + width - format.width,
    };
    for width in [10, 12, 14, 18] {
        let w1 = shorter(own.w1, width);
        let b1 = shorter(own.b1, width.min(16));
        points.push((format!("w1 and b1 of {width} bits"), Datapath { w1, b1, ..own }));
        let w2 = shorter(own.w2, width);
        let b2 = shorter(own.b2, width.min(16));
        points.push((format!("w2 and b2 of {width} bits"), Datapath { w2, b2, ..own }));
        let l1_out = shorter(own.l1_out, width);
        points.push((format!("activations of {width} bits"), Datapath { l1_out, ..own }));
    }
    points
}

/// Lets a network in each datapath see the rows, on all threads of the current pool, for figures at some of their
/// distances; the same for any number of threads.
///
/// # Errors
/// When a datapath makes no sense, or it is stopped.
pub fn explore(
    network: &Network,
    datapaths: &[(String, Datapath)],
    (source, rows, seed): (&HistogramSource, &Rows, u64),
    distances_m: &[f64],
    stop: Option<&AtomicBool>,
    done: impl FnMut(u64),
) -> Result<Vec<ExploredDatapath>> {
    let (float, size) = (network.twin(), source.size());
    let circuits = datapaths.iter().map(|(_, datapath)| Circuit::new(&float, datapath));
    let circuits = circuits.collect::<Result<Vec<_>>>()?;
    let mut estimators: Vec<Box<dyn Estimator + '_>> =
        vec![Box::new(network::float(network, &size))];
    estimators.extend(circuits.iter().map(|circuit| {
        Box::new(of_pass("variant", &size, |histogram| circuit.depth_m(histogram))) as _
    }));
    let evaluation = Evaluation::new(source, rows, seed, &estimators, stop, done)?;
    let exact = &evaluation.columns[0];
    let variants = circuits.iter().zip(&evaluation.columns[1..]);
    let points = datapaths.iter().zip(variants).map(|((name, datapath), (circuit, column))| {
        let figures = Figures::new(&evaluation, column, OUTLIER_M);
        let two_sd = |distance_m: &f64| figures.at(*distance_m)?.two_sd_mm;
        let pairs = exact.errors_m.iter().zip(&column.errors_m);
        let apart = pairs.filter_map(|(exact, fixed)| Some(1e3 * ((*fixed)? - (*exact)?)));
        let (sum, largest) =
            apart.fold((0.0, 0.0f64), |(sum, largest), mm| (sum + mm * mm, largest.max(mm.abs())));
        let histograms = column.errors_m.len().max(1) as f64;
        ExploredDatapath {
            variant: name.clone(),
            two_sd_mm: distances_m.iter().map(two_sd).collect(),
            rms_to_float_mm: f64::sqrt(sum / histograms),
            largest_to_float_mm: largest,
            saturated_weights: circuit.saturated_weights,
            saturated_sums: circuit.saturated_sums() as f64 / histograms,
            sum_bits: circuit.sum_bits(size.most_hits()),
            cost: Cost::of(datapath, network.fixed.neurons()),
        }
    });
    Ok(points.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::{Grid, Subset};
    use crate::evaluation::thesis::DISTANCES_M;
    use tofsim::scenario;
    use tofsim::sim::setup::Setup;

    #[test]
    fn an_address_bit_more_halves_the_error_until_the_weights_rounding_is_left() {
        let source =
            HistogramSource::new(&Setup::new(scenario::load("kc705", &[]).unwrap()).unwrap());
        let network = Network::builtin("uniform").unwrap().unwrap();
        let rows = Rows::Subset(Subset::new(Grid::test(), 510, 1));
        let data = (&source.unwrap(), &rows, 2);
        let points =
            explore(&network, &sweep(&network.datapath), data, &DISTANCES_M, None, |_| {}).unwrap();
        let rms = |variant: &str| {
            points.iter().find(|point| point.variant == variant).unwrap().rms_to_float_mm
        };
        for bits in 8..11 {
            let table = |bits| rms(&format!("table of {bits} address bits over +-4"));
            let ratio = table(bits) / table(bits + 1);
            assert!((1.6..2.4).contains(&ratio), "{bits}: {ratio}");
        }
        assert_eq!(points[0].cost, Cost { ramb36: 10, ramb18: 0, dsp48: 10 });
        assert_eq!(rms("the network's own"), rms("table of 12 address bits over +-4"));
        assert!(points[0].saturated_sums > 0.5 && points[0].sum_bits[0] <= 36);
        assert!(rms("w1 and b1 of 10 bits") > 3.0 * rms("w1 and b1 of 14 bits"));
    }
}
