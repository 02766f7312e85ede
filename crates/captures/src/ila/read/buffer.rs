//! Samples of an archive in memory, stored as one row of bits per channel.

use tofsim::error::Result;

use crate::words::{bit, fill};

use super::line::Line;
use super::opened::{CaptureRow, CaptureRows, Column, LARGEST};

/// Samples with their marks.
#[derive(Clone, Debug, Default)]
pub(super) struct Buffer {
    /// Number of samples.
    pub(super) samples: u64,
    /// First sample of each window.
    pub(super) windows: Vec<u64>,
    /// Samples that triggered.
    pub(super) triggers: Vec<u64>,
    /// Samples at which nothing was stored.
    pub(super) gaps: Vec<u64>,
    /// Words per channel.
    stride: usize,
    /// Bits of all channels, 64 samples per word.
    bits: Vec<u64>,
    channels: usize,
}

impl Buffer {
    /// Sets the number of samples, while there are no channels.
    pub(super) fn size(&mut self, samples: u64) {
        self.samples = samples;
        self.stride = samples.div_ceil(64) as usize;
    }

    /// Adds the channel in a line of a dump.
    pub(super) fn channel(&mut self, line: &Line) -> Result<()> {
        self.channels += 1;
        line.channel(self.samples, &mut self.bits)
    }

    /// Adds `width` channels of zeros, and returns the number of the first; `None` if the size limit is exceeded.
    pub(super) fn add(&mut self, width: u32) -> Option<usize> {
        let low = self.channels;
        let channels = low + width as usize;
        if (channels as u64).saturating_mul(self.samples) > LARGEST {
            return None;
        }
        self.channels = channels;
        self.bits.resize(channels * self.stride, 0);
        Some(low)
    }

    /// Stores the marks of a row for its sample. A row with unknown bits counts as a gap.
    pub(super) fn mark(&mut self, row: &CaptureRow, sample: u64) {
        let is_unknown = row.gap || row.unknown.iter().any(|&word| word != 0);
        let marks = [
            (row.window_start, &mut self.windows),
            (row.trigger, &mut self.triggers),
            (is_unknown, &mut self.gaps),
        ];
        for (is_so, marks) in marks {
            marks.extend(is_so.then_some(sample));
        }
    }

    /// Sets `width` channels from `low` on at a sample.
    pub(super) fn put(&mut self, low: usize, width: u32, sample: u64, value: &[u64]) {
        for k in 0..width {
            let word = &mut self.bits[(low + k as usize) * self.stride + (sample / 64) as usize];
            *word &= !(1 << (sample % 64));
            *word |= bit(value, k) << (sample % 64);
        }
    }

    /// Copies `width` channels from `low` on at a sample to `value`; the width is not 0.
    pub(super) fn get(&self, low: usize, width: u32, sample: u64, value: &mut [u64]) {
        for k in 0..width as usize {
            let word = self.bits[(low + k) * self.stride + (sample / 64) as usize];
            value[k / 64] |= (word >> (sample % 64) & 1) << (k % 64);
        }
    }

    /// Returns the samples as rows of `columns`, whose lowest channels are `places`.
    pub(super) fn rows(self, columns: Vec<Column>, places: Vec<usize>) -> impl CaptureRows + use<> {
        BufferRows { buffer: self, columns, places, next: 0 }
    }
}

/// Iterator over the samples as rows.
struct BufferRows {
    buffer: Buffer,
    columns: Vec<Column>,
    places: Vec<usize>,
    next: u64,
}

impl CaptureRows for BufferRows {
    fn next(&mut self, row: &mut CaptureRow) -> Result<bool> {
        let (sample, buffer) = (self.next, &self.buffer);
        if sample == buffer.samples {
            return Ok(false);
        }
        self.next += 1;
        let windows = buffer.windows.partition_point(|&window| window <= sample);
        let begin = windows.checked_sub(1).map_or(0, |window| buffer.windows[window]);
        row.sample = sample;
        row.in_window = sample - begin;
        row.window_start = sample == begin;
        row.trigger = buffer.triggers.binary_search(&sample).is_ok();
        row.gap = buffer.gaps.binary_search(&sample).is_ok();
        row.clear(&self.columns);
        for (column, &low) in self.columns.iter().zip(&self.places) {
            if row.gap {
                fill(&mut row.unknown[column.place()], column.bits())
            } else {
                buffer.get(low, column.bits(), sample, &mut row.value[column.place()])
            }
        }
        Ok(true)
    }
}
