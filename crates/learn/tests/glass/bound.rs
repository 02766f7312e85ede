//! The Cramér-Rao bound with a pedestal and two targets, against finite differences of the formula.

use tofsim_learn::estimation::acquisition::Echo;
use tofsim_learn::estimation::likelihood::Model;

use super::*;

/// The exact template of a light.
pub fn exact(bins: &Bins, glass: f64) -> GlassTemplate {
    let of_glass = |time: tofsim::kernel::Time| {
        let t_ps = time.fs() as f64 * 1e-3;
        Light { glass, ..Light::DARK }.until(t_ps) - AMBIENT * t_ps
    };
    let mut hazards = vec![0.0; bins.count()];
    for span in bins.spans() {
        hazards[span.code as usize] += of_glass(span.until) - of_glass(span.from);
    }
    let rows = bins.limits_ps().into_iter().zip(hazards).map(|([from_ps, until_ps], hazard)| {
        tofsim::scenario::glass::GlassBin { from_ps, until_ps, hazard, hazard_se: 0.0 }
    });
    GlassTemplate::new("exact", rows.collect()).unwrap()
}

pub fn echo(signal: f64, distance_m: f64) -> Echo {
    Echo { arrival_ps: distance_m * ARRIVAL_PS_PER_M, signal, background_per_ps: AMBIENT }
}

/// Inverse of a matrix by Gauss and Jordan.
fn inverse(mut a: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let size = a.len();
    for (k, row) in a.iter_mut().enumerate() {
        row.extend((0..size).map(|j| f64::from(u8::from(j == k))));
    }
    for k in 0..size {
        let best = (k..size).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).unwrap();
        a.swap(k, best);
        let pivot = a[k][k];
        a[k].iter_mut().for_each(|x| *x /= pivot);
        let row = a[k].clone();
        for (j, other) in a.iter_mut().enumerate().filter(|(j, _)| *j != k) {
            let by = other[k];
            debug_assert!(j < size);
            other.iter_mut().zip(&row).for_each(|(x, y)| *x -= by * y);
        }
    }
    a.into_iter().map(|row| row[size..].to_vec()).collect()
}

/// Bounds of the distances by the information of the histogram, whose derivatives are differences: parameters are
/// distances, signals, the window's amplitude and ambient light.
fn naive_m(bins: &Bins, light: &Light, two: bool, with_glass: bool) -> Vec<f64> {
    let cells = |x: &[f64]| {
        let [signal, second] = [x[1], if two { x[3] } else { 0.0 }];
        let place = if two { x[2] } else { 1.0 };
        let (amplitude, ambient) = (x[x.len() - 2], x[x.len() - 1]);
        let glass = if with_glass { light.glass * amplitude } else { 0.0 };
        let own = Light { glass, signal, distance_m: x[0], second: (second, place) };
        let mut codes = vec![0.0; bins.count()];
        let mut rest = 1.0;
        for span in bins.spans() {
            let [from, until] = [span.from, span.until].map(|time| {
                let t_ps = time.fs() as f64 * 1e-3;
                (-(own.until(t_ps) + (ambient - 1.0) * AMBIENT * t_ps)).exp()
            });
            codes[span.code as usize] += from - until;
            rest -= from - until;
        }
        codes.push(rest);
        codes
    };
    let mut x = vec![light.distance_m, light.signal];
    if two {
        x.extend([light.second.1, light.second.0]);
    }
    let free: Vec<usize> =
        (0..x.len()).chain(with_glass.then_some(x.len())).chain([x.len() + 1]).collect();
    x.extend([1.0, 1.0]);
    let moved = |k: usize, by: f64| {
        let mut to = x.clone();
        to[k] += by;
        cells(&to)
    };
    let step = |k: usize| 1e-4 * x[k];
    let of = cells(&x);
    let slopes: Vec<Vec<f64>> = free
        .iter()
        .map(|&k| {
            let sides = moved(k, step(k)).into_iter().zip(moved(k, -step(k)));
            sides.map(|(up, down)| (up - down) / 2.0 / step(k)).collect()
        })
        .collect();
    let information = |a: &Vec<f64>, b: &Vec<f64>| -> f64 {
        let terms = of.iter().zip(a).zip(b).filter(|((p, _), _)| **p > 1e-14);
        SHOTS as f64 * terms.map(|((p, a), b)| a * b / p).sum::<f64>()
    };
    let matrix = slopes.iter().map(|a| slopes.iter().map(|b| information(a, b)).collect());
    let inverse = inverse(matrix.collect());
    (0..if two { 2 } else { 1 }).map(|echo| inverse[2 * echo][2 * echo].sqrt()).collect()
}

#[test]
fn the_bound_is_that_of_finite_differences() {
    let bins = bins("kintex7");
    for (glass, signal, distance_m, second) in [
        (0.0, 0.3, 0.4, (0.0, 1.0)),
        (0.5, 0.3, 0.4, (0.0, 1.0)),
        (1.5, 0.15, 0.1, (0.0, 1.0)),
        (0.0, 0.3, 0.3, (0.2, 0.45)),
        (1.0, 0.3, 0.3, (0.2, 0.4)),
        (1.0, 0.3, 0.12, (0.2, 0.6)),
    ] {
        let light = Light { glass, signal, distance_m, second };
        let (two, with_glass) = (second.0 > 0.0, glass > 0.0);
        let template = with_glass.then(|| exact(&bins, glass));
        let model = Model::new(&acquisition(&bins, template.as_ref())).unwrap();
        let mut echoes = vec![echo(signal, distance_m)];
        echoes.extend(two.then(|| echo(second.0, second.1)));
        let found = model.cramer_rao_of(&echoes, 1.0).unwrap();
        let expected = naive_m(&bins, &light, two, with_glass);
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found / expected - 1.0).abs() < 2e-3, "{light:?}: {found} {expected}");
        }
        assert_eq!(found.len(), expected.len());
    }
}

#[test]
fn a_pedestal_whose_amplitude_is_unknown_costs_more_than_one_that_is_known() {
    let bins = bins("ideal");
    let template = exact(&bins, 1.0);
    let model = Model::new(&acquisition(&bins, Some(&template))).unwrap();
    let at = |distance_m: f64, amplitude| {
        model.cramer_rao_of(&[echo(0.2, distance_m)], amplitude).unwrap()[0]
    };
    // The pedestal uses up shots, and hides an echo that is next to it.
    assert!(at(0.6, 1.0) > 1.3 * at(0.6, 0.0));
    assert!(at(0.05, 1.0) > 2.0 * at(0.6, 1.0));
    assert!(at(0.6, 2.0) > at(0.6, 1.0));
    // A template that starts with no light leaves nothing of the echo unknown.
    let without = Model::new(&acquisition(&bins, None)).unwrap();
    let alone = without.cramer_rao_m(&echo(0.2, 0.6)).unwrap();
    assert!((at(0.6, 0.0) / alone - 1.0).abs() < 0.01);
}
