# Placement of the carry chain: 200 CARRY4 up one column of slices, each with its four tap registers
# in the same slice. A file of its own, because an XDC may not loop: read_xdc -unmanaged.
#
# [board] 77 CLB columns (SLICE_X0 to X153) in the lower three clock regions; 73 (to X145) in the upper four, where the
# transceivers are (frames of each column in prjxray-db's kintex7/xc7k325tffg900-2/part.json). X0 to X7 are the four
# between the I/O column on the left and the first block RAM, in all 350 rows. Public reports count twelve columns less in
# rows 100 to 199: those of the configuration logic, by the frames X24 to X35. tdc_stop comes in at row 228 of the left
# edge (D26 is IOB_X0Y228).
# [choice] Column 2, from row 150 up to the top row of the part.
set column 2
set bottom 150
set chain tof_top/tdc/carry_chain

for {set k 0} {$k < 200} {incr k} {
    set site SLICE_X${column}Y[expr {$bottom + $k}]
    set_property LOC $site [get_cells "$chain/slice\[$k\].carry4"]
    foreach bit {0 1 2 3} bel {AFF BFF CFF DFF} {
        set tap [get_cells "$chain/taps_reg\[[expr {4 * $k + $bit}]\]"]
        set_property BEL $bel $tap
        set_property LOC $site $tap
    }
}
