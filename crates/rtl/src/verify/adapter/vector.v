    reg {range}vector = {whole}'d0;
    reg [{high}:0] word = {address}'d0;
    reg collecting = 1'b0;
    reg go = 1'b0;
    assign read_en = collecting;
    assign read_addr = word;
    always @(posedge clk_sys) begin
        go <= collecting && word == {address}'d{last};
        if (collecting) begin
            vector[{bits} * word +: {bits}] <= count;
            word <= word + {address}'d1;
            collecting <= word != {address}'d{last};
        end else if (algo_start) collecting <= 1'b1;
        if (rst) begin
            word <= {address}'d0;
            collecting <= 1'b0;
            go <= 1'b0;
        end
    end
