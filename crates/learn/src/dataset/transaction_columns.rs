//! What is known of a transaction, as attributes of FTR and as columns of Parquet.

use std::borrow::Cow;

use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::Result as Written;

use tofsim::sim::estimates::{EchoDepth, Estimate};
use tofsim::sim::transactions::{Content, Estimation, Transaction};

use super::ftr::{FtrValue, Known};
use super::parquet_table::RowGroup;

/// An attribute: name, when it is known, and values.
pub type Attribute = (&'static str, Known, Values);

/// Reads a field of the content of a transaction.
macro_rules! of {
    ($content:pat => $value:expr) => {
        |transaction| match transaction.content {
            $content => $value,
            _ => None,
        }
    };
}

/// The attributes, in the order of the streams that have them.
pub const ATTRIBUTES: [Attribute; 22] = [
    ("frame", Known::Begin, Values::Count(|transaction| Some(transaction.frame))),
    ("shot", Known::Begin, Values::Count(|transaction| transaction.shot)),
    ("laser_en", Known::Begin, Values::Flag(of!(Content::Shot { laser_en } => Some(laser_en)))),
    (
        "cause",
        Known::Begin,
        Values::Word(of!(Content::Photon { cause, .. } => cause.map(|cause| cause.word().into()))),
    ),
    (
        "arrival_fs",
        Known::Begin,
        Values::Number(of!(Content::Photon { arrival_fs, .. } => arrival_fs)),
    ),
    ("n", Known::End, Values::Count(of!(Content::Hit { n, .. } => n))),
    ("coarse", Known::End, Values::Count(of!(Content::Hit { coarse, .. } => coarse))),
    ("code", Known::Begin, Values::Count(of!(Content::Code { code, .. } => Some(code)))),
    ("time_fs", Known::Begin, Values::Count(of!(Content::Code { time, .. } => Some(time.fs())))),
    ("bin", Known::Begin, Values::Count(of!(Content::Count { bin, .. } => Some(bin)))),
    (
        "count_before",
        Known::Begin,
        Values::Count(of!(Content::Count { before, .. } => Some(before))),
    ),
    ("count_after", Known::End, Values::Count(of!(Content::Count { after, .. } => Some(after)))),
    ("hits", Known::Begin, Values::Count(|row| estimation(row).map(|found| found.hits))),
    (
        "estimator",
        Known::Begin,
        Values::Word(|row| estimate(row).map(|found| found.estimator.into())),
    ),
    ("depth_m", Known::End, Values::Real(|row| estimate(row)?.depth_m)),
    (
        "depth_raw",
        Known::End,
        Values::Number(|row| estimate(row)?.depth_raw.map(|word| word.to_bits())),
    ),
    ("sigma_m", Known::End, Values::Real(|row| estimate(row)?.sigma_m)),
    ("valid", Known::End, Values::Flag(|row| estimate(row).map(|found| found.valid))),
    (
        "status",
        Known::End,
        Values::Word(|row| estimate(row).map(|found| found.status.to_string().into())),
    ),
    (
        "status_code",
        Known::End,
        Values::Word(|row| {
            let code = estimate(row)?.status_code;
            (!code.is_unstated()).then(|| code.word().into())
        }),
    ),
    ("second_depth_m", Known::End, Values::Real(|row| second(row).map(|echo| echo.depth_m))),
    ("second_sigma_m", Known::End, Values::Real(|row| second(row).map(|echo| echo.sigma_m))),
];

fn estimation(transaction: &Transaction) -> Option<&Estimation> {
    match &transaction.content {
        Content::Estimation(estimation) => Some(estimation),
        _ => None,
    }
}

fn estimate(transaction: &Transaction) -> Option<&Estimate> {
    estimation(transaction).map(|estimation| &estimation.estimate)
}

fn second(transaction: &Transaction) -> Option<&EchoDepth> {
    estimate(transaction)?.second.as_ref()
}

/// The values of an attribute, where a transaction has any.
#[derive(Clone, Copy)]
pub enum Values {
    /// A number without a sign.
    Count(fn(&Transaction) -> Option<u64>),
    /// A number with a sign.
    Number(fn(&Transaction) -> Option<i64>),
    /// A real number.
    Real(fn(&Transaction) -> Option<f64>),
    /// A word.
    Word(fn(&Transaction) -> Option<Cow<'static, str>>),
    /// A level.
    Flag(fn(&Transaction) -> Option<bool>),
}

impl Values {
    /// Declares the column in a Parquet schema.
    pub fn declaration(self, name: &str) -> String {
        match self {
            Values::Count(_) | Values::Number(_) => format!("optional int64 {name}; "),
            Values::Real(_) => format!("optional double {name}; "),
            Values::Word(_) => format!("optional binary {name} (UTF8); "),
            Values::Flag(_) => format!("optional boolean {name}; "),
        }
    }

    /// Writes the column of some transactions.
    pub fn fill(self, group: &mut RowGroup, rows: &[Transaction]) -> Written<()> {
        let rows = rows.iter();
        match self {
            Values::Count(of) => {
                group.optional::<Int64Type>(rows.map(|row| of(row).map(|n| n as i64)))
            }
            Values::Number(of) => group.optional::<Int64Type>(rows.map(of)),
            Values::Real(of) => group.optional::<DoubleType>(rows.map(of)),
            Values::Word(of) => group.optional::<ByteArrayType>(
                rows.map(|row| of(row).map(|word| ByteArray::from(&*word))),
            ),
            Values::Flag(of) => group.optional::<BoolType>(rows.map(of)),
        }
    }

    /// Returns the value of a transaction as FTR has it.
    pub fn ftr(self, row: &Transaction) -> Option<FtrValue<'static>> {
        match self {
            Values::Count(of) => of(row).map(FtrValue::Unsigned),
            Values::Number(of) => of(row).map(FtrValue::Signed),
            Values::Real(of) => of(row).map(|number| FtrValue::Real(number as f32)),
            Values::Word(of) => of(row).map(FtrValue::Text),
            Values::Flag(of) => of(row).map(FtrValue::Flag),
        }
    }
}
