use tofsim::network::Histogram;

use crate::training::features::{InputScale, blocks};
use crate::training::limits::{Hinges, WordLimits};
use crate::training::lm::{Lm, LmSettings};
use crate::training::recipe::Recipe;
use crate::training::start::start;
use crate::training::sums::parameters;
use tofsim::firmware::depth_estimator::datapath::Datapath;

use super::*;

/// 300 histograms, so that the last block is not full, and a smooth network.
fn counts() -> Vec<Histogram> {
    let one = |s: usize| -> Histogram {
        (0..256).map(|bin| ((s * 37 + bin * s * 3 + bin * bin) % 401) as u32).collect()
    };
    (0..300).map(one).collect()
}

fn with_problem<T>(neurons: usize, check: impl FnOnce(&NetworkProblem, &[f64]) -> T) -> T {
    let counts = counts();
    let scaling = Scaling::of(&counts, &[], InputScale::Deviation);
    let blocks = blocks(&counts, &scaling);
    let distances_m: Vec<f64> = (0..300).map(|s| 0.1 + s as f64 / 600.0).collect();
    let weights: Vec<f64> = (0..300).map(|s| 500.0 + s as f64).collect();
    let problem = NetworkProblem {
        blocks: &blocks,
        scaling: &scaling,
        distances_m: &distances_m,
        weights: &weights,
        neurons,
        // Much, so that a fault in its derivatives shows.
        table_noise: 0.5,
        hinges: Hinges { limits: WordLimits::default(), words: Datapath::THESIS },
        held_out: None,
    };
    let x: Vec<f64> =
        (0..parameters(neurons, scaling.columns())).map(|k| (k as f64).sin() * 0.1).collect();
    check(&problem, &x)
}

/// Residuals of all samples, each with those of its neurons.
fn residuals(problem: &NetworkProblem, x: &[f64]) -> Vec<f64> {
    let mut activations = vec![0.0; problem.neurons];
    let w2 = &x[problem.neurons * problem.scaling.columns()..];
    let mut residuals = Vec::new();
    for sample in 0..300 {
        let block = &problem.blocks[sample / BLOCK];
        let depth = problem.depth(x, block, sample % BLOCK, &mut activations);
        let u = problem.weights[sample];
        residuals.push(u * (depth - problem.distances_m[sample]));
        for (a, w2) in activations.iter().zip(w2) {
            residuals.push(problem.table_noise * u * w2 * (1.0 - a * a));
        }
    }
    residuals
}

#[test]
fn the_normal_equations_are_those_of_finite_differences() {
    for neurons in [1, 3] {
        with_problem(neurons, |problem, x| {
            let linear = problem.linearise(x);
            let cost = problem.cost(x);
            assert!((linear.cost - cost).abs() < 1e-12 * cost);
            let r = residuals(problem, x);
            let sum: f64 = r.iter().map(|r| r * r).sum();
            assert!((sum / 300.0 - cost).abs() < 1e-9 * cost);
            let column = |k: usize| -> Vec<f64> {
                let mut moved = [x.to_vec(), x.to_vec()];
                moved[0][k] += 1e-6;
                moved[1][k] -= 1e-6;
                let [above, below] = moved.map(|x| residuals(problem, &x));
                above.iter().zip(&below).map(|(a, b)| (a - b) / 2e-6).collect()
            };
            let jacobian: Vec<Vec<f64>> = (0..x.len()).map(column).collect();
            let dot = |a: &[f64], b: &[f64]| -> f64 {
                a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / 300.0
            };
            let norm: Vec<f64> = jacobian.iter().map(|column| dot(column, column).sqrt()).collect();
            for (i, column) in jacobian.iter().enumerate() {
                let (found, expected) = (linear.gradient[i], dot(column, &r));
                assert!((found - expected).abs() < 1e-6 * norm[i] * cost.sqrt(), "{i}");
                for j in 0..=i {
                    let (found, expected) = (linear.matrix.at(i, j), dot(column, &jacobian[j]));
                    assert!((found - expected).abs() < 1e-5 * norm[i] * norm[j], "{i} {j}");
                }
            }
        });
    }
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    with_problem(3, |problem, x| {
        let result = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| (problem.cost(x), problem.linearise(x)))
        };
        assert!(result(1) == result(3));
    });
}

#[test]
fn errors_are_depth_minus_distance() {
    with_problem(2, |problem, x| {
        let errors = problem.errors(x);
        let residuals = residuals(problem, x);
        for sample in [0, 255, 256, 299] {
            let expected = residuals[sample * 3] / problem.weights[sample];
            assert!((errors[sample] - expected).abs() < 1e-12);
        }
    });
}

#[test]
fn wider_vectors_change_no_bit() {
    with_problem(3, |problem, x| {
        let (narrow, wide) = (pulp::Arch::Scalar, pulp::Arch::new());
        let sums = |arch: pulp::Arch| problem.sums(arch, x);
        assert!(sums(narrow) == sums(wide));
        let cost = |arch: pulp::Arch| problem.squares(arch, x);
        assert_eq!(cost(narrow), cost(wide));
    });
}

#[test]
fn bins_that_never_count_do_no_harm() {
    let histogram = |s: usize| -> Vec<u32> {
        let count = |bin: usize| {
            if (40..90).contains(&bin) { ((s * 7 + bin * s) % 31) as u32 } else { 0 }
        };
        (0..256).map(count).collect()
    };
    let counts: Vec<_> = (0..400).map(histogram).collect();
    let distances_m: Vec<f64> =
        counts.iter().map(|counts| 0.1 + f64::from(counts[60]) / 100.0).collect();
    let scaling = Scaling::of(&counts, &[], InputScale::Deviation);
    assert!(scaling.inverse_scale.contains(&0.0));
    let blocks = blocks(&counts, &scaling);
    let (recipe, weights) = (Recipe::default(), vec![1000.0; 400]);
    let problem = NetworkProblem {
        blocks: &blocks,
        scaling: &scaling,
        distances_m: &distances_m,
        weights: &weights,
        neurons: 2,
        table_noise: 0.0,
        hinges: Hinges { limits: WordLimits::default(), words: Datapath::THESIS },
        held_out: None,
    };
    let mut lm =
        Lm::new(start(&recipe.start, [2, scaling.columns()], 1, 0), &LmSettings::default());
    lm.epoch(&problem, &LmSettings::default()).unwrap();
    let first = lm.cost;
    for _ in 0..10 {
        lm.epoch(&problem, &LmSettings::default()).unwrap();
    }
    assert!(lm.x.len() == parameters(2, scaling.columns()) && lm.x.iter().all(|x| x.is_finite()));
    assert!(lm.cost < 0.5 * first, "{} {first}", lm.cost);
}
