//! VCD, FST and GHW, read by the crate `wellen`.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use std::thread;

use wellen::stream::{Filter, StreamError, StreamingWaveform};
use wellen::{FileFormat, Hierarchy, LoadOptions, SignalEncoding, SignalRef, SignalValueRef, Var};

use tofsim::error::{Error, Input, Result};

use super::end::end;
use super::guard::{Fault, InOrder, READER, guarded};
use super::library::{Words, fault};
use super::loaded;
use super::locate::located;
use super::marks::{Marking, Style};
use super::names::Name;
use super::signals::{self, Axis, Signal, SignalKind, Source, SourceFormat};
use super::stream::{Cursor, Feed, Gone};
use super::tick::Tick;

/// Widest signal that is read [bits].
const WIDEST: u32 = 1 << 20;
/// Bytes read at once.
const CHUNK: usize = 1 << 17;

/// Where a waveform is.
#[derive(Clone, Debug)]
struct Origin {
    path: PathBuf,
    format: SourceFormat,
    /// Signal of the library for each id.
    references: Vec<SignalRef>,
    /// The marks of a logic analyser.
    marks: Option<Style>,
}

/// A waveform whose head has been read, and the fault found in it later.
struct Opened {
    wave: StreamingWaveform<BufReader<InOrder<File>>>,
    fault: Arc<OnceLock<Fault>>,
}

fn open(path: &Path) -> Result<Opened> {
    let file = File::open(path).map_err(Error::io(path, "read"))?;
    let options = LoadOptions { multi_thread: false, remove_scopes_with_empty_name: true };
    let found = Arc::new(OnceLock::new());
    let guard = InOrder::new(file, Arc::clone(&found));
    let guard = if format(path)? == FileFormat::Fst { guard.unwatched() } else { guard };
    let input = BufReader::with_capacity(CHUNK, guard);
    let wave = wellen::stream::read(input, &options);
    let wave =
        wave.map_err(|error| found.get().map_or_else(|| fault(path, error), |f| at(path, f)))?;
    Ok(Opened { wave, fault: found })
}

fn at(path: &Path, fault: &Fault) -> Error {
    Input::new(path.display(), &fault.text).at(fault.line, 1).into()
}

/// Does something in a thread whose panics are not shown.
fn apart<T: Send>(path: &Path, work: impl FnOnce() -> Result<T> + Send) -> Result<T> {
    let source = path.display().to_string();
    thread::scope(|scope| {
        let work = || guarded(&source, work);
        let thread = thread::Builder::new().name(READER.to_owned()).spawn_scoped(scope, work);
        let thread = thread.map_err(Error::io(path, "read"))?;
        thread.join().unwrap_or_else(|_| Err(Input::new(&source, "cannot be read").into()))
    })
}

/// The source at `path`, of that format as far as the library tells.
pub(super) fn source(path: &Path) -> Result<Source> {
    apart(path, || {
        if format(path)? == FileFormat::Ghw {
            return loaded::hierarchy(path, |hierarchy| described(path, hierarchy));
        }
        let opened = open(path)?;
        described(path, opened.wave.hierarchy())
    })
}

fn format(path: &Path) -> Result<FileFormat> {
    let file = File::open(path).map_err(Error::io(path, "read"))?;
    Ok(wellen::viewers::detect_file_format(&mut BufReader::new(file)))
}

fn described(path: &Path, hierarchy: &Hierarchy) -> Result<Source> {
    let source = path.display().to_string();
    let mut signals = Vec::new();
    let mut references: Vec<SignalRef> = Vec::new();
    let mut ids = std::collections::HashMap::new();
    for var in hierarchy.all_vars().map(|var| &hierarchy[var]) {
        let reference = var.signal_ref();
        let id = *ids.entry(reference).or_insert_with(|| {
            references.push(reference);
            references.len() - 1
        });
        signals.push(signal(var, hierarchy, id));
    }
    if let Some(wide) = signals.iter().find(|signal| signal.width > WIDEST) {
        let expected = format!("expected {WIDEST} bits at most");
        return Err(Input::new(source, expected).field(&wide.name.text).value(wide.width).into());
    }
    let format = match hierarchy.file_format() {
        FileFormat::Fst => SourceFormat::Fst,
        FileFormat::Ghw => SourceFormat::Ghw,
        FileFormat::Vcd | FileFormat::Unknown => SourceFormat::Vcd,
    };
    let marks =
        (format == SourceFormat::Vcd).then(|| Style::of(&signals, hierarchy.version())).flatten();
    let axis = match &marks {
        Some(_) => Axis::Samples,
        None => Axis::Time(tick(&source, hierarchy)?),
    };
    if let Some(style) = &marks {
        style.hide(&mut signals);
    }
    Ok(Source {
        name: source,
        format: if marks.is_some() { SourceFormat::IlaVcd } else { format },
        axis,
        signals,
        end: if marks.is_some() { None } else { end(path, format)? },
        radix_told: marks.is_none(),
        origin: Arc::new(Origin { path: path.to_owned(), format, references, marks }),
    })
}

fn signal(var: &Var, hierarchy: &Hierarchy, id: usize) -> Signal {
    let (kind, width) = match var.signal_encoding(hierarchy) {
        SignalEncoding::BitVector(0) | SignalEncoding::String => (SignalKind::Other, 0),
        SignalEncoding::BitVector(width) => (SignalKind::Bits, width),
        SignalEncoding::Real => (SignalKind::Real, 64),
    };
    // The library makes scopes of the indices of arrays.
    let name = Name::new(var.full_name(hierarchy).replace(".[", "["));
    let lsb = var.index().map_or(0, |index| index.lsb());
    Signal { name, width, lsb, kind, radix: None, shape: None, id }
}

fn tick(source: &str, hierarchy: &Hierarchy) -> Result<Tick> {
    let Some(scale) = hierarchy.timescale() else {
        return Err(Input::new(source, "expected a $timescale").into());
    };
    let tick = scale.unit.to_exponent().and_then(|exponent| Tick::new(scale.factor, exponent));
    let fault = || {
        let expected = "expected a number and one of zs, as, fs, ps, ns, us, ms, s";
        let value = format!("{} {:?}", scale.factor, scale.unit);
        Input::new(source, expected).field("$timescale").value(value).into()
    };
    tick.ok_or_else(fault)
}

impl signals::Origin for Origin {
    fn read(&self, ids: &[usize], widths: &[u32]) -> Result<Cursor> {
        let references: Vec<SignalRef> = ids.iter().map(|&id| self.references[id]).collect();
        let origin = self.clone();
        Ok(Cursor::spawn(widths, move |feed| {
            let source = origin.path.display().to_string();
            let result = guarded(&source, || match origin.format {
                SourceFormat::Ghw => loaded::feed(&origin.path, &references, feed),
                _ => stream(&origin, &references, feed),
            });
            match origin.format {
                SourceFormat::Vcd => result.map_err(|error| located(&origin.path, error)),
                _ => result,
            }
        }))
    }
}

fn stream(origin: &Origin, references: &[SignalRef], feed: &mut Feed) -> Result<()> {
    let Opened { mut wave, fault: found } = open(&origin.path)?;
    let mut marking = origin.marks.as_ref().map(|style| Marking::new(style, &origin.references));
    let mut wanted = references.to_vec();
    wanted.extend(marking.iter().flat_map(Marking::references));
    wanted.sort();
    wanted.dedup();
    let mut places = Places::new(references);
    let mut words = Words::default();
    let result = wave.stream_changes(Filter::include_signals(&wanted), |at, reference, value| {
        feed.at(at)?;
        if let Some(marking) = &mut marking
            && let SignalValueRef::BitVec(bits) = value
        {
            marking.change(reference, at, u8::from(bits.get_bit(0)) == 1, feed);
        }
        for &signal in places.of(reference) {
            words.set(value, feed.words(signal as usize));
            feed.change(signal as usize, &words.value, &words.unknown);
        }
        Ok::<(), Gone>(())
    });
    match result {
        Ok(()) | Err(StreamError::Callback(Gone)) => Ok(()),
        Err(StreamError::Wellen(error)) => {
            Err(found.get().map_or_else(|| fault(&origin.path, error), |f| at(&origin.path, f)))
        }
    }
}

/// Signals of the cursor by reference.
struct Places {
    first: Vec<u32>,
    signals: Vec<u32>,
}

impl Places {
    fn new(references: &[SignalRef]) -> Self {
        let count = references.iter().map(|reference| reference.index() + 1).max().unwrap_or(0);
        let mut first = vec![0; count + 1];
        for reference in references {
            first[reference.index() + 1] += 1;
        }
        for index in 0..count {
            first[index + 1] += first[index];
        }
        let mut order: Vec<u32> = (0..references.len() as u32).collect();
        order.sort_by_key(|&signal| references[signal as usize].index());
        Places { first, signals: order }
    }

    #[inline]
    fn of(&mut self, reference: SignalRef) -> &[u32] {
        let index = reference.index();
        match self.first.get(index..index + 2) {
            Some(bounds) => &self.signals[bounds[0] as usize..bounds[1] as usize],
            None => &[],
        }
    }
}
