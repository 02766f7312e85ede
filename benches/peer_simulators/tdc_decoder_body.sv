    // The taps are counted at once with $countones, and each stage works only when it has something new.
    localparam integer OnesBits = $clog2(Taps + 1), EdgeBits = $clog2(Cycle + 1) + CoarseBits;
    localparam integer CodeBits = BinBits + Digits, LongBits = EdgeBits > AgeBits ? EdgeBits : AgeBits;
    localparam integer TimeBits = 1 + (LongBits > CodeBits ? LongBits : CodeBits);

    reg first_valid, second_valid, age_valid, t_valid;
    reg [OnesBits-1:0] first, second;
    reg [CoarseBits-1:0] first_coarse, second_coarse, n_coarse, age_coarse;
    reg [AgeBits-1:0] age;
    reg signed [TimeBits-1:0] t;

    reg [AgeBits-1:0] cal [0:Taps];
    initial $readmemh(CalFile, cal);

    initial begin
        {tdc_valid, first_valid, second_valid, n_valid, age_valid, t_valid} = 6'd0;
        tdc_code = 0;
        {first, second, n} = 0;
        {first_coarse, second_coarse, n_coarse, age_coarse} = 0;
        age = 0;
        t = 0;
    end

    wire two = CountStages == 2'd2;
    wire is_code = t_valid && t[TimeBits-1:CodeBits] == 0;

    always @(posedge clk_sys) begin
        if (hit) {first, first_coarse} <= {OnesBits'($countones(hit_taps)), hit_coarse};
        if (first_valid) {second, second_coarse} <= {first, first_coarse};
        if (two ? first_valid : second_valid)
            {n, n_coarse} <= two ? {first, first_coarse} : {second, second_coarse};
        if (n_valid) {age, age_coarse} <= {cal[n], n_coarse};
        // A negative time shows in the sign.
        if (age_valid) t <= TimeBits'(Cycle * (32'(age_coarse) + 1)) - TimeBits'(Calibrated ? calibrated_age : age);
        if (rst) begin
            {tdc_valid, first_valid, second_valid, n_valid, age_valid, t_valid} <= 6'd0;
            tdc_code <= 0;
        end else begin
            first_valid <= hit;
            second_valid <= first_valid;
            n_valid <= two ? first_valid : second_valid;
            age_valid <= n_valid;
            t_valid <= age_valid;
            tdc_valid <= is_code;
            if (is_code) tdc_code <= t[CodeBits-1:Digits];
        end
    end
endmodule
