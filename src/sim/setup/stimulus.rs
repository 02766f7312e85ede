//! Where codes, histogram and light come from: the optics, or files that the scenario names.

use crate::error::{Input, Result};
use crate::files::csv::CsvInput;
use crate::firmware::histogram_preload;
use crate::firmware::tof_top::{CodeSource, HistogramSource};
use crate::kernel::U;
use crate::network::histogram_file;
use crate::scenario::Scenario;
use crate::scenario::builtin::Source;
use crate::sensor::light::Light;
use crate::sensor::photon_list::{Given, PhotonList};

/// Sources of codes and histogram, and the light unless it comes from the link budget.
pub(super) fn stimulus(
    scenario: &Scenario,
    files: &Source,
) -> Result<(CodeSource, HistogramSource, Option<Light>)> {
    let stimulus = &scenario.stimulus;
    if let Some(name) = &stimulus.photons {
        let (source, text) = files.read(name)?;
        let light = Light::List(Given::new(PhotonList::parse(&source, &text)?));
        return Ok((CodeSource::Tdc, HistogramSource::Builder, Some(light)));
    }
    if let Some(name) = &stimulus.codes {
        let (source, text) = files.read(name)?;
        let codes = CodeSource::Preload(codes(&source, &text)?);
        return Ok((codes, HistogramSource::Builder, Some(Light::None)));
    }
    if let Some(name) = &stimulus.histogram {
        let (source, text) = files.read(name)?;
        let counts = histogram_file::parse_csv(&source, &text)?;
        let rom: histogram_preload::Rom = counts.map(|count| U::new(count as u64));
        let rom = HistogramSource::Preload(Box::new(rom));
        return Ok((CodeSource::Tdc, rom, Some(Light::None)));
    }
    Ok((CodeSource::Tdc, HistogramSource::Builder, None))
}

/// Words of the code ROM.
const CODES: usize = 1 << 16;

fn codes(source: &str, text: &str) -> Result<Box<[U<8>]>> {
    let mut input = CsvInput::new(source, text, &["code"])?;
    let mut codes = Vec::new();
    while input.advance()? {
        match input.field::<u8>(0) {
            Some(code) if codes.len() < CODES => codes.push(U::new(code as u64)),
            Some(_) => {
                return Err(input.fault(0, format!("expected {CODES} codes at most")).into());
            }
            None => return Err(input.fault(0, "expected a code from 0 to 255").into()),
        }
    }
    if codes.is_empty() {
        return Err(Input::new(source, "expected at least one code").into());
    }
    Ok(codes.into_boxed_slice())
}
