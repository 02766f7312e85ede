    wire [{high}:0] {vector}_words [{first}:{last}];
    generate
        for (genvar k = 0; k < {bins}; k = k + 1) begin : {vector}_word
            assign {to} = {from};
        end
    endgenerate
