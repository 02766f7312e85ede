
    always @* begin
        if (first) assume (rst);
        else assert (in_step && `HOLDS);
    end
endmodule
