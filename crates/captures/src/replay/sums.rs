//! The histogram, recovered from the sums of the hidden layer: each clock cycle adds a bin count times a weight.

use tofsim::error::{Input, Result};
use tofsim::firmware::forward2::MOST_NEURONS;
use tofsim::firmware::tof_top::Params;
use tofsim::hierarchy::TOP;

use crate::compare::Probed;
use crate::source::Source;
use crate::words::extend;

use super::histogram::Words;

/// Recovers the first histogram of which all bins were added, given a network's weights; `None` if the sums are not
/// probed.
///
/// # Errors
/// If the capture cannot be read, or the sums do not match the weights.
pub(super) fn words(
    capture: &Source,
    probed: &mut Probed,
    per_cycle: u64,
    params: &Params,
) -> Result<Option<Words>> {
    let rom = &params.estimators.depth_estimator.forward1;
    let (width, largest) = (rom.sum_bits(), params.histogram.most_hits());
    let port = |name: &str| probed.probe(&format!("{TOP}.depth_estimator.{name}"));
    let enable = port("estimator_ctrl.forward1_en");
    let neurons: Vec<(usize, usize)> = (0..MOST_NEURONS)
        .filter_map(|neuron| Some((neuron, port(&format!("forward1.l1_in_{neuron}"))?)))
        .collect();
    let (Some(enable), false) = (enable, neurons.is_empty()) else { return Ok(None) };
    let mut words: Words = vec![None; rom.w1.len()];
    // The samples since the unit was enabled, and the sums at the cycle before.
    let biases = || neurons.iter().map(|&(neuron, _)| rom.bias(neuron).bits()).collect();
    let (mut samples, mut sums): (_, Vec<u64>) = (None, biases());
    let mut before = true;
    while let Some(sample) = probed.next()? {
        let enabled = probed.value(enable) == Some(1);
        if enabled && !before {
            (samples, words) = (Some(0), vec![None; rom.w1.len()]);
            sums = biases();
        }
        before = enabled;
        let Some(passed) = &mut samples else { continue };
        let (cycle, is_first) = (*passed / per_cycle, *passed % per_cycle == 0);
        *passed += 1;
        let Some(row) = cycle.checked_sub(1).filter(|_| is_first) else { continue };
        if row >= words.len() as u64 {
            break;
        }
        let now: Option<Vec<u64>> = neurons.iter().map(|&(_, probe)| probed.value(probe)).collect();
        let added = now.as_ref().map(|now| {
            let added = now.iter().zip(&sums).map(|(now, sum)| now.wrapping_sub(*sum));
            added.map(|added| extend(added.into(), width) as i64).collect::<Vec<_>>()
        });
        let weights = neurons.iter().map(|&(neuron, _)| rom.w1[row as usize][neuron].get());
        let Some(count) = added.and_then(|added| word(added.into_iter().zip(weights), largest))
        else {
            let expected = format!(
                "the sums at sample {} are not of the scenario's network; set estimator.network",
                sample.index
            );
            return Err(Input::new(&capture.name, expected).field("l1_in").into());
        };
        words[row as usize] = Some(count);
        sums = now.unwrap_or_default();
    }
    Ok(Some(words))
}

/// Returns the bin count, up to `largest`, whose products with some weights were added; 0 if all weights are zero.
fn word(added: impl Iterator<Item = (i64, i64)> + Clone, largest: u64) -> Option<u64> {
    let first = added.clone().find(|&(_, weight)| weight != 0);
    let count = first.map_or(0, |(added, weight)| added / weight);
    let fits = (0..=largest as i64).contains(&count);
    (fits && added.into_iter().all(|(added, weight)| added == count * weight))
        .then_some(count as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_is_what_all_products_say() {
        assert_eq!(word([(0, 0), (-21, -3), (14, 2)].into_iter(), 65_535), Some(7));
        assert_eq!(word([(-21, -3), (15, 2)].into_iter(), 65_535), None);
        assert_eq!(word([(-21, 3)].into_iter(), 65_535), None);
        assert_eq!(word([(0, 0)].into_iter(), 65_535), Some(0));
    }
}
