# A bench with checkers of tofsim and photons for it. `make verilator TOP=tb DESIGN="rtl/*.v tb.sv"` builds and runs it
# in Verilator 5.006, `make icarus` in Icarus 11. The other targets follow the manuals of their simulators and have NOT been tried.
HERE := $(dir $(abspath $(lastword $(MAKEFILE_LIST))))
# The folder with libtofsim_dpi.so: `cargo build --release -p tofsim-dpi` puts it into target/release.
LIB ?= target/release
TOP ?= tb
DESIGN ?= tb.sv
ARGS ?=
BUILD ?= build

# The package first, the bindings last.
SV := $(addprefix $(HERE),tofsim_pkg.sv tofsim_photons.sv tofsim_checkers.sv)
BIND := $(HERE)tofsim_bind.sv
FOUND := $(abspath $(LIB))

.PHONY: verilator icarus questa vcs xsim
verilator:
	verilator --binary --timing --assert -Wno-fatal -Wno-WIDTH -Wno-TIMESCALEMOD --Mdir $(BUILD) --top-module $(TOP) \
	  -DTOFSIM_BENCH=$(TOP) \
	  $(SV) $(DESIGN) $(BIND) $(FOUND)/libtofsim_dpi.so -LDFLAGS "-Wl,-rpath,$(FOUND)" -o $(TOP)
	$(BUILD)/$(TOP) $(ARGS)

# PATH_OF_TOP is that of tof_top in the simulation; checkers of blocks that are not there have to be left out (--block).
PATH_OF_TOP ?= $(TOP).dut
icarus:
	mkdir -p $(BUILD)
	cd $(BUILD) && CFLAGS="-I$(HERE)" iverilog-vpi -I$(HERE) $(HERE)tofsim_vpi.c -L$(FOUND) -ltofsim_dpi
	iverilog -g2012 -o $(BUILD)/$(TOP).vvp -DTOFSIM_TOP=$(PATH_OF_TOP) -s $(TOP) -s tofsim_attach \
	  $(DESIGN) $(HERE)tofsim_vpi.v
	LD_LIBRARY_PATH=$(FOUND) vvp -n -M $(BUILD) -m tofsim_vpi $(BUILD)/$(TOP).vvp $(ARGS)

# NOT TRIED.
questa:
	vlib $(BUILD)
	vlog -sv -work $(BUILD) -timescale 1ps/1fs +define+TOFSIM_BENCH=$(TOP) $(SV) $(DESIGN) $(BIND)
	vsim -c -work $(BUILD) -t 1fs -sv_lib $(FOUND)/libtofsim_dpi $(TOP) $(ARGS) -do "run -all; quit"

# NOT TRIED.
vcs:
	mkdir -p $(BUILD)
	vcs -full64 -sverilog -timescale=1ps/1fs -top $(TOP) +define+TOFSIM_BENCH=$(TOP) -o $(BUILD)/$(TOP) $(SV) $(DESIGN) $(BIND) \
	  $(FOUND)/libtofsim_dpi.so -LDFLAGS "-Wl,-rpath,$(FOUND)"
	$(BUILD)/$(TOP) $(ARGS)

# NOT TRIED. xelab takes the library without its ending; 2023.2 to 2024.2 are said to crash without --debug typical.
xsim:
	mkdir -p $(BUILD)
	cd $(BUILD) && xvlog -sv -d TOFSIM_BENCH=$(TOP) $(abspath $(SV) $(DESIGN) $(BIND))
	cd $(BUILD) && xelab --debug typical -timescale 1ps/1fs -sv_root $(FOUND) -sv_lib libtofsim_dpi $(TOP) -s $(TOP)
	cd $(BUILD) && xsim $(TOP) $(foreach arg,$(ARGS),-testplusarg $(patsubst +%,%,$(arg))) -runall
