    reg {range}vector = {whole}'d0;
    reg [7:0] word = 8'd0;
    reg collecting = 1'b0;
    reg go = 1'b0;
    assign read_en = collecting;
    assign read_addr = word;
    always @(posedge clk_sys) begin
        go <= collecting && word == 8'd255;
        if (collecting) begin
            vector[16 * word +: 16] <= count;
            word <= word + 8'd1;
            collecting <= word != 8'd255;
        end else if (algo_start) collecting <= 1'b1;
        if (rst) begin
            word <= 8'd0;
            collecting <= 1'b0;
            go <= 1'b0;
        end
    end
