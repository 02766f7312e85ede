# Not run yet: the tools were not at hand. Bitstream for a KC705, by Yosys and openXC7 (nextpnr-xilinx, prjxray):
#
#     make -f rtl_ref/kc705_openxc7.mk CHIPDB=FILE PRJXRAY_DB=FOLDER
#
# CHIPDB is nextpnr-xilinx's database of the xc7k325t, PRJXRAY_DB the folder of prjxray's with kintex7 in it. nextpnr does not
# read kc705_chain.tcl, so that the carry chain is where it places it. Results go into $(OUT).
YOSYS ?= yosys
NEXTPNR ?= nextpnr-xilinx
FASM2FRAMES ?= fasm2frames
FRAMES2BIT ?= xc7frames2bit
OUT ?= openxc7
PART := xc7k325tffg900-2

RTL := $(patsubst %/,%,$(dir $(lastword $(MAKEFILE_LIST))))
SOURCES := $(sort $(wildcard $(RTL)/*.v))
ROMS := $(wildcard $(RTL)/*.mem)

.DELETE_ON_ERROR:
.PHONY: all program

all: $(OUT)/kc705.bit

program: $(OUT)/kc705.bit
	openFPGALoader --board kc705 $<

$(OUT)/kc705.json: $(SOURCES) $(ROMS)
	mkdir -p $(OUT)
	$(YOSYS) -q -l $(OUT)/yosys.log -p "read_verilog $(SOURCES); synth_xilinx -family xc7 -flatten -abc9 -top kc705_top; write_json $@"

# Of the constraints it takes pins, standards and the clock, and says which lines it does not take.
$(OUT)/kc705.fasm: $(OUT)/kc705.json $(RTL)/kc705.xdc
	$(NEXTPNR) --chipdb $(CHIPDB) --xdc $(RTL)/kc705.xdc --json $< --fasm $@ --log $(OUT)/nextpnr.log

$(OUT)/kc705.frames: $(OUT)/kc705.fasm
	$(FASM2FRAMES) --part $(PART) --db-root $(PRJXRAY_DB)/kintex7 $< > $@

$(OUT)/kc705.bit: $(OUT)/kc705.frames
	$(FRAMES2BIT) --part_file $(PRJXRAY_DB)/kintex7/$(PART)/part.yaml --part_name $(PART) --frm_file $< --output_file $@
