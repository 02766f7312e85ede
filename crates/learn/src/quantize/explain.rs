//! Origin of a depth and cost of fixed point: every value of the datapath beside its double-precision counterpart.
//!
//! The float pass uses the weights before rounding. Fixed point differs from it in four steps, and the depth after
//! each of them gives an [`ErrorBudget`] whose parts add up to the whole difference: rounding of the hidden layer's
//! weights and biases, of the address of the activation, of the entry of the table, and of the output layer's weights
//! and bias.

use serde::Serialize;

use tofsim::firmware::depth_estimator::datapath::{DEPTH_FRACTION, Datapath};
use tofsim::network::Network;
use tofsim::network::float::Float;
use tofsim::network::pass::HiddenNeuron;

use super::circuit::Circuit;

/// A value of the datapath and its twin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WordAndTwin {
    /// The word as an integer.
    pub word: i64,
    /// Value of the word.
    pub fixed: f64,
    /// The same in double precision.
    pub float: f64,
    /// Fixed less float, in units of the word's last bit.
    pub difference_lsb: f64,
    /// First-order effect of the difference alone on the depth [mm].
    pub difference_mm: f64,
}

impl WordAndTwin {
    fn new(word: i64, fraction: u32, float: f64, metres_per_unit: f64) -> Self {
        let lsb = (-f64::from(fraction)).exp2();
        let fixed = word as f64 * lsb;
        let difference = fixed - float;
        WordAndTwin {
            word,
            fixed,
            float,
            difference_lsb: difference / lsb,
            difference_mm: 1e3 * difference * metres_per_unit,
        }
    }

    /// Whether the word is not the one nearest to its twin.
    pub fn parts(&self) -> bool {
        self.difference_lsb.abs() > 0.5
    }
}

/// A hidden neuron.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ExplainedNeuron {
    /// Sum of the products and the bias.
    pub l1_in: WordAndTwin,
    /// Address in the table of activations.
    pub address: i64,
    /// The sum lies past the table, and has its last entry.
    pub saturated: bool,
    /// Activation.
    pub l1_out: WordAndTwin,
    /// Product with the weight of the output layer [m].
    pub product: WordAndTwin,
}

/// Contribution of each rounding to the depth; their sum is the whole difference [mm].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorBudget {
    /// W1 and B1 are rounded to their words.
    pub hidden_weights_mm: f64,
    /// The sum is rounded to an address of the table, or saturated.
    pub address_mm: f64,
    /// The entries of the table are rounded.
    pub table_mm: f64,
    /// W2 and B2 are rounded.
    pub output_weights_mm: f64,
    /// Fixed point less float.
    pub total_mm: f64,
}

/// Everything about one estimation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    /// Hits in the histogram.
    pub hits: u64,
    /// The hidden layer.
    pub neurons: Vec<ExplainedNeuron>,
    /// Bias of the output layer [m].
    pub bias: WordAndTwin,
    /// The depth [m].
    pub depth: WordAndTwin,
    /// First words that are not the nearest to their counterparts: `l1_in`, `l1_out`, `product` or `depth`, if there
    /// are any, and of which neuron.
    pub first_parting: Option<(&'static str, Option<usize>)>,
    /// Neurons whose sum lies past the table of activations.
    pub saturated: usize,
    /// Sources of the difference.
    pub budget: ErrorBudget,
}

/// Explains the estimation of a histogram.
pub fn explain(network: &Network, histogram: &[u32]) -> Explanation {
    let datapath = &network.datapath;
    let (circuit, float) = (Circuit::of_words(&network.fixed, datapath), network.twin());
    let (mut fixed, mut exact) = (Vec::new(), Vec::new());
    let word = circuit.depth(histogram, |neuron| fixed.push(neuron));
    let depth_m = float.pass(histogram, libm::tanh, |neuron| exact.push(neuron));
    let neuron = |((fixed, exact), &w2): ((HiddenNeuron<i64>, HiddenNeuron<f64>), &f64)| {
        let slope = w2 * (1.0 - exact.activation * exact.activation);
        let (address, saturated) = circuit.address(fixed.sum);
        ExplainedNeuron {
            l1_in: WordAndTwin::new(fixed.sum, datapath.w1.fraction, exact.sum, slope),
            address,
            saturated,
            l1_out: WordAndTwin::new(
                fixed.activation,
                datapath.l1_out.fraction,
                exact.activation,
                w2,
            ),
            product: WordAndTwin::new(fixed.product, datapath.term_fraction(), exact.product, 1.0),
        }
    };
    let neurons: Vec<_> = fixed.into_iter().zip(exact).zip(&float.w2).map(neuron).collect();
    let depth = WordAndTwin::new(word, DEPTH_FRACTION, depth_m, 1.0);
    Explanation {
        hits: histogram.iter().map(|&count| u64::from(count)).sum(),
        bias: WordAndTwin::new(network.fixed.b2.into(), datapath.b2.fraction, float.b2, 1.0),
        first_parting: first_parting(&neurons, &depth),
        saturated: neurons.iter().filter(|neuron| neuron.saturated).count(),
        budget: budget(&float, datapath, &neurons, &depth),
        neurons,
        depth,
    }
}

fn first_parting(
    neurons: &[ExplainedNeuron],
    depth: &WordAndTwin,
) -> Option<(&'static str, Option<usize>)> {
    let layer = |name, parts: &dyn Fn(&ExplainedNeuron) -> bool| {
        neurons.iter().position(parts).map(|neuron| (name, Some(neuron)))
    };
    layer("l1_in", &|neuron| neuron.l1_in.parts())
        .or_else(|| layer("l1_out", &|neuron| neuron.l1_out.parts()))
        .or_else(|| layer("product", &|neuron| neuron.product.parts()))
        .or_else(|| depth.parts().then_some(("depth", None)))
}

/// The depth after each step from float to fixed point.
fn budget(
    float: &Float,
    datapath: &Datapath,
    neurons: &[ExplainedNeuron],
    depth: &WordAndTwin,
) -> ErrorBudget {
    let output = |activation: &dyn Fn(&ExplainedNeuron) -> f64| {
        let products = neurons.iter().zip(&float.w2).map(|(neuron, w2)| activation(neuron) * w2);
        products.sum::<f64>() + float.b2
    };
    let steps = [
        depth.float,
        output(&|neuron| libm::tanh(neuron.l1_in.fixed)),
        output(&|neuron| libm::tanh(neuron.address as f64 * datapath.step())),
        output(&|neuron| neuron.l1_out.fixed),
        depth.fixed,
    ];
    let [hidden_weights_mm, address_mm, table_mm, output_weights_mm] =
        std::array::from_fn(|step| 1e3 * (steps[step + 1] - steps[step]));
    let total_mm = 1e3 * (depth.fixed - depth.float);
    ErrorBudget { hidden_weights_mm, address_mm, table_mm, output_weights_mm, total_mm }
}

#[cfg(test)]
mod tests {
    use tofsim::network::unrounded::Unrounded;

    use super::*;

    fn peak(bin: usize, height: u32) -> Vec<u32> {
        (0..256).map(|k: usize| height / (1 + 2 * k.abs_diff(bin) as u32)).collect()
    }

    #[test]
    fn the_parts_of_the_budget_add_up_to_the_difference() {
        let network = Network::builtin("uniform").unwrap().unwrap();
        for bin in [30, 80, 130, 180, 230] {
            let explained = explain(&network, &peak(bin, 3000));
            let budget = explained.budget;
            let parts = [
                budget.hidden_weights_mm,
                budget.address_mm,
                budget.table_mm,
                budget.output_weights_mm,
            ];
            assert!((parts.iter().sum::<f64>() - budget.total_mm).abs() < 1e-9);
            assert_eq!(budget.total_mm, explained.depth.difference_mm);
            let products: i64 = explained.neurons.iter().map(|n| n.product.word).sum();
            assert_eq!(
                products + (explained.bias.word << network.datapath.output_bias_shift()),
                explained.depth.word
            );
        }
    }

    #[test]
    fn weights_that_are_words_part_at_the_activation_only() {
        let mut network = Network::builtin("uniform").unwrap().unwrap();
        network.float = Unrounded::Unknown;
        let explained = explain(&network, &peak(100, 2000));
        assert!(explained.neurons.iter().all(|neuron| neuron.l1_in.difference_lsb == 0.0));
        assert_eq!(explained.first_parting.map(|(layer, _)| layer), Some("l1_out"));
        assert_eq!(explained.budget.hidden_weights_mm, 0.0);
        assert!(explained.budget.output_weights_mm.abs() < 1e-9);
    }

    #[test]
    fn a_sum_past_the_table_is_counted_and_costs_what_the_address_loses() {
        let mut network = Network::builtin("uniform").unwrap().unwrap();
        network.float = Unrounded::Unknown;
        network.fixed.w1[2].fill(network.datapath.w1.max() as i32);
        network.fixed.b1[2] = network.datapath.b1.max() as i32;
        let explained = explain(&network, &peak(100, 30_000));
        assert!(explained.neurons[2].saturated && explained.saturated >= 1);
        assert_eq!(explained.neurons[2].address, 2047);
    }
}
