# Not run yet: no Vivado was at hand. Bitstream for a KC705, without a project:
#
#     vivado -mode batch -source rtl_ref/kc705.tcl -tclargs FOLDER
#
# FOLDER is for results, vivado by default. Names of ROMs in the Verilog are from the folder above the sources.
set rtl [file dirname [file normalize [info script]]]
set out vivado
if {[llength $argv] > 0} {
    set out [lindex $argv 0]
}
set out [file normalize $out]
file mkdir $out
cd [file dirname $rtl]

read_verilog [lsort [glob $rtl/*.v]]
read_xdc $rtl/kc705.xdc
synth_design -top kc705_top -part xc7k325tffg900-2
# It places cells that exist only now.
read_xdc -unmanaged $rtl/kc705_chain.tcl
report_utilization -file $out/utilization.rpt

opt_design
place_design
phys_opt_design
route_design

report_timing_summary -file $out/timing.rpt
report_cdc -details -file $out/cdc.rpt
report_drc -file $out/drc.rpt
write_checkpoint -force $out/kc705.dcp
# Setup and hold.
foreach delay {max min} {
    if {[get_property SLACK [get_timing_paths -delay_type $delay]] < 0} {
        error "kc705_top does not meet its timing: see $out/timing.rpt"
    }
}
write_bitstream -force $out/kc705.bit
puts "wrote $out/kc705.bit"
