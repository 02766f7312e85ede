//! `tofsim train`: a depth network from simulated histograms.

use std::path::Path;
use std::time::{Duration, Instant};

use tofsim::error::{Error, Input, Result, read_text};
use tofsim::files::folder::FolderLock;
use tofsim::scenario;
use tofsim::sim::domain;
use tofsim_learn::dataset::{GridOption, GridPurpose};
use tofsim_learn::training::checkpoint;
use tofsim_learn::training::recipe::Recipe;
use tofsim_learn::training::tournament::{Tournament, Watch};
use tofsim_learn::training::weighting::Weighting;

use crate::record::Record;
use crate::report::training::TrainingFindings;
use crate::report::writer::Report;

use super::draws::use_threads;
use super::progress::Progress;
use super::scenes::of_the_own_grid;
use super::terminal::{Console, print, stop_signal};

mod args;
mod origin;
mod written;

pub use args::{Args, QUICK};
use origin::Origin;
use written::TrainingOrigin;

/// Runs the verb.
pub fn run(given: &Args, console: &Console) -> Result<()> {
    let loaded = scenario::load(&given.scenario, &given.set)?;
    let args = &given.over(&loaded)?;
    let recipe = args.recipe(None)?;
    let has_grid = !args.grid.is_empty() || !loaded.scenario.training.grid.is_empty();
    if args.print_recipe && !has_grid && args.data.is_none() {
        return print_recipe(&recipe);
    }
    use_threads(args.threads)?;
    let origin = Origin::new(args)?;
    let material = origin.material()?;
    let recipe = match origin.weighting()? {
        None => recipe,
        own => args.recipe(own)?,
    };
    if args.print_recipe {
        return print_recipe(&recipe);
    }
    material.check(&recipe)?;
    let notes = origin.notes()?;
    console.print_notes(&notes)?;
    let mut settings: checkpoint::CheckpointSettings = recipe.settings()?.into_iter().collect();
    settings.insert("seed".to_owned(), args.seed.to_string());
    settings.extend(origin.settings());
    let of = checkpoint::CheckpointOf { settings, options: given.options() };

    let path = args.output.join("checkpoint");
    let state = args.resume.then(|| checkpoint::load(&path, &of, &recipe)).transpose()?;
    let _held = FolderLock::take(&args.output)?;
    let mut tournament = Tournament::new(&recipe, &*material, args.seed, state);
    if !args.train(&mut tournament, &path, &of, console)? {
        console.note(format_args!("stopped; {} has the state", path.display()));
        return Ok(());
    }
    let scenario = origin.scenario();
    let chain = args.profile.clone().unwrap_or_else(|| scenario.tdc.profile.clone());
    let (command, seed) = (given.command(), args.seed);
    let mut trained_for = scenario.clone();
    trained_for.tdc.profile.clone_from(&chain);
    let domain = Some(domain::of(&trained_for, &origin.ranges())?);
    let record = Record { seed, ..Record::new(&origin.setup()?, &console.command) };
    let made = TrainingOrigin { chain, command, seed, domain, record: &record };
    let (network, rows) = written::write(&args.output, &recipe, &tournament, made, console)?;
    let line = &recipe.weighting;
    let findings = TrainingFindings { rows: &rows, line, network: &network };
    let report = Report { findings, record: Some(record.into()), notes: &notes };
    report.deliver(None, args.json, console)
}

/// Checks the training that a scenario describes.
///
/// # Errors
/// When a number format, the recipe or the grid is none.
pub fn check(loaded: &scenario::Loaded) -> Result<()> {
    let args = Args::usual().over(loaded)?;
    args.recipe(None)?;
    let own = GridOption::parse(&loaded.scenario.training.grid_options());
    let grid = own.and_then(|own| own.grid(&loaded.scenario, GridPurpose::Training));
    grid.map(drop).map_err(|error| of_the_own_grid(error, &loaded.name))
}

/// The text of a recipe's file.
///
/// # Errors
/// When it cannot be read; where there is none, with the names that it may have.
pub fn read_recipe(path: &Path) -> Result<String> {
    if path.exists() {
        return read_text(path);
    }
    let names = Recipe::builtin_names().collect::<Vec<_>>().join(", ");
    let expected = format!("no such file; built-in recipes are {names}, {QUICK}");
    Err(Input::new(path.display(), expected).into())
}

/// Prints a recipe as TOML.
fn print_recipe(recipe: &Recipe) -> Result<()> {
    let text = toml::to_string(recipe).map_err(|error| Input::new("recipe", error))?;
    print(&text)
}
/// Time after which the state is saved, wherever the training is.
const BETWEEN: Duration = Duration::from_secs(15);

/// Prints the progress.
fn say(console: &Console, progress: &Progress, tournament: &Tournament, before: usize) {
    let state = &tournament.state;
    let (done, all) = tournament.progress();
    let percent = 100.0 * done as f64 / all as f64;
    let last = state.curve.iter().rev().take_while(|point| point.stage == before);
    let least = last.map(|point| point.cost).fold(f64::INFINITY, f64::min);
    let text = format!("{percent:5.1} %  stage {before}  least cost {least:.3}");
    progress.suspend(|| {
        if before != state.stage || state.epochs == 0 {
            console.note(text)
        } else {
            console.detail(text)
        }
    });
}

impl Args {
    /// Trains until all is done or there are as many checkpoints as wanted, and saves the state on the
    /// way; whether all is done.
    fn train(
        &self,
        tournament: &mut Tournament,
        path: &Path,
        of: &checkpoint::CheckpointOf,
        console: &Console,
    ) -> Result<bool> {
        let stop = stop_signal();
        let (done, all) = tournament.progress();
        let progress = console.progress(all, "");
        progress.set_position(done);
        progress.reset_eta();
        let mut checkpoints = 0;
        while !tournament.is_over() && self.checkpoints != Some(checkpoints) {
            let before = tournament.state.stage;
            let until = Some(Instant::now() + BETWEEN);
            let watch = Watch { stop: stop.as_deref(), done: &|work| progress.inc(work), until };
            let advanced = tournament.advance(&watch);
            if advanced.is_ok() || tournament.is_between() {
                checkpoint::save(path, of, &tournament.state)?;
            }
            if let Err(Error::Interrupted) = advanced {
                progress.finish_and_clear();
                console.note(format_args!("{} has the state, for --resume", path.display()));
            }
            if advanced? {
                checkpoints += 1;
                say(console, &progress, tournament, before);
            }
            progress.set_position(tournament.progress().0);
        }
        progress.finish_and_clear();
        Ok(tournament.is_over())
    }

    /// The recipe with all that the options say, over one with this weighting or the thesis's.
    fn recipe(&self, weighting: Option<Weighting>) -> Result<Recipe> {
        let base = if self.quick { Recipe::quick() } else { Recipe::default() };
        let weighting = weighting.unwrap_or_else(|| base.weighting.clone());
        let base = Recipe { weighting, ..base };
        let (text, name) = match &self.recipe {
            Some(path) => {
                let name = path.display().to_string();
                let text = match Recipe::builtin_text(&name) {
                    Some(text) => text.to_owned(),
                    None => read_recipe(path)?,
                };
                (text, name)
            }
            None => (String::new(), "recipe".to_owned()),
        };
        let mut recipe = Recipe::parse(&text, &base, &self.with, &name)?;
        recipe.neurons = self.neurons.unwrap_or(recipe.neurons);
        self.formats.put_over(&mut recipe.formats);
        if let (Some(starts), Some(first)) = (self.starts, recipe.stages.first_mut()) {
            first.candidates = starts;
            for stage in &mut recipe.stages {
                stage.candidates = stage.candidates.min(starts);
            }
            recipe.finish.candidates = recipe.finish.candidates.min(starts);
        }
        recipe.check()?;
        Ok(recipe)
    }

    /// The command that trains the same network again.
    fn command(&self) -> String {
        ["tofsim train".to_owned()].into_iter().chain(self.options()).collect::<Vec<_>>().join(" ")
    }

    /// The options that decide what comes out.
    fn options(&self) -> Vec<String> {
        let mut options = Vec::new();
        let mut add = |option: &str, value: &dyn std::fmt::Display| {
            let value = value.to_string();
            let plain = |c: char| c.is_ascii_alphanumeric() || "._-/=+,:".contains(c);
            let quoted = if value.chars().all(plain) {
                value
            } else {
                format!("'{}'", value.replace('\'', r"'\''"))
            };
            options.push(format!("{option}{quoted}"));
        };
        if self.scenario != scenario::DEFAULT {
            add("", &self.scenario);
        }
        self.set.iter().for_each(|set| add("-s ", set));
        self.profile.iter().for_each(|profile| add("--profile ", profile));
        self.grid.iter().for_each(|grid| add("--grid ", grid));
        self.data.iter().for_each(|path| add("--data ", &path.display()));
        self.truth.iter().for_each(|path| add("--truth ", &path.display()));
        add("--seed ", &self.seed);
        if self.quick {
            add("--quick", &"");
        }
        self.recipe.iter().for_each(|path| add("--recipe ", &path.display()));
        self.with.iter().for_each(|with| add("--with ", with));
        self.neurons.iter().for_each(|neurons| add("--neurons ", neurons));
        self.formats.options().iter().for_each(|(option, value)| add(option, value));
        self.starts.iter().for_each(|starts| add("--starts ", starts));
        options
    }
}
