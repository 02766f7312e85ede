`default_nettype none

// A chain in C++ (driver.cpp), because CXXRTL knows no time.
(* cxxrtl_blackbox *)
module carry_chain #(
    parameter DelaysFile = "rtl_ref/tap_delays.mem"
) (
    (* cxxrtl_edge = "p" *) input wire clk_125,
    input wire tdc_stop,
    (* cxxrtl_sync *) output wire [799:0] taps
);
endmodule
