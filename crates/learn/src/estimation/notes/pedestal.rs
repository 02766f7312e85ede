//! The note on a cover window whose light has moved since its calibration.

use tofsim::scenario::glass::GlassTemplate;
use tofsim::{Note, NoteCode};

use crate::estimation::estimator::Estimate;

/// Change of the amplitude that makes a note [standard errors].
const SIGNIFICANT: f64 = 5.0;
/// Change of the amplitude below which there is no note: a fit of the amplitude takes out as much as that [1].
const SMALL: f64 = 0.05;

/// Pedestals of the frames so far, by the first estimator that has a template.
#[derive(Clone, Debug, Default)]
pub struct PedestalWatch {
    frames: f64,
    /// Sum of the amplitudes over their variances, and of the inverse variances.
    relative: [f64; 2],
    misfit: f64,
}

impl PedestalWatch {
    /// Adds the estimates of a frame.
    pub fn add(&mut self, estimates: &[Estimate]) {
        let Some(pedestal) = estimates.iter().find_map(|estimate| estimate.pedestal) else {
            return;
        };
        self.frames += 1.0;
        self.misfit += pedestal.misfit;
        if pedestal.relative_se > 0.0 {
            let weight = pedestal.relative_se.powi(-2);
            self.relative[0] += weight * pedestal.relative;
            self.relative[1] += weight;
        }
    }

    /// Returns a note if the window's light has another amplitude than the template, or another shape.
    pub fn note(&self, glass: &GlassTemplate) -> Option<Note> {
        if self.frames == 0.0 {
            return None;
        }
        let of_template = glass.bins().iter().map(|bin| bin.hazard_se.powi(2)).sum::<f64>().sqrt();
        let [relative, se] = match self.relative {
            [_, 0.0] => [0.0, 0.0],
            [sum, weight] => [sum / weight, weight.sqrt().recip()],
        };
        let error = se.hypot(of_template / glass.photons());
        let change = (relative - 1.0).abs();
        let key = "estimator.glass_file";
        let misfit = self.misfit / self.frames.sqrt();
        // An amplitude is fitted, a shape is not.
        if misfit > SIGNIFICANT {
            let text = format!(
                "the cover window's light has another shape than in the calibration: its bins are {misfit:.1} standard \
                 deviations off over all frames, at {relative:.3} times its amplitude; calibrate anew (tofsim calibrate \
                 glass)"
            );
            return Some(Note::new(NoteCode::PedestalMoved, key, misfit, "below 5", text));
        }
        (change > SMALL && change > SIGNIFICANT * error).then(|| {
            let text = format!(
                "the cover window's light is {relative:.3} +- {error:.3} times that of the calibration: clean the \
                 window or calibrate anew (tofsim calibrate glass)"
            );
            Note::new(NoteCode::PedestalMoved, key, relative, "about 1", text)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimation::estimator::Pedestal;
    use tofsim::scenario::glass::GlassBin;

    fn noted(pedestals: &[(f64, f64, f64)]) -> Option<String> {
        let bin = GlassBin { from_ps: 0.0, until_ps: 25.0, hazard: 0.5, hazard_se: 0.001 };
        let mut watch = PedestalWatch::default();
        for &(relative, relative_se, misfit) in pedestals {
            let pedestal = Some(Pedestal { relative, relative_se, misfit });
            let depth = Estimate::of_depth("likelihood", Some(0.5));
            watch.add(&[Estimate::of_depth("peak", None), Estimate { pedestal, ..depth }]);
        }
        watch.note(&GlassTemplate::new("made", vec![bin]).unwrap()).map(|note| note.text)
    }

    #[test]
    fn a_pedestal_that_has_moved_is_noted_with_its_size() {
        assert_eq!(noted(&[]), None);
        assert_eq!(noted(&[(1.03, 0.001, 0.0)]), None, "too small");
        assert_eq!(noted(&[(1.3, 0.1, 0.0)]), None, "not significant");
        let text = noted(&[(1.3, 0.1, 0.0); 9]).unwrap();
        assert!(text.contains("light is 1.300 +- 0.033 times that of the calibration"), "{text}");
        assert!(noted(&[(0.0, 0.0, 0.0)]).unwrap().contains("0.000 +- 0.002 times"));
        assert_eq!(noted(&[(1.0, 0.01, 2.0)]), None);
        let text = noted(&[(1.0, 0.01, 2.0); 9]).unwrap();
        assert!(text.contains("6.0 standard deviations off"), "{text}");
    }
}
