//! The address of `tansig`: the rounding that its Verilog has, against the definition, for every sum.

use std::fs;

use tofsim_rtl::verify::process::YOSYS;

use crate::common;

use super::yosys::{self, LIMITS};

/// The function `address` in a module that asserts that it rounds sums of so many bits half up, then saturates.
fn proof(function: &str, sum_bits: u32) -> String {
    format!(
        "module proof (input signed [{sum_bits}-1:0] sum);
    localparam integer AddressBits = 12, Shift = 14, SumBits = {sum_bits};
    localparam signed [SumBits:0] Limit = 42'sd1 <<< (AddressBits - 1);
    {function}
    wire signed [SumBits:0] wide = {{sum[SumBits-1], sum}};
    wire signed [SumBits:0] rounded = (wide + (42'sd1 <<< (Shift - 1))) >>> Shift;
    wire signed [SumBits:0] limited = rounded >= Limit ? Limit - 42'sd1 : rounded < -Limit ? -Limit : rounded;
    always @* assert (address(sum) == limited[AddressBits-1:0]);
endmodule
"
    )
}

/// The function as the Verilog has it, with the constant that it looks at.
fn address() -> String {
    const END: &str = "endfunction";
    let sources = yosys::rtl_ref();
    let text = &sources["tansig.v"];
    let begin = text.find("localparam integer Sign").unwrap();
    let end = begin + text[begin..].find(END).unwrap() + END.len();
    text[begin..end].to_owned()
}

/// Whether Yosys proves it, of sums of so many bits.
fn is_proven(function: &str, sum_bits: u32) -> bool {
    let folder = common::empty();
    fs::write(folder.path().join("proof.sv"), proof(function, sum_bits)).unwrap();
    let script = "read_verilog -sv -formal proof.sv; hierarchy -top proof; proc; opt; sat -prove-asserts proof";
    let finished = YOSYS.run(folder.path(), ["-p", script], &LIMITS).unwrap();
    assert!(finished.success(), "{}", finished.output);
    let says = |text| finished.output.contains(text);
    let proven = says("SAT proof finished - no model found: SUCCESS!");
    assert!(proven || says("SAT proof finished - model found: FAIL!"), "{}", finished.output);
    proven
}

#[test]
fn the_address_of_every_sum_is_rounded_half_up_and_saturated() {
    let address = address();
    for sum_bits in [36, 41] {
        assert!(is_proven(&address, sum_bits), "{sum_bits}: {address}");
    }
    // Another shift of what is looked at, in whatever form it is written.
    let fault = address.replace("Shift - 1", "Shift - 2").replace("Shift-1", "Shift-2");
    assert!(fault != address && !is_proven(&fault, 36), "{fault}");
}
