//! What a section of an FST file takes from the changes of a signal.

/// The changes of one signal in a section.
pub(super) trait SignalStream {
    /// Appends the value to the initial values of a section.
    fn spell(&self, frame: &mut Vec<u8>);

    /// Exchanges the changes for an empty buffer, at the end of a section.
    fn hand_over(&mut self, buffer: &mut Vec<u8>);
}
