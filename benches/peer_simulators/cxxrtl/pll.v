`default_nettype none

// Clocks that driver.cpp sets.
(* cxxrtl_blackbox *)
module pll #(
    parameter [63:0] LockTime = 64'd1000000
) (
    input wire clk_200,
    (* cxxrtl_sync *) output wire clk_125,
    (* cxxrtl_sync *) output wire clk_250,
    (* cxxrtl_sync *) output wire locked
);
endmodule
