//! Steps a block and keeps what goes in and what comes out.

use tofsim::error::Result;
use tofsim::firmware::tof_top::{Pins, TofTop};
use tofsim::hierarchy::{self, fitted};
use tofsim::kernel::signals::{Signal, Signals};

use super::block::Block;
use super::columns::{Compared, inputs};
use super::draw::Draw;
use super::setting::Setting;
use super::spec::{Spec, Vectors};
use super::table::{LineSink, Table};

/// The vectors of a block that is stepped alone.
///
/// # Errors
/// None: it is a [`Record`](super::spec::Record), as is that of the whole firmware, which may fail.
pub fn record<B: Block>(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut block = B::new(setting);
    let neurons = setting.neurons();
    let entries = hierarchy::every_entry_of(neurons);
    let Compared { columns, places } = Compared::new(spec, &entries, |_| true);
    let mut expected = Table::new(columns);
    let signals: Vec<_> =
        B::Stimulus::list().into_iter().map(|signal| fitted(signal, neurons)).collect();
    let mut next = 0..;
    let column = |signal: &Option<Signal>| signal.iter().zip(&mut next).map(|(_, n)| n).collect();
    let own_places: Vec<Vec<usize>> = signals.iter().map(column).collect();
    let signals: Vec<_> = signals.into_iter().flatten().collect();
    let mut stimulus = Table::new(inputs(&signals));
    let order = setting.setup.params.tdc.delays.order();

    let mut draw = Draw::new(setting.seed, spec.stream());
    let mut top = TofTop::new(Pins::default());
    for cycle in 0..setting.cycles() {
        let i = block.stimulus(cycle, &top, &mut draw);
        let mut fill = LineSink { table: &mut stimulus, places: &own_places, order };
        i.changes(None, 0, &mut fill);
        stimulus.push();
        let mut samples = places.iter();
        block.cycle(cycle, &i, &mut top, &mut |top| {
            if let Some(places) = samples.next() {
                let mut fill = LineSink { table: &mut expected, places, order };
                hierarchy::changes(top, None, &mut fill);
            }
        });
        expected.push();
    }
    Ok(Vectors {
        spec,
        seed: setting.seed,
        source: setting.setup.name.clone(),
        neurons,
        parameters: block.parameters(),
        stimulus,
        expected,
        first_edge_ps: spec.timing.period_ps(),
        stops: block.stops().to_vec(),
        bench_memory: block.bench_memory(),
        coverage: block.coverage(),
    })
}
