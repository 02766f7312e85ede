    wire {range}counts;
    assign count = read_en ? counts[16 * read_addr +: 16] : 16'd0;
