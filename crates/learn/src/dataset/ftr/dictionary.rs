//! The strings of an FTR file.

use std::collections::HashMap;

use tofsim::error::Result;

use super::chunks::{Chunks, encoded};

/// Tag of a chunk with strings.
const DICTIONARY: u64 = 8;

/// Strings by number. Those that are new are written before the chunk that refers to them.
pub(super) struct Dictionary {
    ids: HashMap<String, u64>,
    /// Strings that are not written yet, in the order of their numbers.
    new: Vec<String>,
}

impl Default for Dictionary {
    /// The empty string alone, which has the number 0.
    fn default() -> Self {
        let mut dictionary = Dictionary { ids: HashMap::new(), new: Vec::new() };
        dictionary.id("");
        dictionary
    }
}

impl Dictionary {
    /// Returns the number of a string.
    pub(super) fn id(&mut self, text: &str) -> u64 {
        if let Some(id) = self.ids.get(text) {
            return *id;
        }
        let id = self.ids.len() as u64;
        self.ids.insert(text.to_owned(), id);
        self.new.push(text.to_owned());
        id
    }

    /// Writes the strings that are new.
    pub(super) fn write(&mut self, chunks: &mut Chunks) -> Result<()> {
        if self.new.is_empty() {
            return Ok(());
        }
        let first = (self.ids.len() - self.new.len()) as u64;
        let content = encoded(|cbor| {
            cbor.map(self.new.len() as u64)?;
            for (id, text) in (first..).zip(&self.new) {
                cbor.u64(id)?.str(text)?;
            }
            Ok(())
        });
        chunks.write(DICTIONARY, &[], &chunks.checked(content)?)?;
        self.new.clear();
        Ok(())
    }
}
