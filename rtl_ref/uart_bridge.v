`timescale 1ps / 1fs
`default_nettype none

// Lets a host read and write registers over a serial line, by LiteX's UARTBone. Bytes have 8 data bits, no parity and one
// stop bit; words and addresses come with the most significant byte first.
//
//   byte   0        1       2 .. 5   6 ..
//   host   command  length  address  words of a write
//   here                             words of a read
//
// Commands 1 and 3 write, 2 and 4 read; 1 and 2 count the address up, 3 and 4 do not. Any other is ignored with its length
// and its address. A host that stops within a command is forgotten after TimeoutCycles without a byte; so is one whose
// byte has no stop bit, with all that it sends before that.
module uart_bridge #(
    parameter [15:0] BitCycles = 16'd136,           // of a bit, 4 or more [cycles of clk_sys]
    parameter [31:0] TimeoutCycles = 32'd12500000   // without a byte [cycles of clk_sys]
) (
    input wire clk_sys,
    input wire rst,
    // Host
    input wire uart_rx,            // from the host, asynchronous
    output reg uart_tx,            // to the host
    // registers
    input wire [31:0] read_data,   // the word at address, three cycles after it
    output reg [31:0] address,     // [words]
    output reg write_en,           // write_data is to be written
    output reg [31:0] write_data,  // word that is written, or under way
    output reg heard               // a command is complete; one cycle
);
    localparam [2:0] Command = 3'd0, Length = 3'd1, Address = 3'd2, Data = 3'd3, Read = 3'd4, Send = 3'd5, Lost = 3'd6;
    // A word is there when the cycles after its address have been counted up to this.
    localparam [1:0] LastWait = 2'd3;

    (* ASYNC_REG = "TRUE" *) reg rx_meta;
    (* ASYNC_REG = "TRUE" *) reg rx_sync;
    reg rx_busy;            // a byte is being received
    reg [15:0] rx_wait;     // until the next look at the line [cycles]
    reg [3:0] rx_bit;       // bits seen, the start bit too
    reg [7:0] rx_byte;
    reg rx_valid;           // rx_byte is complete; one cycle
    reg rx_error;           // it has no stop bit; one cycle
    reg tx_busy;            // a byte is being sent
    reg [15:0] tx_wait;     // until the next bit [cycles]
    reg [3:0] tx_left;      // bits after this one
    reg [8:0] tx_bits;      // those bits
    reg [2:0] state;
    reg [7:0] command;
    reg [7:0] length;       // words to come
    reg [1:0] bytes;        // bytes of a word that are through, or cycles that a word is waited for
    reg [31:0] silence;     // since the last byte [cycles]

    wire writes = command == 8'd1 || command == 8'd3, reads = command == 8'd2 || command == 8'd4;
    wire counts_up = command == 8'd1 || command == 8'd2;
    wire last_byte = bytes == 2'd3, last_word = length == 8'd1;

    reg uart_tx_next, write_en_next, heard_next, rx_busy_next, rx_valid_next, rx_error_next, tx_busy_next;
    reg [31:0] address_next, write_data_next, silence_next;
    reg [15:0] rx_wait_next, tx_wait_next;
    reg [3:0] rx_bit_next, tx_left_next;
    reg [7:0] rx_byte_next, command_next, length_next;
    reg [8:0] tx_bits_next;
    reg [2:0] state_next;
    reg [1:0] bytes_next;

    initial begin
        {rx_meta, rx_sync, uart_tx} = 3'b111;
        {rx_busy, rx_valid, rx_error, tx_busy, write_en, heard} = 6'd0;
        {rx_wait, tx_wait, rx_bit, tx_left, rx_byte, tx_bits} = 57'd0;
        {state, command, length, bytes, silence, address, write_data} = 117'd0;
    end

    // A bit is looked at in its middle.
    always @* begin
        rx_busy_next = rx_busy;
        rx_wait_next = rx_wait - 16'd1;
        rx_bit_next = rx_bit;
        rx_byte_next = rx_byte;
        rx_valid_next = 1'b0;
        rx_error_next = 1'b0;
        if (!rx_busy) begin
            rx_busy_next = !rx_sync;
            rx_wait_next = BitCycles / 16'd2 - 16'd1;
            rx_bit_next = 4'd0;
        end else if (rx_wait == 16'd0) begin
            rx_wait_next = BitCycles - 16'd1;
            rx_bit_next = rx_bit + 4'd1;
            if (rx_bit == 4'd0) begin
                rx_busy_next = !rx_sync;
            end else if (rx_bit == 4'd9) begin
                rx_busy_next = 1'b0;
                rx_valid_next = rx_sync;
                rx_error_next = !rx_sync;
            end else begin
                rx_byte_next = {rx_sync, rx_byte[7:1]};
            end
        end
    end

    always @* begin
        uart_tx_next = uart_tx;
        tx_busy_next = tx_busy;
        tx_wait_next = tx_wait - 16'd1;
        tx_left_next = tx_left;
        tx_bits_next = tx_bits;
        if (!tx_busy) begin
            tx_busy_next = state == Send;
            uart_tx_next = state != Send;
            tx_wait_next = BitCycles - 16'd1;
            tx_left_next = 4'd9;
            tx_bits_next = {1'b1, write_data[31:24]};
        end else if (tx_wait == 16'd0) begin
            tx_wait_next = BitCycles - 16'd1;
            tx_busy_next = tx_left != 4'd0;
            uart_tx_next = tx_left == 4'd0 || tx_bits[0];
            tx_left_next = tx_left - 4'd1;
            tx_bits_next = tx_bits >> 1;
        end
    end

    always @* begin
        state_next = state;
        command_next = command;
        length_next = length;
        bytes_next = bytes;
        silence_next = rx_valid ? 32'd0 : silence + 32'd1;
        address_next = write_en && counts_up ? address + 32'd1 : address;
        write_data_next = write_data;
        write_en_next = 1'b0;
        heard_next = 1'b0;
        case (state)
            Command: if (rx_valid) begin
                command_next = rx_byte;
                state_next = Length;
            end
            Length: if (rx_valid) begin
                length_next = rx_byte;
                bytes_next = 2'd0;
                state_next = Address;
            end
            Address: if (rx_valid) begin
                address_next = {address[23:0], rx_byte};
                bytes_next = bytes + 2'd1;
                if (last_byte) begin
                    heard_next = length == 8'd0 && (writes || reads);
                    state_next = length == 8'd0 ? Command : writes ? Data : reads ? Read : Command;
                end
            end
            Data: if (rx_valid) begin
                write_data_next = {write_data[23:0], rx_byte};
                bytes_next = bytes + 2'd1;
                if (last_byte) begin
                    write_en_next = 1'b1;
                    length_next = length - 8'd1;
                    heard_next = last_word;
                    if (last_word) state_next = Command;
                end
            end
            Read: begin
                bytes_next = bytes + 2'd1;
                if (bytes == LastWait) begin
                    write_data_next = read_data;
                    state_next = Send;
                end
            end
            Send: if (!tx_busy) begin
                write_data_next = write_data << 8;
                bytes_next = bytes + 2'd1;
                if (last_byte) begin
                    length_next = length - 8'd1;
                    if (counts_up) address_next = address + 32'd1;
                    heard_next = last_word;
                    state_next = last_word ? Command : Read;
                end
            end
            default: ;
        endcase
        if (state != Read && state != Send) begin
            if (state != Command && silence == TimeoutCycles) state_next = Command;
            if (rx_error) begin
                silence_next = 32'd0;
                state_next = Lost;
            end
        end
    end

    always @(posedge clk_sys) begin
        rx_meta <= uart_rx;
        rx_sync <= rx_meta;
        rx_wait <= rx_wait_next;
        rx_bit <= rx_bit_next;
        rx_byte <= rx_byte_next;
        tx_wait <= tx_wait_next;
        tx_left <= tx_left_next;
        tx_bits <= tx_bits_next;
        command <= command_next;
        length <= length_next;
        bytes <= bytes_next;
        silence <= silence_next;
        address <= address_next;
        write_data <= write_data_next;
        if (rst) begin
            uart_tx <= 1'b1;
            {rx_busy, rx_valid, rx_error, tx_busy, write_en, heard} <= 6'd0;
            state <= Command;
        end else begin
            uart_tx <= uart_tx_next;
            rx_busy <= rx_busy_next;
            rx_valid <= rx_valid_next;
            rx_error <= rx_error_next;
            tx_busy <= tx_busy_next;
            write_en <= write_en_next;
            heard <= heard_next;
            state <= state_next;
        end
    end
endmodule
