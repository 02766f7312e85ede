// What registers wait for. With SELF_CLOCKED (bench.sv) a clock changes once for each of its edges
// that matters: clk_125 where a real one would rise, clk_250 where it would rise or fall, which
// pll.rises tells. clk_awake is clk_125 without the cycles in the midst of a frame, for blocks
// that would only keep what they have in those.
`ifndef EDGE_SVH
`define EDGE_SVH
`ifdef SELF_CLOCKED
`define RISE_125 edge clk_125
`define RISE_AWAKE edge tof_top.pll.clk_awake
`else
`define RISE_125 posedge clk_125
`define RISE_AWAKE posedge clk_125
`endif
`endif
