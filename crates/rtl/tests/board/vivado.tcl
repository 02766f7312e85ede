# Vivado's commands as far as the scripts of rtl_ref use them, for Yosys: it reads the Verilog and finds all modules and
# ROMs; the others are printed. SLACK has the slacks of the routed design for setup and hold, max and min. With UNREAD the
# Verilog is not read.
if {[info exists ::env(UNREAD)]} {
    proc yosys args {}
}

proc printed {name} {
    proc $name {args} "puts \"$name \$args\""
}
foreach name {create_clock create_debug_core create_debug_port connect_debug_port
        set_clock_groups set_false_path set_max_delay set_property report_utilization report_timing_summary report_cdc report_drc
        opt_design place_design phys_opt_design route_design write_checkpoint write_bitstream write_debug_probes} {
    printed $name
}
foreach name {get_clocks get_ports get_pins get_cells get_debug_cores get_debug_ports current_design all_outputs get_timing_paths} {
    proc $name {args} "return \"$name \$args\""
}

proc read_verilog {files} {
    yosys read_verilog -lib +/xilinx/cells_sim.v +/xilinx/cells_xtra.v
    yosys read_verilog -DSYNTHESIS {*}$files
}

proc read_xdc {args} {
    puts "read_xdc $args"
    uplevel #0 source [lindex $args end]
}

proc synth_design {args} {
    puts "synth_design $args"
    yosys hierarchy -check -top [dict get $args -top]
    if {[dict exists $args -flatten_hierarchy]} {
        yosys proc
        yosys flatten
    }
}

proc get_property {name of} {
    if {$name ne "SLACK"} {
        error "get_property $name"
    }
    return [dict get $::env(SLACK) [lindex $of end]]
}

# Looks for nets by their paths, with the place of a bit or without, in the flat design that Yosys has.
proc get_nets {nets} {
    foreach net $nets {
        if {![regexp {^(.*)\[(\d+)\]$} $net -> path bit]} {
            lassign [list $net 0] path bit
        }
        set most($path) [expr {$bit + 1}]
    }
    foreach {path width} [array get most] {
        yosys select -assert-any w:[string map {/ .} $path] s:$width: %i
    }
    return $nets
}

set argv [list $::env(OUT) {*}$::env(ILA)]
source $::env(SCRIPT)
