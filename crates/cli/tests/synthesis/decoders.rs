//! Test that the resources of each decoder equal those in `tofsim tdc --decoders`.

use tofsim::firmware::tdc_decoder::Decoder;
use tofsim_learn::characterisation::decoders::{COSTS, DecoderCost};

use super::cells::Cells;
use super::recorded::MAKER;
use super::yosys;
use crate::common;

#[test]
#[ignore = "long: ./check --full"]
fn the_costs_of_the_decoders_are_those_of_their_netlists() {
    let sources = yosys::rtl_ref();
    let chain = common::setup("kc705", &["tdc.profile=kintex7"]).params.tdc.delays;
    let words = chain.order().iter().enumerate().rev();
    let words = words.map(|(place, &tap)| format!("{:04x}", tap.wrapping_sub(place as u16)));
    let order = format!("{}'h{}", 16 * chain.taps(), words.collect::<String>());
    for ((number, decoder), cost) in Decoder::ALL.into_iter().enumerate().zip(COSTS) {
        let mut command = format!("chparam -set Decoder {number} tdc_decoder");
        if decoder == Decoder::Reordered {
            command += &format!("\nchparam -set Order {order} tdc_decoder");
        }
        let cells = match number {
            // The default, as in the table of all modules.
            0 => Cells::of(&sources, "tdc_decoder"),
            _ => {
                Cells::with(&sources, "tdc_decoder", &format!("tdc_decoder.{decoder:?}"), &command)
            }
        };
        assert!(cells.odd().is_empty(), "{decoder:?}: {:?}", cells.odd());
        let luts = cells.count("LUT") + cells.count("INV");
        if cells.maker == MAKER {
            assert_eq!(DecoderCost { luts, ffs: cells.count("FD") }, cost, "{decoder:?}");
        }
    }
}
