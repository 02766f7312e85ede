# Placement of the carry chain: 200 CARRY4 up one column of slices, each with its four tap registers
# in the same slice. A file of its own, because an XDC may not loop: read_xdc -unmanaged.
#
# [choice] Of column and rows: near the left edge, where the HR banks are (tdc_stop is in bank 16),
# up to the top row of the part. Look at the device view first: the part has 350 rows of slices in 7
# clock regions of 80 columns, but X0Y2 and X0Y3 (rows 100 to 199) have 12 columns less (public
# report of a xc7k325t: 3,400 slices instead of 4,000), and which ones could not be found out here.
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
