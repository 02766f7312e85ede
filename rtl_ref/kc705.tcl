# Not run yet: no Vivado was at hand. Bitstream for a KC705, without a project:
#
#     vivado -mode batch -source rtl_ref/kc705.tcl -tclargs FOLDER ILA
#
# FOLDER is for results, vivado by default. ILA, if there is to be a logic analyser in the FPGA, is the file of its probes
# (tofsim ila tcl). Names of ROMs in the Verilog are from the folder above the sources.
set rtl [file dirname [file normalize [info script]]]
set out vivado
if {[llength $argv] > 0} {
    set out [lindex $argv 0]
}
set out [file normalize $out]
set ila {}
if {[llength $argv] > 1} {
    set ila [file normalize [lindex $argv 1]]
}
file mkdir $out
cd [file dirname $rtl]

read_verilog [lsort [glob $rtl/*.v]]
read_xdc $rtl/kc705.xdc
if {$ila eq {}} {
    synth_design -top kc705_top -part xc7k325tffg900-2
} else {
    # Nets keep the names that the Verilog has.
    synth_design -top kc705_top -part xc7k325tffg900-2 -flatten_hierarchy none -fsm_extraction off
    source $ila
}
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
if {$ila ne {}} {
    write_debug_probes -force $out/kc705.ltx
}
puts "wrote $out/kc705.bit"
