# Constraints of kc705_top for Vivado, part xc7k325tffg900-2.
#
# [board] is from public documents: the board's pins as in LiteX-Boards' xilinx_kc705.py, those of
# the FMC connectors also in the constraint files of XAPP585, which agree. [choice] is ours: the
# thesis does not say how sensor board and acquisition computer are wired. No Vivado has seen this
# file: place-and-route was not available here.

# [board] Configuration bank supply
set_property CFGBVS VCCO [current_design]
set_property CONFIG_VOLTAGE 2.5 [current_design]

# [board] Oscillator SiT9102, 200 MHz, bank 33; CPU_RESET, active high; GPIO LED 0
set_property -dict {PACKAGE_PIN AD12 IOSTANDARD LVDS} [get_ports sysclk_p]
set_property -dict {PACKAGE_PIN AD11 IOSTANDARD LVDS} [get_ports sysclk_n]
set_property -dict {PACKAGE_PIN AB7 IOSTANDARD LVCMOS15} [get_ports cpu_reset]
set_property -dict {PACKAGE_PIN AB8 IOSTANDARD LVCMOS15} [get_ports locked]

# [board] CP2103 USB-UART; GPIO LED 1. [choice] The interlock at the SMA J13, open while nothing is plugged in;
# switch 1 of SW11, pulled down by the board.
set_property -dict {PACKAGE_PIN M19 IOSTANDARD LVCMOS25 PULLTYPE PULLUP} [get_ports uart_rx]
set_property -dict {PACKAGE_PIN K24 IOSTANDARD LVCMOS25} [get_ports uart_tx]
set_property -dict {PACKAGE_PIN AA8 IOSTANDARD LVCMOS15} [get_ports armed]
set_property -dict {PACKAGE_PIN Y23 IOSTANDARD LVCMOS25 PULLTYPE PULLUP} [get_ports interlock]
set_property -dict {PACKAGE_PIN Y29 IOSTANDARD LVCMOS25} [get_ports select_pins]

# The PLL's outputs are derived from this clock by Vivado; clk_sys and clk_laser are synchronous, and
# the path between them (fire to laser_pulse) has 4 ns.
create_clock -period 5.000 -name clk_in [get_ports sysclk_p]

# Asynchronous inputs: into the first flip-flops of the synchronisers, and into the carry chain,
# which is longer than a clock period on purpose.
set_false_path -to [get_pins tof_top/reset_sync_*/meta_reg/D]
set_false_path -to [get_pins tof_top/control_sync/*_meta_reg*/D]
set_false_path -to [get_pins tof_top/uart_bridge/rx_meta_reg/D]
set_false_path -to [get_pins tof_top/laser_guard/*_meta_reg/D]
set_false_path -from [get_ports tdc_stop]

# What switches the laser off needs no clock; when it lets go, the laser's register has nothing to emit yet.
set_false_path -to [get_pins tof_top/laser_guard/*/PRE]
set_false_path -to [get_pins tof_top/vcsel_driver/ddr_output/oddr/R]

# The ring oscillator: a clock of its own, uncorrelated on purpose.
create_clock -period 2.000 -name ring [get_pins {ring_oscillator/stage[14].lut/O}]
set_clock_groups -asynchronous -group [get_clocks ring]

# [choice] The estimate is at the pins 8 ns after its edge of clk_sys at the latest, and stays until that of the next
# frame: sampled 8 ns after algo_done rises or later, it is whole. Nothing of that kind holds for the other outputs: the
# histogram changes with clk_sys, of which no copy leaves the FPGA (a host reads it from the registers), the SPAD array is
# slow, and the laser's pulse leaves from a register in the pin.
set_max_delay -datapath_only 8.000 -from [get_clocks -of_objects [get_pins tof_top/pll/bufg_sys/O]] \
    -to [get_ports {depth[*] sigma[*] status[*] valid algo_done}]
set_false_path -to [get_ports {locked armed uart_tx laser_on_lvds_p laser_on_lvds_n spad_rst spad_sel[*] hist_valid hist_bin[*] hist_count[*] frame_done}]

# [board] pins, [choice] of connector, order and standard from here on. The banks are HR with
# VADJ = 2.5 V, the board's default.

# FMC HPC: sensor board
set_property -dict {PACKAGE_PIN C25  IOSTANDARD LVDS_25} [get_ports laser_on_lvds_p]    ;# FMC_HPC_LA00_CC_P
set_property -dict {PACKAGE_PIN B25  IOSTANDARD LVDS_25} [get_ports laser_on_lvds_n]    ;# FMC_HPC_LA00_CC_N
set_property -dict {PACKAGE_PIN D26  IOSTANDARD LVCMOS25} [get_ports tdc_stop]          ;# FMC_HPC_LA01_CC_P
set_property -dict {PACKAGE_PIN C26  IOSTANDARD LVCMOS25} [get_ports spad_rst]          ;# FMC_HPC_LA01_CC_N
set_property -dict {PACKAGE_PIN H24  IOSTANDARD LVCMOS25} [get_ports {spad_sel[0]}]     ;# FMC_HPC_LA02_P
set_property -dict {PACKAGE_PIN H25  IOSTANDARD LVCMOS25} [get_ports {spad_sel[1]}]     ;# FMC_HPC_LA02_N
set_property -dict {PACKAGE_PIN H26  IOSTANDARD LVCMOS25} [get_ports {spad_sel[2]}]     ;# FMC_HPC_LA03_P
set_property -dict {PACKAGE_PIN H27  IOSTANDARD LVCMOS25} [get_ports {spad_sel[3]}]     ;# FMC_HPC_LA03_N
set_property -dict {PACKAGE_PIN G28  IOSTANDARD LVCMOS25} [get_ports {spad_sel[4]}]     ;# FMC_HPC_LA04_P
set_property -dict {PACKAGE_PIN F28  IOSTANDARD LVCMOS25} [get_ports {spad_sel[5]}]     ;# FMC_HPC_LA04_N
set_property -dict {PACKAGE_PIN G29  IOSTANDARD LVCMOS25} [get_ports {spad_sel[6]}]     ;# FMC_HPC_LA05_P
set_property -dict {PACKAGE_PIN F30  IOSTANDARD LVCMOS25} [get_ports {spad_sel[7]}]     ;# FMC_HPC_LA05_N
set_property -dict {PACKAGE_PIN H30  IOSTANDARD LVCMOS25} [get_ports {spad_sel[8]}]     ;# FMC_HPC_LA06_P
set_property -dict {PACKAGE_PIN G30  IOSTANDARD LVCMOS25} [get_ports {spad_sel[9]}]     ;# FMC_HPC_LA06_N
set_property -dict {PACKAGE_PIN E28  IOSTANDARD LVCMOS25} [get_ports {spad_sel[10]}]    ;# FMC_HPC_LA07_P
set_property -dict {PACKAGE_PIN D28  IOSTANDARD LVCMOS25} [get_ports {spad_sel[11]}]    ;# FMC_HPC_LA07_N
set_property -dict {PACKAGE_PIN E29  IOSTANDARD LVCMOS25} [get_ports {spad_sel[12]}]    ;# FMC_HPC_LA08_P
set_property -dict {PACKAGE_PIN E30  IOSTANDARD LVCMOS25} [get_ports {spad_sel[13]}]    ;# FMC_HPC_LA08_N
set_property -dict {PACKAGE_PIN B30  IOSTANDARD LVCMOS25} [get_ports {spad_sel[14]}]    ;# FMC_HPC_LA09_P
set_property -dict {PACKAGE_PIN A30  IOSTANDARD LVCMOS25} [get_ports {spad_sel[15]}]    ;# FMC_HPC_LA09_N
set_property -dict {PACKAGE_PIN D29  IOSTANDARD LVCMOS25} [get_ports {spad_sel[16]}]    ;# FMC_HPC_LA10_P
set_property -dict {PACKAGE_PIN C30  IOSTANDARD LVCMOS25} [get_ports {spad_sel[17]}]    ;# FMC_HPC_LA10_N
set_property -dict {PACKAGE_PIN G27  IOSTANDARD LVCMOS25} [get_ports {spad_sel[18]}]    ;# FMC_HPC_LA11_P
set_property -dict {PACKAGE_PIN F27  IOSTANDARD LVCMOS25} [get_ports {spad_sel[19]}]    ;# FMC_HPC_LA11_N
set_property -dict {PACKAGE_PIN C29  IOSTANDARD LVCMOS25} [get_ports {spad_sel[20]}]    ;# FMC_HPC_LA12_P
set_property -dict {PACKAGE_PIN B29  IOSTANDARD LVCMOS25} [get_ports {spad_sel[21]}]    ;# FMC_HPC_LA12_N
set_property -dict {PACKAGE_PIN A25  IOSTANDARD LVCMOS25} [get_ports {spad_sel[22]}]    ;# FMC_HPC_LA13_P
set_property -dict {PACKAGE_PIN A26  IOSTANDARD LVCMOS25} [get_ports {spad_sel[23]}]    ;# FMC_HPC_LA13_N
set_property -dict {PACKAGE_PIN B28  IOSTANDARD LVCMOS25} [get_ports {spad_sel[24]}]    ;# FMC_HPC_LA14_P
set_property -dict {PACKAGE_PIN A28  IOSTANDARD LVCMOS25} [get_ports {spad_sel[25]}]    ;# FMC_HPC_LA14_N
set_property -dict {PACKAGE_PIN C24  IOSTANDARD LVCMOS25} [get_ports {spad_sel[26]}]    ;# FMC_HPC_LA15_P
set_property -dict {PACKAGE_PIN B24  IOSTANDARD LVCMOS25} [get_ports {spad_sel[27]}]    ;# FMC_HPC_LA15_N
set_property -dict {PACKAGE_PIN B27  IOSTANDARD LVCMOS25} [get_ports {spad_sel[28]}]    ;# FMC_HPC_LA16_P
set_property -dict {PACKAGE_PIN A27  IOSTANDARD LVCMOS25} [get_ports {spad_sel[29]}]    ;# FMC_HPC_LA16_N
set_property -dict {PACKAGE_PIN F20  IOSTANDARD LVCMOS25} [get_ports {spad_sel[30]}]    ;# FMC_HPC_LA17_CC_P
set_property -dict {PACKAGE_PIN E20  IOSTANDARD LVCMOS25} [get_ports {spad_sel[31]}]    ;# FMC_HPC_LA17_CC_N
set_property -dict {PACKAGE_PIN F21  IOSTANDARD LVCMOS25} [get_ports {spad_sel[32]}]    ;# FMC_HPC_LA18_CC_P
set_property -dict {PACKAGE_PIN E21  IOSTANDARD LVCMOS25} [get_ports {spad_sel[33]}]    ;# FMC_HPC_LA18_CC_N
set_property -dict {PACKAGE_PIN G18  IOSTANDARD LVCMOS25} [get_ports {spad_sel[34]}]    ;# FMC_HPC_LA19_P
set_property -dict {PACKAGE_PIN F18  IOSTANDARD LVCMOS25} [get_ports {spad_sel[35]}]    ;# FMC_HPC_LA19_N
set_property -dict {PACKAGE_PIN E19  IOSTANDARD LVCMOS25} [get_ports {spad_sel[36]}]    ;# FMC_HPC_LA20_P
set_property -dict {PACKAGE_PIN D19  IOSTANDARD LVCMOS25} [get_ports {spad_sel[37]}]    ;# FMC_HPC_LA20_N
set_property -dict {PACKAGE_PIN A20  IOSTANDARD LVCMOS25} [get_ports {spad_sel[38]}]    ;# FMC_HPC_LA21_P
set_property -dict {PACKAGE_PIN A21  IOSTANDARD LVCMOS25} [get_ports {spad_sel[39]}]    ;# FMC_HPC_LA21_N

# FMC HPC: acquisition computer, its outputs; with nothing plugged in, the laser is off and no frame begins
set_property -dict {PACKAGE_PIN C20  IOSTANDARD LVCMOS25 PULLTYPE PULLDOWN} [get_ports mode] ;# FMC_HPC_LA22_P
set_property -dict {PACKAGE_PIN B20  IOSTANDARD LVCMOS25 PULLTYPE PULLDOWN} [get_ports {laser_freq[0]}] ;# FMC_HPC_LA22_N
set_property -dict {PACKAGE_PIN B22  IOSTANDARD LVCMOS25 PULLTYPE PULLDOWN} [get_ports {laser_freq[1]}] ;# FMC_HPC_LA23_P
set_property -dict {PACKAGE_PIN A22  IOSTANDARD LVCMOS25 PULLTYPE PULLDOWN} [get_ports laser_en] ;# FMC_HPC_LA23_N
set_property -dict {PACKAGE_PIN A16  IOSTANDARD LVCMOS25 PULLTYPE PULLDOWN} [get_ports dsp_en] ;# FMC_HPC_LA24_P
set_property -dict {PACKAGE_PIN A17  IOSTANDARD LVCMOS25 PULLTYPE PULLDOWN} [get_ports dsp_rst] ;# FMC_HPC_LA24_N

# FMC HPC: acquisition computer, its inputs about the depth
set_property -dict {PACKAGE_PIN D12  IOSTANDARD LVCMOS25} [get_ports {sigma[0]}]    ;# FMC_HPC_HA00_CC_P
set_property -dict {PACKAGE_PIN D13  IOSTANDARD LVCMOS25} [get_ports {sigma[1]}]    ;# FMC_HPC_HA00_CC_N
set_property -dict {PACKAGE_PIN H14  IOSTANDARD LVCMOS25} [get_ports {sigma[2]}]    ;# FMC_HPC_HA01_CC_P
set_property -dict {PACKAGE_PIN G14  IOSTANDARD LVCMOS25} [get_ports {sigma[3]}]    ;# FMC_HPC_HA01_CC_N
set_property -dict {PACKAGE_PIN D11  IOSTANDARD LVCMOS25} [get_ports {sigma[4]}]    ;# FMC_HPC_HA02_P
set_property -dict {PACKAGE_PIN C11  IOSTANDARD LVCMOS25} [get_ports {sigma[5]}]    ;# FMC_HPC_HA02_N
set_property -dict {PACKAGE_PIN C12  IOSTANDARD LVCMOS25} [get_ports {sigma[6]}]    ;# FMC_HPC_HA03_P
set_property -dict {PACKAGE_PIN B12  IOSTANDARD LVCMOS25} [get_ports {sigma[7]}]    ;# FMC_HPC_HA03_N
set_property -dict {PACKAGE_PIN F11  IOSTANDARD LVCMOS25} [get_ports {sigma[8]}]    ;# FMC_HPC_HA04_P
set_property -dict {PACKAGE_PIN E11  IOSTANDARD LVCMOS25} [get_ports {sigma[9]}]    ;# FMC_HPC_HA04_N
set_property -dict {PACKAGE_PIN F15  IOSTANDARD LVCMOS25} [get_ports {sigma[10]}]   ;# FMC_HPC_HA05_P
set_property -dict {PACKAGE_PIN E16  IOSTANDARD LVCMOS25} [get_ports {sigma[11]}]   ;# FMC_HPC_HA05_N
set_property -dict {PACKAGE_PIN D14  IOSTANDARD LVCMOS25} [get_ports {sigma[12]}]   ;# FMC_HPC_HA06_P
set_property -dict {PACKAGE_PIN C14  IOSTANDARD LVCMOS25} [get_ports {sigma[13]}]   ;# FMC_HPC_HA06_N
set_property -dict {PACKAGE_PIN B14  IOSTANDARD LVCMOS25} [get_ports {sigma[14]}]   ;# FMC_HPC_HA07_P
set_property -dict {PACKAGE_PIN A15  IOSTANDARD LVCMOS25} [get_ports {sigma[15]}]   ;# FMC_HPC_HA07_N
set_property -dict {PACKAGE_PIN E14  IOSTANDARD LVCMOS25} [get_ports {sigma[16]}]   ;# FMC_HPC_HA08_P
set_property -dict {PACKAGE_PIN E15  IOSTANDARD LVCMOS25} [get_ports {sigma[17]}]   ;# FMC_HPC_HA08_N
set_property -dict {PACKAGE_PIN F12  IOSTANDARD LVCMOS25} [get_ports {sigma[18]}]   ;# FMC_HPC_HA09_P
set_property -dict {PACKAGE_PIN E13  IOSTANDARD LVCMOS25} [get_ports {sigma[19]}]   ;# FMC_HPC_HA09_N
set_property -dict {PACKAGE_PIN A11  IOSTANDARD LVCMOS25} [get_ports {sigma[20]}]   ;# FMC_HPC_HA10_P
set_property -dict {PACKAGE_PIN A12  IOSTANDARD LVCMOS25} [get_ports {sigma[21]}]   ;# FMC_HPC_HA10_N
set_property -dict {PACKAGE_PIN B13  IOSTANDARD LVCMOS25} [get_ports {sigma[22]}]   ;# FMC_HPC_HA11_P
set_property -dict {PACKAGE_PIN A13  IOSTANDARD LVCMOS25} [get_ports {sigma[23]}]   ;# FMC_HPC_HA11_N
set_property -dict {PACKAGE_PIN C15  IOSTANDARD LVCMOS25} [get_ports {sigma[24]}]   ;# FMC_HPC_HA12_P
set_property -dict {PACKAGE_PIN B15  IOSTANDARD LVCMOS25} [get_ports {sigma[25]}]   ;# FMC_HPC_HA12_N
set_property -dict {PACKAGE_PIN L16  IOSTANDARD LVCMOS25} [get_ports {sigma[26]}]   ;# FMC_HPC_HA13_P
set_property -dict {PACKAGE_PIN K16  IOSTANDARD LVCMOS25} [get_ports {sigma[27]}]   ;# FMC_HPC_HA13_N
set_property -dict {PACKAGE_PIN J16  IOSTANDARD LVCMOS25} [get_ports {sigma[28]}]   ;# FMC_HPC_HA14_P
set_property -dict {PACKAGE_PIN H16  IOSTANDARD LVCMOS25} [get_ports {sigma[29]}]   ;# FMC_HPC_HA14_N
set_property -dict {PACKAGE_PIN H15  IOSTANDARD LVCMOS25} [get_ports {sigma[30]}]   ;# FMC_HPC_HA15_P
set_property -dict {PACKAGE_PIN G15  IOSTANDARD LVCMOS25} [get_ports {sigma[31]}]   ;# FMC_HPC_HA15_N
set_property -dict {PACKAGE_PIN L15  IOSTANDARD LVCMOS25} [get_ports {sigma[32]}]   ;# FMC_HPC_HA16_P
set_property -dict {PACKAGE_PIN K15  IOSTANDARD LVCMOS25} [get_ports {sigma[33]}]   ;# FMC_HPC_HA16_N
set_property -dict {PACKAGE_PIN G13  IOSTANDARD LVCMOS25} [get_ports {sigma[34]}]   ;# FMC_HPC_HA17_CC_P
set_property -dict {PACKAGE_PIN F13  IOSTANDARD LVCMOS25} [get_ports {sigma[35]}]   ;# FMC_HPC_HA17_CC_N
set_property -dict {PACKAGE_PIN K14  IOSTANDARD LVCMOS25} [get_ports {status[0]}]   ;# FMC_HPC_HA18_P
set_property -dict {PACKAGE_PIN J14  IOSTANDARD LVCMOS25} [get_ports {status[1]}]   ;# FMC_HPC_HA18_N
set_property -dict {PACKAGE_PIN H11  IOSTANDARD LVCMOS25} [get_ports {status[2]}]   ;# FMC_HPC_HA19_P
set_property -dict {PACKAGE_PIN H12  IOSTANDARD LVCMOS25} [get_ports {status[3]}]   ;# FMC_HPC_HA19_N
set_property -dict {PACKAGE_PIN K13  IOSTANDARD LVCMOS25} [get_ports {status[4]}]   ;# FMC_HPC_HA20_P
set_property -dict {PACKAGE_PIN J13  IOSTANDARD LVCMOS25} [get_ports {status[5]}]   ;# FMC_HPC_HA20_N
set_property -dict {PACKAGE_PIN J11  IOSTANDARD LVCMOS25} [get_ports {status[6]}]   ;# FMC_HPC_HA21_P
set_property -dict {PACKAGE_PIN J12  IOSTANDARD LVCMOS25} [get_ports valid]         ;# FMC_HPC_HA21_N

# FMC LPC: acquisition computer, its inputs
set_property -dict {PACKAGE_PIN AD23 IOSTANDARD LVCMOS25} [get_ports {depth[0]}]        ;# FMC_LPC_LA00_CC_P
set_property -dict {PACKAGE_PIN AE24 IOSTANDARD LVCMOS25} [get_ports {depth[1]}]        ;# FMC_LPC_LA00_CC_N
set_property -dict {PACKAGE_PIN AE23 IOSTANDARD LVCMOS25} [get_ports {depth[2]}]        ;# FMC_LPC_LA01_CC_P
set_property -dict {PACKAGE_PIN AF23 IOSTANDARD LVCMOS25} [get_ports {depth[3]}]        ;# FMC_LPC_LA01_CC_N
set_property -dict {PACKAGE_PIN AF20 IOSTANDARD LVCMOS25} [get_ports {depth[4]}]        ;# FMC_LPC_LA02_P
set_property -dict {PACKAGE_PIN AF21 IOSTANDARD LVCMOS25} [get_ports {depth[5]}]        ;# FMC_LPC_LA02_N
set_property -dict {PACKAGE_PIN AG20 IOSTANDARD LVCMOS25} [get_ports {depth[6]}]        ;# FMC_LPC_LA03_P
set_property -dict {PACKAGE_PIN AH20 IOSTANDARD LVCMOS25} [get_ports {depth[7]}]        ;# FMC_LPC_LA03_N
set_property -dict {PACKAGE_PIN AH21 IOSTANDARD LVCMOS25} [get_ports {depth[8]}]        ;# FMC_LPC_LA04_P
set_property -dict {PACKAGE_PIN AJ21 IOSTANDARD LVCMOS25} [get_ports {depth[9]}]        ;# FMC_LPC_LA04_N
set_property -dict {PACKAGE_PIN AG22 IOSTANDARD LVCMOS25} [get_ports {depth[10]}]       ;# FMC_LPC_LA05_P
set_property -dict {PACKAGE_PIN AH22 IOSTANDARD LVCMOS25} [get_ports {depth[11]}]       ;# FMC_LPC_LA05_N
set_property -dict {PACKAGE_PIN AK20 IOSTANDARD LVCMOS25} [get_ports {depth[12]}]       ;# FMC_LPC_LA06_P
set_property -dict {PACKAGE_PIN AK21 IOSTANDARD LVCMOS25} [get_ports {depth[13]}]       ;# FMC_LPC_LA06_N
set_property -dict {PACKAGE_PIN AG25 IOSTANDARD LVCMOS25} [get_ports {depth[14]}]       ;# FMC_LPC_LA07_P
set_property -dict {PACKAGE_PIN AH25 IOSTANDARD LVCMOS25} [get_ports {depth[15]}]       ;# FMC_LPC_LA07_N
set_property -dict {PACKAGE_PIN AJ22 IOSTANDARD LVCMOS25} [get_ports {depth[16]}]       ;# FMC_LPC_LA08_P
set_property -dict {PACKAGE_PIN AJ23 IOSTANDARD LVCMOS25} [get_ports {depth[17]}]       ;# FMC_LPC_LA08_N
set_property -dict {PACKAGE_PIN AK23 IOSTANDARD LVCMOS25} [get_ports {depth[18]}]       ;# FMC_LPC_LA09_P
set_property -dict {PACKAGE_PIN AK24 IOSTANDARD LVCMOS25} [get_ports {depth[19]}]       ;# FMC_LPC_LA09_N
set_property -dict {PACKAGE_PIN AJ24 IOSTANDARD LVCMOS25} [get_ports {depth[20]}]       ;# FMC_LPC_LA10_P
set_property -dict {PACKAGE_PIN AK25 IOSTANDARD LVCMOS25} [get_ports {depth[21]}]       ;# FMC_LPC_LA10_N
set_property -dict {PACKAGE_PIN AE25 IOSTANDARD LVCMOS25} [get_ports {depth[22]}]       ;# FMC_LPC_LA11_P
set_property -dict {PACKAGE_PIN AF25 IOSTANDARD LVCMOS25} [get_ports {depth[23]}]       ;# FMC_LPC_LA11_N
set_property -dict {PACKAGE_PIN AA20 IOSTANDARD LVCMOS25} [get_ports {depth[24]}]       ;# FMC_LPC_LA12_P
set_property -dict {PACKAGE_PIN AB20 IOSTANDARD LVCMOS25} [get_ports {depth[25]}]       ;# FMC_LPC_LA12_N
set_property -dict {PACKAGE_PIN AB24 IOSTANDARD LVCMOS25} [get_ports {depth[26]}]       ;# FMC_LPC_LA13_P
set_property -dict {PACKAGE_PIN AC25 IOSTANDARD LVCMOS25} [get_ports {depth[27]}]       ;# FMC_LPC_LA13_N
set_property -dict {PACKAGE_PIN AD21 IOSTANDARD LVCMOS25} [get_ports {depth[28]}]       ;# FMC_LPC_LA14_P
set_property -dict {PACKAGE_PIN AE21 IOSTANDARD LVCMOS25} [get_ports {depth[29]}]       ;# FMC_LPC_LA14_N
set_property -dict {PACKAGE_PIN AC24 IOSTANDARD LVCMOS25} [get_ports {depth[30]}]       ;# FMC_LPC_LA15_P
set_property -dict {PACKAGE_PIN AD24 IOSTANDARD LVCMOS25} [get_ports {depth[31]}]       ;# FMC_LPC_LA15_N
set_property -dict {PACKAGE_PIN AC22 IOSTANDARD LVCMOS25} [get_ports {depth[32]}]       ;# FMC_LPC_LA16_P
set_property -dict {PACKAGE_PIN AD22 IOSTANDARD LVCMOS25} [get_ports {depth[33]}]       ;# FMC_LPC_LA16_N
set_property -dict {PACKAGE_PIN AB27 IOSTANDARD LVCMOS25} [get_ports {depth[34]}]       ;# FMC_LPC_LA17_CC_P
set_property -dict {PACKAGE_PIN AC27 IOSTANDARD LVCMOS25} [get_ports {depth[35]}]       ;# FMC_LPC_LA17_CC_N
set_property -dict {PACKAGE_PIN AD27 IOSTANDARD LVCMOS25} [get_ports {hist_count[0]}]   ;# FMC_LPC_LA18_CC_P
set_property -dict {PACKAGE_PIN AD28 IOSTANDARD LVCMOS25} [get_ports {hist_count[1]}]   ;# FMC_LPC_LA18_CC_N
set_property -dict {PACKAGE_PIN AJ26 IOSTANDARD LVCMOS25} [get_ports {hist_count[2]}]   ;# FMC_LPC_LA19_P
set_property -dict {PACKAGE_PIN AK26 IOSTANDARD LVCMOS25} [get_ports {hist_count[3]}]   ;# FMC_LPC_LA19_N
set_property -dict {PACKAGE_PIN AF26 IOSTANDARD LVCMOS25} [get_ports {hist_count[4]}]   ;# FMC_LPC_LA20_P
set_property -dict {PACKAGE_PIN AF27 IOSTANDARD LVCMOS25} [get_ports {hist_count[5]}]   ;# FMC_LPC_LA20_N
set_property -dict {PACKAGE_PIN AG27 IOSTANDARD LVCMOS25} [get_ports {hist_count[6]}]   ;# FMC_LPC_LA21_P
set_property -dict {PACKAGE_PIN AG28 IOSTANDARD LVCMOS25} [get_ports {hist_count[7]}]   ;# FMC_LPC_LA21_N
set_property -dict {PACKAGE_PIN AJ27 IOSTANDARD LVCMOS25} [get_ports {hist_count[8]}]   ;# FMC_LPC_LA22_P
set_property -dict {PACKAGE_PIN AK28 IOSTANDARD LVCMOS25} [get_ports {hist_count[9]}]   ;# FMC_LPC_LA22_N
set_property -dict {PACKAGE_PIN AH26 IOSTANDARD LVCMOS25} [get_ports {hist_count[10]}]  ;# FMC_LPC_LA23_P
set_property -dict {PACKAGE_PIN AH27 IOSTANDARD LVCMOS25} [get_ports {hist_count[11]}]  ;# FMC_LPC_LA23_N
set_property -dict {PACKAGE_PIN AG30 IOSTANDARD LVCMOS25} [get_ports {hist_count[12]}]  ;# FMC_LPC_LA24_P
set_property -dict {PACKAGE_PIN AH30 IOSTANDARD LVCMOS25} [get_ports {hist_count[13]}]  ;# FMC_LPC_LA24_N
set_property -dict {PACKAGE_PIN AC26 IOSTANDARD LVCMOS25} [get_ports {hist_count[14]}]  ;# FMC_LPC_LA25_P
set_property -dict {PACKAGE_PIN AD26 IOSTANDARD LVCMOS25} [get_ports {hist_count[15]}]  ;# FMC_LPC_LA25_N
set_property -dict {PACKAGE_PIN AK29 IOSTANDARD LVCMOS25} [get_ports {hist_bin[0]}]     ;# FMC_LPC_LA26_P
set_property -dict {PACKAGE_PIN AK30 IOSTANDARD LVCMOS25} [get_ports {hist_bin[1]}]     ;# FMC_LPC_LA26_N
set_property -dict {PACKAGE_PIN AJ28 IOSTANDARD LVCMOS25} [get_ports {hist_bin[2]}]     ;# FMC_LPC_LA27_P
set_property -dict {PACKAGE_PIN AJ29 IOSTANDARD LVCMOS25} [get_ports {hist_bin[3]}]     ;# FMC_LPC_LA27_N
set_property -dict {PACKAGE_PIN AE30 IOSTANDARD LVCMOS25} [get_ports {hist_bin[4]}]     ;# FMC_LPC_LA28_P
set_property -dict {PACKAGE_PIN AF30 IOSTANDARD LVCMOS25} [get_ports {hist_bin[5]}]     ;# FMC_LPC_LA28_N
set_property -dict {PACKAGE_PIN AE28 IOSTANDARD LVCMOS25} [get_ports {hist_bin[6]}]     ;# FMC_LPC_LA29_P
set_property -dict {PACKAGE_PIN AF28 IOSTANDARD LVCMOS25} [get_ports {hist_bin[7]}]     ;# FMC_LPC_LA29_N
set_property -dict {PACKAGE_PIN AB29 IOSTANDARD LVCMOS25} [get_ports algo_done]         ;# FMC_LPC_LA30_P
set_property -dict {PACKAGE_PIN AB30 IOSTANDARD LVCMOS25} [get_ports hist_valid]        ;# FMC_LPC_LA30_N
set_property -dict {PACKAGE_PIN AD29 IOSTANDARD LVCMOS25} [get_ports frame_done]        ;# FMC_LPC_LA31_P
