    wire {range}counts;
    wire [7:0] address = clear ? clear_addr : tdc_valid ? tdc_code : read_addr;
    assign count = read_en ? counts[16 * address +: 16] : 16'd0;
