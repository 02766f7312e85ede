//! Import of networks trained elsewhere: their arrays, converted to raw counts in and metres out.
//!
//! The arrays of MATLAB's `feedforwardnet(8, 'trainlm')` are accepted as they are: `IW{1,1}`, `LW{2,1}`, `b{1}`,
//! `b{2}`, and the settings of `mapminmax` on both sides, `y = (x - xoffset) gain + ymin`. For other tools, omit the
//! settings and give weights for raw counts and metres. The length of `b1` is the number of neurons.

mod arrays;
mod elements;
mod json;
mod mat;
mod npy;
mod unpack;
mod widen;

use std::path::Path;

use arrays::{Array, Arrays};

use tofsim::error::{Error, Input, Result};
use tofsim::firmware::forward2::MOST_NEURONS;
use tofsim::network::float::Float;

/// Reads the arrays of a network of histograms of so many bins: a MATLAB file (`.mat`), an object of JSON (`.json`), or a folder of
/// NumPy arrays (`IW.npy` and so on), told apart by the ending.
///
/// # Errors
/// When an array is missing, unknown, has another shape, or a number that is none.
pub fn read(path: &Path, bins: usize) -> Result<Float> {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    let is_folder = path.metadata().map_err(Error::io(path, "read"))?.is_dir();
    let arrays = match ending.to_ascii_lowercase().as_str() {
        _ if is_folder => npy::read(path)?,
        "mat" => mat::read(path)?,
        "json" => json::read(path)?,
        _ => {
            let expected = "expected a .mat or .json file, or a folder of .npy files";
            return Err(Input::new(path.display(), expected).into());
        }
    };
    fold(arrays, bins)
}

/// The arrays' meaning, for histograms of `all` bins.
fn fold(mut arrays: Arrays, all: usize) -> Result<Float> {
    let bins: Vec<usize> = match arrays.optional("x_keep") {
        None => (0..all).collect(),
        Some(keep) => kept(&arrays, &keep, all)?,
    };
    let columns = bins.len();
    let b1 = arrays.required("b1")?;
    let neurons = b1.values.len();
    if !(1..=MOST_NEURONS).contains(&neurons) {
        let expected = format!("{neurons} neurons, expected 1 to {MOST_NEURONS}");
        return Err(arrays.fault("b1", &expected).into());
    }
    let b1 = b1.shaped(&arrays, &[neurons])?;
    let hidden = arrays.required("IW")?.shaped(&arrays, &[neurons, columns])?;
    let output = arrays.required("LW")?.shaped(&arrays, &[neurons])?;
    let b2 = arrays.required("b2")?.shaped(&arrays, &[1])?[0];
    let x = MapMinMax::take(&mut arrays, ["x_xoffset", "x_gain", "x_ymin"], columns)?;
    let y = MapMinMax::take(&mut arrays, ["y_xoffset", "y_gain", "y_ymin"], 1)?;
    arrays.finish()?;
    if y.gain[0] == 0.0 {
        let expected = "expected a gain other than 0";
        return Err(Input::new(&arrays.name, expected).field("y_gain").value(0).into());
    }

    let mut w1 = vec![vec![0.0; all]; neurons];
    let mut biases = b1;
    for neuron in 0..neurons {
        let row = &hidden[neuron * columns..][..columns];
        for (place, (&weight, &bin)) in row.iter().zip(&bins).enumerate() {
            w1[neuron][bin] = weight * x.gain[place];
            biases[neuron] += weight * (x.ymin - x.xoffset[place] * x.gain[place]);
        }
    }
    Ok(Float {
        w1,
        b1: biases,
        w2: output.iter().map(|weight| weight / y.gain[0]).collect(),
        b2: (b2 - y.ymin) / y.gain[0] + y.xoffset[0],
    })
}

/// The settings of `mapminmax` on one side; without them, values pass as they are.
struct MapMinMax {
    xoffset: Vec<f64>,
    gain: Vec<f64>,
    ymin: f64,
}

impl MapMinMax {
    /// Takes what has those names; without any of them nothing is changed.
    fn take(arrays: &mut Arrays, names: [&str; 3], len: usize) -> Result<Self> {
        let found = names.map(|name| (name, arrays.optional(name)));
        if found.iter().all(|(_, array)| array.is_none()) {
            return Ok(MapMinMax { xoffset: vec![0.0; len], gain: vec![1.0; len], ymin: 0.0 });
        }
        let shaped = |(name, array): (&str, Option<Array>), len| {
            let missing = || arrays.fault(name, "missing, while others of mapminmax are there");
            array.ok_or_else(missing)?.shaped(arrays, &[len])
        };
        let [xoffset, gain, ymin] = found;
        let (xoffset, gain) = (shaped(xoffset, len)?, shaped(gain, len)?);
        Ok(MapMinMax { xoffset, gain, ymin: shaped(ymin, 1)?[0] })
    }
}

/// The bins that `removeconstantrows` kept, counted from 1 as MATLAB does.
fn kept(arrays: &Arrays, keep: &Array, all: usize) -> Result<Vec<usize>> {
    let mut bins = Vec::new();
    for &place in &keep.values {
        let bin = place as usize;
        let is_next = bins.last().is_none_or(|&last| bin > last + 1);
        if place.fract() != 0.0 || !(1..=all).contains(&bin) || !is_next {
            let expected = format!("expected rising places from 1 to {all}");
            return Err(arrays.fault("x_keep", &expected).value(place).into());
        }
        bins.push(bin - 1);
    }
    Ok(bins)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::firmware::forward2::NEURONS;
    use tofsim::firmware::histogram_builder::BINS;
    use tofsim::network::Histogram;

    /// A network as MATLAB evaluates it.
    fn by_matlab(arrays: &Arrays, histogram: &[u32]) -> f64 {
        let get = |name: &str| arrays.arrays[name].values.clone();
        let (iw, lw, b1, b2) = (get("IW"), get("LW"), get("b1"), get("b2"));
        let (xo, xg, xm) = (get("x_xoffset"), get("x_gain"), get("x_ymin")[0]);
        let (yo, yg, ym) = (get("y_xoffset")[0], get("y_gain")[0], get("y_ymin")[0]);
        let mut y = b2[0];
        for neuron in 0..NEURONS {
            let mut sum = b1[neuron];
            for bin in 0..BINS {
                let x = (f64::from(histogram[bin]) - xo[bin]) * xg[bin] + xm;
                sum += iw[neuron * BINS + bin] * x;
            }
            y += lw[neuron] * sum.tanh();
        }
        (y - ym) / yg + yo
    }

    fn example() -> Arrays {
        let wave = |k: usize, scale: f64| scale * ((k * 7919 % 1000) as f64 / 500.0 - 1.0);
        let many = |len: usize, scale| (0..len).map(|k| wave(k + 3, scale)).collect::<Vec<_>>();
        let mut arrays = Arrays::new("example");
        arrays.put("IW", vec![NEURONS, BINS], many(NEURONS * BINS, 0.2));
        arrays.put("LW", vec![1, NEURONS], many(NEURONS, 1.5));
        arrays.put("b1", vec![NEURONS, 1], many(NEURONS, 2.0));
        arrays.put("b2", vec![1], vec![0.3]);
        arrays.put("x_xoffset", vec![BINS, 1], many(BINS, 5.0));
        arrays.put("x_gain", vec![BINS], (0..BINS).map(|k| 0.001 * (1 + k % 7) as f64).collect());
        arrays.put("x_ymin", vec![], vec![-1.0]);
        arrays.put("y_xoffset", vec![1, 1], vec![0.1]);
        arrays.put("y_gain", vec![1], vec![4.0]);
        arrays.put("y_ymin", vec![1], vec![-1.0]);
        arrays
    }

    #[test]
    fn the_folded_network_gives_what_matlab_gives() {
        let arrays = example();
        let float = fold(arrays.clone(), BINS).unwrap();
        for seed in 0..20 {
            let histogram: Histogram =
                (0..256).map(|bin| ((bin * (seed + 3) * 31 + seed) % 900) as u32).collect();
            let (ours, theirs) = (float.forward(&histogram), by_matlab(&arrays, &histogram));
            assert!((ours - theirs).abs() < 1e-12, "{ours} {theirs}");
        }
    }

    #[test]
    fn constant_rows_that_were_removed_have_no_weight() {
        let mut arrays = Arrays::new("a");
        arrays.put("IW", vec![NEURONS, 2], (0..2 * NEURONS).map(|k| k as f64).collect());
        arrays.put("LW", vec![NEURONS], vec![1.0; NEURONS]);
        arrays.put("b1", vec![NEURONS], vec![0.0; NEURONS]);
        arrays.put("b2", vec![1], vec![0.0]);
        arrays.put("x_keep", vec![2], vec![4.0, 200.0]);
        let float = fold(arrays.clone(), BINS).unwrap();
        assert_eq!((float.w1[3][3], float.w1[3][199], float.w1[3][0]), (6.0, 7.0, 0.0));
        arrays.put("x_keep", vec![2], vec![4.0, 4.0]);
        assert!(
            fold(arrays, BINS).unwrap_err().to_string().contains("x_keep = 4: expected rising")
        );
    }

    #[test]
    fn what_is_missing_misshapen_or_unknown_is_named() {
        let fault = |change: &dyn Fn(&mut Arrays)| {
            let mut arrays = example();
            change(&mut arrays);
            fold(arrays, BINS).unwrap_err().to_string()
        };
        assert_eq!(fault(&|a| drop(a.optional("LW"))), "example: LW: missing");
        let message = fault(&|a| a.put("b1", vec![33], vec![0.0; 33]));
        assert!(message.contains("b1: 33 neurons, expected 1 to 32"), "{message}");
        let message = fault(&|a| a.put("IW", vec![9, BINS], vec![0.0; 9 * BINS]));
        assert!(message.contains("IW: 9 x 256, expected 8 x 256"), "{message}");
        let message = fault(&|a| drop(a.optional("y_gain")));
        assert!(message.contains("y_gain: missing, while"), "{message}");
        let message = fault(&|a| a.put("bias", vec![1], vec![0.0]));
        assert!(message.contains("bias: unknown"), "{message}");
        let message = fault(&|a| a.put("b2", vec![1], vec![f64::NAN]));
        assert!(message.contains("b2[0] = NaN: expected a finite number"), "{message}");
        assert!(fault(&|a| a.put("y_gain", vec![1], vec![0.0])).contains("y_gain = 0"));
    }
}
