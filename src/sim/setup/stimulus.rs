//! Sources of codes, histogram and light: the optics, or files that the scenario names.

use crate::error::{Input, Result};
use crate::files::csv::CsvInput;
use crate::firmware::histogram_builder::{self, Bin};
use crate::firmware::tof_top::{CodeSource, HistogramSource};
use crate::kernel::U;
use crate::network::histogram_csv;
use crate::scenario::Scenario;
use crate::scenario::builtin::Source;
use crate::sensor::light::Light;
use crate::sensor::photon_list::{Given, PhotonList};

/// Sources of codes and histogram, and the light unless it comes from the link budget.
pub(super) fn stimulus(
    scenario: &Scenario,
    files: &Source,
    size: &histogram_builder::Params,
) -> Result<(CodeSource, HistogramSource, Option<Light>)> {
    let stimulus = &scenario.stimulus;
    if let Some(name) = &stimulus.photons {
        let (source, text) = files.read(name)?;
        let light = Light::List(Given::new(PhotonList::parse(&source, &text)?));
        return Ok((CodeSource::Tdc, HistogramSource::Builder, Some(light)));
    }
    if let Some(name) = &stimulus.codes {
        let (source, text) = files.read(name)?;
        let codes = CodeSource::Preload(codes(&source, &text, size)?);
        return Ok((codes, HistogramSource::Builder, Some(Light::None)));
    }
    if let Some(name) = &stimulus.histogram {
        let (source, text) = files.read(name)?;
        let counts = histogram_csv::parse(&source, &text, size)?;
        let rom = counts.into_iter().map(|count| U::new(count.into())).collect();
        let rom = HistogramSource::Preload(rom);
        return Ok((CodeSource::Tdc, rom, Some(Light::None)));
    }
    Ok((CodeSource::Tdc, HistogramSource::Builder, None))
}

/// Words of the code ROM.
const CODES: usize = 1 << 16;

fn codes(source: &str, text: &str, size: &histogram_builder::Params) -> Result<Box<[Bin]>> {
    let mut input = CsvInput::new(source, text, &["code"])?;
    let mut codes = Vec::new();
    while input.advance()? {
        match input.field::<u64>(0).filter(|code| *code <= size.last_bin()) {
            Some(code) if codes.len() < CODES => codes.push(U::new(code)),
            Some(_) => {
                return Err(input.fault(0, format!("expected {CODES} codes at most")).into());
            }
            None => {
                let expected = format!("expected a code from 0 to {}", size.last_bin());
                return Err(input.fault(0, expected).into());
            }
        }
    }
    if codes.is_empty() {
        return Err(Input::new(source, "expected at least one code").into());
    }
    Ok(codes.into_boxed_slice())
}
