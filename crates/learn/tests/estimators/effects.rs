//! Whatever effect a scenario has: an estimator is right or has a note, however it is chosen.

use tofsim::scenario::effects::Effect;
use tofsim::{Frame, Observers, Run, Setup, Stepping};
use tofsim_learn::estimation::notes::notes_of_firmware;
use tofsim_learn::estimation::{EstimatorKind, Panel};

/// A scene in which the models are right to a tenth of a millimetre.
const SCENE: [&str; 2] = ["target.distance_m=0.3", "target.reflectance=0.4"];
/// The largest mean error without a note, beside three standard errors [mm].
const MOST_MM: f64 = 0.4;
/// The estimators that model a frame's light.
const MODELS: [EstimatorKind; 4] = [
    EstimatorKind::Likelihood,
    EstimatorKind::TwoEchoes,
    EstimatorKind::LikelihoodEstimator,
    EstimatorKind::Matched,
];

/// Keys that show an effect; `None` if they name a file or no frame ends.
fn switched_on(effect: Effect) -> Option<&'static [&'static str]> {
    match effect {
        Effect::HeldFrame => None,
        _ => Some(effect.example()).filter(|keys| !keys.iter().any(|key| key.ends_with(".csv"))),
    }
}

/// Each effect that keys switch on, and these keys with those of the scene.
fn effects() -> impl Iterator<Item = (Effect, Vec<&'static str>)> {
    Effect::ALL.into_iter().filter_map(|effect| {
        let keys = switched_on(effect)?;
        Some((effect, SCENE.iter().chain(keys).copied().collect()))
    })
}

#[test]
fn a_model_is_right_or_rejects_the_histogram_or_has_a_note() {
    let (mut right, mut wrong) = (0, Vec::new());
    let none = ("no effect".to_owned(), SCENE.to_vec());
    let each = effects().map(|(effect, keys)| (format!("{effect:?}"), keys));
    for (effect, keys) in each.chain([none]) {
        let setup = Setup::load("kc705", &keys).unwrap();
        let without = MODELS.into_iter().filter(|kind| kind.notes_of_scene(&setup).is_empty());
        let without: Vec<_> = without.collect();
        if without.is_empty() {
            continue;
        }
        let panel = Panel::new(&without, &setup).unwrap();
        let (truth_m, mut errors_m) =
            (setup.true_depth_m().unwrap(), vec![Vec::new(); without.len()]);
        let mut take = |frame: &Frame| {
            for (errors_m, reading) in errors_m.iter_mut().zip(panel.read(&frame.histogram)) {
                // One that rejects the histogram is not wrong.
                errors_m.extend(reading.depth_m.map(|depth_m| depth_m - truth_m));
            }
            Ok(())
        };
        let observers = Observers { frames: Some(&mut take), ..Observers::default() };
        Run::new(&setup).stepping(Stepping::LeapShots).many(6, observers).unwrap();
        for (kind, errors_m) in without.iter().zip(errors_m) {
            let count = errors_m.len() as f64;
            let mean_m = errors_m.iter().sum::<f64>() / count;
            let variance = errors_m.iter().map(|m| (m - mean_m).powi(2)).sum::<f64>() / count;
            let (mean_mm, se_mm) = (1e3 * mean_m, 1e3 * (variance / count).sqrt());
            if mean_mm.abs() > MOST_MM + 3.0 * se_mm {
                wrong.push(format!("{effect}, {}: {mean_mm:.2} mm", kind.name()));
            }
            right += 1;
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(right >= 12, "{right}");
}

#[test]
fn the_estimator_in_the_firmware_has_the_notes_of_the_one_that_an_option_chooses() {
    let of_firmware = |kind: &str, keys: &[&str]| {
        let kind = format!("estimator.kind={kind}");
        let setup = Setup::load("kc705", &[keys, &[kind.as_str()]].concat()).ok()?;
        Some(notes_of_firmware(&setup).into_iter().map(|note| note.key).collect::<Vec<_>>())
    };
    let mut noted = 0;
    for (effect, keys) in effects() {
        for (word, kind) in [
            ("network", EstimatorKind::Network),
            ("centroid", EstimatorKind::Centroid),
            ("likelihood", EstimatorKind::LikelihoodEstimator),
        ] {
            let chosen = kind.notes_of_scene(&Setup::load("kc705", &keys).unwrap());
            let key =
                |key: String| if key == "--estimator" { "estimator.kind".into() } else { key };
            let expected: Vec<_> = chosen.into_iter().map(|note| key(note.key)).collect();
            // One that the firmware cannot be built with has no notes.
            let Some(found) = of_firmware(word, &keys) else { continue };
            assert_eq!(found, expected, "{effect:?}, {word}");
            noted += found.len();
        }
    }
    assert!(noted > 20, "{noted}");
    let found = of_firmware("likelihood", &["spad.pulse_gap_ns=10"]);
    assert_eq!(found, Some(vec!["spad.pulse_gap_ns".to_owned()]));
}
