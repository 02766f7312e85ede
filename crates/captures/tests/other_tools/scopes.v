`timescale 1ps / 1ps
`default_nettype none

module scopes_stage #(parameter Width = 2) (input wire [Width - 1:0] a, output reg [Width:0] y);
  always @* y = a + 1;
endmodule

// Names: generate statements, instances, tasks, functions, named blocks and escaped identifiers.
module scopes;
  reg [7:0] data = 0;
  reg \a.b = 0;
  reg [1:0] \c[3] = 0;
  reg \-+*/ = 0;
  wire [3:0] \sum:1 ;
  wire [2:0] sums [0:2];
  genvar k, j;
  generate
    for (k = 0; k < 3; k = k + 1) begin : each
      wire [1:0] part = data[2 * k +: 2];
      scopes_stage stage (.a(part), .y(sums[k]));
      for (j = 0; j < 2; j = j + 1) begin : inner
        wire bit_of = part[j] ^ data[7];
      end
    end
    if (1) begin : chosen
      wire all = &data[1:0];
    end
  endgenerate
  scopes_stage #(3) \odd.stage (.a(data[4:2]), .y(\sum:1 ));

  task add(input [7:0] amount);
    reg [7:0] next;
    begin
      next = data + amount;
      data = next;
    end
  endtask
  function [7:0] twice(input [7:0] value);
    twice = 2 * value;
  endfunction

  initial begin : steps
    integer step;
    $dumpfile(`FILE);
    $dumpvars(0, scopes);
    $timeformat(-12, 0, "", 0);
    $display({"time_ps;bits[7:0] scopes.data;bits scopes.\\a.b;bits[1:0] scopes.\\c[3];bits scopes.\\-+*/;",
      "bits[1:0] scopes.each[0].part;bits[1:0] scopes.each[1].part;bits[1:0] scopes.each[2].part;",
      "bits[2:0] scopes.each[0].stage.y;bits[2:0] scopes.each[1].stage.y;bits[2:0] scopes.each[2].stage.y;",
      "bits[1:0] scopes.each[1].stage.a;bits scopes.each[0].inner[1].bit_of;bits scopes.each[2].inner[0].bit_of;",
      "bits scopes.chosen.all;bits[7:0] scopes.add.amount;bits[7:0] scopes.add.next;",
      "bits[7:0] scopes.twice.value;bits[31:0] scopes.steps.step;",
      "bits[3:0] scopes.\\sum:1;bits scopes.each[0].inner[0].bit_of;bits[1:0] scopes.each[0].stage.a;",
      "bits scopes.each[1].inner[0].bit_of;",
      "bits scopes.each[1].inner[1].bit_of;bits scopes.each[2].inner[1].bit_of;bits[1:0] scopes.each[2].stage.a;",
      "bits[2:0] scopes.odd.stage.a;bits[3:0] scopes.odd.stage.y"});
    $monitor("%0t;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b",
      $realtime, data, \a.b , \c[3] , \-+*/ ,
      each[0].part, each[1].part, each[2].part, each[0].stage.y, each[1].stage.y, each[2].stage.y, each[1].stage.a,
      each[0].inner[1].bit_of, each[2].inner[0].bit_of, chosen.all, add.amount, add.next, twice.value,
      step, \sum:1 , each[0].inner[0].bit_of, each[0].stage.a, each[1].inner[0].bit_of, each[1].inner[1].bit_of,
      each[2].inner[1].bit_of, each[2].stage.a, \odd.stage .a, \odd.stage .y);
    for (step = 0; step < 4; step = step + 1) begin
      #7 add(8'h2b + step);
      \a.b = ~\a.b ;
      \c[3] = \c[3] + 1;
      if (step == 2) \-+*/ = 1;
      #3 data = twice(data);
    end
    #5 $finish(0);
  end
endmodule
