    wire {range}counts;
    assign count = read_en ? counts[{bits} * read_addr +: {bits}] : {bits}'d0;
