//! An FTR file as `ftr_parser` reads it, which is not ours.

use std::collections::BTreeMap;
use std::path::Path;

use ftr_parser::parse::parse_ftr;
use ftr_parser::types::{FTR, TransactionId};

/// A transaction.
#[derive(Clone, Debug, PartialEq)]
pub struct Tx {
    pub id: u64,
    pub begin: u64,
    pub end: u64,
    pub attributes: BTreeMap<String, String>,
}

impl Tx {
    pub fn attribute(&self, name: &str) -> &str {
        self.attributes.get(name).unwrap_or_else(|| panic!("no {name}: {self:?}"))
    }

    pub fn number(&self, name: &str) -> i64 {
        self.attribute(name).parse().unwrap()
    }
}

/// The transactions of each stream, and relations by name: source and sink.
pub struct Transactions {
    pub streams: BTreeMap<String, Vec<Tx>>,
    pub relations: BTreeMap<String, Vec<(u64, u64)>>,
}

impl Transactions {
    pub fn open(path: &Path) -> Self {
        let mut file = parse_ftr(path.to_owned()).unwrap();
        let ids: Vec<_> = file.tx_streams.keys().copied().collect();
        ids.into_iter().for_each(|id| file.load_stream_into_memory(id).unwrap());
        let mut relations = BTreeMap::<_, Vec<_>>::new();
        for relation in &file.tx_relations {
            let [source, sink] = [relation.source_tx_id, relation.sink_tx_id].map(number);
            let name = [relation.source_stream_id, relation.sink_stream_id]
                .map(|id| file.get_stream(id).unwrap().name.clone());
            assert_eq!(relation.name, format!("{} of {}", name[1], name[0]));
            relations.entry(relation.name.clone()).or_default().push((source, sink));
        }
        Transactions { streams: streams(&file), relations }
    }

    pub fn of(&self, stream: &str) -> &[Tx] {
        &self.streams[stream]
    }

    /// The one transaction of a stream that comes from another.
    pub fn next(&self, stream: &str, source: &Tx) -> &Tx {
        let is_of = |name: &&String| name.starts_with(&format!("{stream} of"));
        let pairs = self.relations.iter().filter(|(name, _)| is_of(name)).flat_map(|(_, all)| all);
        let sinks: Vec<_> = pairs.filter(|(from, _)| *from == source.id).collect();
        assert_eq!(sinks.len(), 1, "{stream} of {source:?}");
        self.of(stream).iter().find(|tx| tx.id == sinks[0].1).unwrap()
    }
}

fn streams(file: &FTR) -> BTreeMap<String, Vec<Tx>> {
    let mut streams = BTreeMap::new();
    for stream in file.tx_streams.values() {
        let [generator] = stream.generators[..] else { panic!("{:?}", stream.generators) };
        let generator = file.get_generator(generator).unwrap();
        assert_eq!(generator.name, stream.name);
        let transactions = generator.transactions.iter().map(|one| Tx {
            id: number(one.get_tx_id()),
            begin: one.get_start_time().try_into().unwrap(),
            end: one.get_end_time().try_into().unwrap(),
            attributes: one.attributes.iter().map(|one| (one.name.clone(), one.value())).collect(),
        });
        streams.insert(stream.name.clone(), transactions.collect());
    }
    streams
}

fn number(id: TransactionId) -> u64 {
    id.0 as u64
}
