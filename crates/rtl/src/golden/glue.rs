//! Connection of an estimator's `count` in its bench: words of histograms from a memory.

use tofsim::kernel::sizes::Sizes;

/// An input that answers an output within the cycle, and so is no part of a line: `count`, the word at `read_addr` of
/// the stimulus's `histogram`.
#[derive(Clone, Copy, Debug)]
pub struct Glue {
    /// Number of histograms.
    pub histograms: usize,
    /// True if the word is 0 while `read_en` is low, as the histogram builder's is.
    pub gated: bool,
}

impl Glue {
    /// The input port.
    pub const DRIVES: &str = "count";

    /// Words of the memory.
    fn words(&self, sizes: &Sizes) -> usize {
        self.histograms * sizes.bins as usize
    }

    /// Its declaration and driver in a bench in Verilog.
    pub fn verilog(&self, sizes: &Sizes) -> String {
        let (bits, words) = (sizes.count_bits, self.words(sizes));
        let word = "histograms[{histogram, read_addr}]";
        let count =
            if self.gated { format!("read_en ? {word} : {bits}'d0") } else { word.to_owned() };
        format!(
            "  reg [{0}:0] histograms [0:{1}];\n  \
               initial $readmemh(\"histograms.mem\", histograms);\n  \
               wire [{0}:0] count = {count};\n",
            bits - 1,
            words - 1
        )
    }

    /// The declaration of the memory, and the driver, in a bench in VHDL.
    pub fn vhdl(&self, sizes: &Sizes) -> [String; 2] {
        let (bits, words) = (sizes.count_bits, self.words(sizes));
        let else_zeros =
            if self.gated { " when read_en = '1'\n    else (others => '0')" } else { "" };
        [
            format!(
                "constant histograms : words(0 to {}) := read_words(\"histograms.mem\", {words});",
                words - 1
            ),
            format!(
                "count <= std_logic_vector(to_unsigned(histograms(\n    \
                 to_integer(unsigned(histogram) & unsigned(read_addr))), {bits})){else_zeros};"
            ),
        ]
    }
}
