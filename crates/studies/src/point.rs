//! Evaluation of a plan's point, and its row in the table.

use std::sync::atomic::AtomicBool;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use toml_edit::Value;

use tofsim::error::{Error, Input, Result};
use tofsim::files::digest::digest_of;
use tofsim::note::Note;
use tofsim::scenario::Loaded;

use crate::columns::Column;
use crate::figure::{Figure, mean, mean_of_scenes, of_repeats};
use crate::header::header;
use crate::plan::Plan;
use crate::plan::axis::{Axis, number};
use crate::plan::file::Refused;
use crate::plan::search::{Answer, Search};
use crate::table::{Cell, Row};
use crate::trial::{Outcome, Trial};

/// Bits of a point's seed, so that it fits a double.
const SEED_BITS: u32 = 53;

/// Result of a point.
pub struct Evaluated {
    /// Its row.
    pub row: Row,
    /// Notes on its values.
    pub notes: Vec<Note>,
}

/// Evaluates a point.
///
/// # Errors
/// If the scenario is refused and the plan does not keep such points, or the sweep is stopped.
pub fn work(plan: &Plan, point: u64, stop: Option<&AtomicBool>) -> Result<Evaluated> {
    let at = Point { plan, point, settings: plan.points.settings(point), stop };
    match (at.work(), plan.file.refused) {
        (Err(Error::Input(why)), Refused::Keep) => Ok(at.refused(&why)),
        (Err(Error::Input(why)), Refused::Stop) => {
            let expected =
                format!("{why}; refused = \"keep\" in the plan goes on without such points");
            let source = format!("plan {}, point {point}", plan.name);
            Err(Input::new(source, expected).value(at.settings.join(", ")).into())
        }
        (worked, _) => worked,
    }
}

struct Point<'a> {
    plan: &'a Plan,
    point: u64,
    settings: Vec<String>,
    stop: Option<&'a AtomicBool>,
}

/// Results of a search in all repeats; empty without a search.
#[derive(Default)]
struct Searched {
    cells: Vec<Cell>,
    /// Settings at which the outputs are computed.
    settings: Vec<String>,
}

impl Point<'_> {
    fn work(&self) -> Result<Evaluated> {
        let searched = match &self.plan.search {
            Some(search) => self.search(search)?,
            None => Searched::default(),
        };
        let columns: Vec<_> = self.plan.outputs.iter().collect();
        let (mut repeats, mut notes) = (Vec::new(), Vec::new());
        for repeat in 0..self.plan.file.repeats {
            let outcome = self.measure(&columns, &searched.settings, repeat)?;
            repeats.push(outcome.figures);
            add(&mut notes, outcome.notes);
        }
        let mut cells = self.head();
        cells.extend(searched.cells);
        for (place, column) in columns.iter().enumerate() {
            let of = repeats.iter().map(|figures: &Vec<Figure>| figures[place]);
            let figure = of_repeats(column.is_random(), of);
            cells.push(Cell::number(figure.value));
            if column.is_random() {
                cells.push(Cell::number(figure.se));
            }
        }
        cells.push(Cell::Text(codes(&notes)));
        if self.plan.file.refused == Refused::Keep {
            cells.push(Cell::None);
        }
        Ok(Evaluated { row: Row { point: self.point, cells }, notes })
    }

    /// Returns the cells that identify the point.
    fn head(&self) -> Vec<Cell> {
        let values = self.plan.points.values(self.point);
        let axes =
            self.plan.points.axes.iter().zip(values).map(|(axis, value)| axis_cell(axis, &value));
        let seed = Cell::Whole(self.seed(&self.plan.mean_over[0], 0));
        [Cell::Whole(self.point)].into_iter().chain(axes).chain([seed]).collect()
    }

    fn refused(&self, why: &Input) -> Evaluated {
        let mut cells = self.head();
        let all = header(self.plan).len();
        cells.resize(all - 1, Cell::None);
        cells.push(Cell::Text(why.to_string()));
        Evaluated { row: Row { point: self.point, cells }, notes: Vec::new() }
    }

    /// Returns the seed of a repeat in a scene: the plan's, or one derived from it and the settings, so that it does
    /// not depend on the other points.
    fn seed(&self, scene: &[String], repeat: u64) -> u64 {
        let first = if self.plan.file.common_random_numbers {
            self.plan.seed
        } else {
            let settings: Vec<_> = self.settings.iter().chain(scene).cloned().collect();
            let settings = settings.join("\n");
            let digest = digest_of(format_args!("{}\n{settings}", self.plan.seed));
            ChaCha8Rng::seed_from_u64(digest).random::<u64>() >> (64 - SEED_BITS)
        };
        first.wrapping_add(repeat)
    }

    fn loaded(&self, further: &[String], scene: &[String], repeat: u64) -> Result<Loaded> {
        let settings: Vec<_> = self.settings.iter().chain(further).chain(scene).cloned().collect();
        let mut loaded = self.plan.loaded(&settings)?;
        loaded.scenario.seed = self.seed(scene, repeat);
        Ok(loaded)
    }

    /// Computes the columns of a repeat, averaged over the plan's scenes.
    fn measure(&self, columns: &[&Column], further: &[String], repeat: u64) -> Result<Outcome> {
        let trial = Trial::new(self.plan, columns.to_vec(), self.stop);
        let (mut figures, mut notes) = (Vec::new(), Vec::new());
        for scene in &self.plan.mean_over {
            let outcome = trial.measure(self.loaded(further, scene, repeat)?)?;
            figures.push(outcome.figures);
            add(&mut notes, outcome.notes);
        }
        let of = |place: usize| {
            mean_of_scenes(figures.iter().map(|figures: &Vec<Figure>| figures[place]))
        };
        Ok(Outcome { figures: (0..columns.len()).map(of).collect(), notes })
    }

    fn search(&self, search: &Search) -> Result<Searched> {
        let scenes = &search.scenes;
        let mut answers = Vec::new();
        // What fails once is likely to fail again, and is asked first.
        let mut hardest = 0;
        for repeat in 0..self.plan.file.repeats {
            answers.push(search.run(|value| {
                let order = (0..scenes.len()).map(|k| (k + hardest) % scenes.len());
                for scene in order {
                    let uses = self.uses(search, value, &scenes[scene], repeat)?;
                    if !uses.iter().all(|(is_met, _)| *is_met) {
                        hardest = scene;
                        return Ok(false);
                    }
                }
                Ok(true)
            })?);
        }
        let found = answers.iter().filter_map(|answer| match answer {
            Answer::Found(value) => Some(*value),
            _ => None,
        });
        let figure = mean(found.clone());
        let repeats = found.count() as u64;
        let word = match &answers[..] {
            _ if repeats > 0 => "found",
            all if all.iter().all(|answer| *answer == Answer::Everywhere) => "everywhere",
            all if all.iter().all(|answer| *answer == Answer::Nowhere) => "nowhere",
            _ => "unclear",
        };
        let shown = figure.value.unwrap_or_else(|| search.shown(answers[0]));
        let shown = search.settled(shown);
        let scene = &scenes[self.tightest(search, shown, scenes)?];
        let mut settings = vec![assignment(search, shown)];
        settings.extend(scene.iter().cloned());
        let mut cells = vec![Cell::number(figure.value), Cell::number(figure.se)];
        cells.extend([Cell::Text(word.to_owned()), Cell::Whole(repeats)]);
        for (axis, assignment) in search.over.iter().zip(scene) {
            let value = assignment.split_once('=').map_or("", |(_, value)| value);
            cells.push(axis_cell(axis, value));
        }
        Ok(Searched { cells, settings })
    }

    /// Returns for each limit whether a value meets it in a scene, and the used fraction of the limit.
    fn uses(
        &self,
        search: &Search,
        value: f64,
        scene: &[String],
        repeat: u64,
    ) -> Result<Vec<(bool, f64)>> {
        let columns: Vec<_> = search.columns.iter().collect();
        let mut settings = vec![assignment(search, value)];
        settings.extend(scene.iter().cloned());
        let outcome = self.measure(&columns, &settings, repeat)?;
        let figures = search.meets.iter().zip(outcome.figures);
        Ok(figures
            .map(|(limit, figure)| (limit.is_met(figure.value), limit.use_of(figure.value)))
            .collect())
    }

    /// Returns the scene that is closest to violating a limit, or violates one most.
    fn tightest(&self, search: &Search, value: f64, scenes: &[Vec<String>]) -> Result<usize> {
        let mut worst = (f64::NEG_INFINITY, 0);
        for (k, scene) in scenes.iter().enumerate().filter(|_| scenes.len() > 1) {
            let uses = self.uses(search, value, scene, 0)?;
            let most = uses.iter().map(|(_, used)| *used).fold(f64::NEG_INFINITY, f64::max);
            if most > worst.0 {
                worst = (most, k);
            }
        }
        Ok(worst.1)
    }
}

/// Creates the cell of an axis value, which is given in TOML.
fn axis_cell(axis: &Axis, value: &str) -> Cell {
    if !axis.is_text {
        return Cell::number(value.parse().ok());
    }
    let text = value.parse().ok().and_then(|value: Value| value.as_str().map(str::to_owned));
    Cell::Text(text.unwrap_or_else(|| value.to_owned()))
}

fn assignment(search: &Search, value: f64) -> String {
    format!("{}={}", search.key, number(value))
}

fn add(notes: &mut Vec<Note>, more: Vec<Note>) {
    for note in more {
        if !notes.iter().any(|known| known.code == note.code && known.key == note.key) {
            notes.push(note);
        }
    }
}

/// Formats the distinct codes of notes, separated by spaces.
fn codes(notes: &[Note]) -> String {
    let mut codes: Vec<_> = notes.iter().map(|note| note.code.to_string()).collect();
    codes.sort();
    codes.dedup();
    codes.join(" ")
}
