// tofsim as a golden model inside a bench: see docs/bench.md. Written by cbindgen from crates/dpi.

#ifndef TOFSIM_H
#define TOFSIM_H

#include <stdint.h>

// The version of this header, for the functions that take that of whoever calls.
#define TOFSIM_VERSION "0.1.0"

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Returns the version of this library, such as "0.1.0".
const char *tofsim_version(void);

// Creates a block of the model at power-up, for `tofsim_step`. Returns null if that fails; `tofsim_get_error(null,
// n)` then returns the reason. `version` is the version of the caller's header, `scenario` the name or path of a
// scenario, followed by a line for each KEY=VALUE override, and `block` the name of a module of rtl_ref.
//
// # Safety
// The strings are null or end with a zero.
void *tofsim_new(const char *version,
                 const char *scenario,
                 const char *block);

// Checks that a port of the design has the width of the block's port. Returns 1, or 0 with an error.
//
// # Safety
// The string is null or ends with a zero.
int tofsim_port(void *handle,
                const char *name,
                int bits);

// Enables comparison from power-up on. By default, outputs are compared after the first reset or, for a block
// without reset, once its registers have taken their first values.
void tofsim_from_power_up(void *handle);

// Reports a change of `tdc_stop` to `level`. Time does not go back, here and in `tofsim_step` and `tofsim_outputs`.
void tofsim_stop(void *handle,
                 long long time_fs,
                 int level);

// Sets the mask of output bits of the next `tofsim_step` that are neither 0 nor 1, which differ from any value. A
// two-state simulator need not call it.
//
// # Safety
// The vector is null or as long as the block's outputs.
void tofsim_unknown(void *handle,
                    const uint32_t *bits);

// Compares a block's outputs with those of the model just before an edge, and processes the edge. Returns 1 if they
// agree, or 0 with an error for each output that differs. `what` is 0 for a comparison without an edge, 1 for an
// edge of the block's clock (of both clocks, if it has two), 2 for an edge of clk_laser alone, and 3 for its falling
// edge. `inputs` and `outputs` are the concatenation of all ports except clocks, in the order of the module, the
// first in the highest bits.
//
// # Safety
// The vectors are null or as long as the block's ports.
int tofsim_step(void *handle,
                int what,
                long long time_fs,
                const uint32_t *inputs,
                const uint32_t *outputs);

// Returns how often the outputs of a block have been compared so far, by all its models that have not been deleted;
// 0 for an unknown block. A bench prints it at its end: a checker that was never connected finds no fault.
//
// # Safety
// The string is null or ends with a zero.
long long tofsim_get_num_compared(const char *block);

// Computes the model's outputs for the given inputs, before an edge. Returns 1, or 0 with an error.
//
// # Safety
// The vectors are null or as long as the block's ports.
int tofsim_outputs(void *handle, long long time_fs, const uint32_t *inputs, uint32_t *outputs);

// Returns the number of errors of a handle since the last `tofsim_clear_errors`; for null, the number of errors in
// creating objects. Of many errors the first 1000 are kept, and one that says so.
int tofsim_get_num_errors(void *handle);

// Returns the text of an error, numbered from 0; empty if there are fewer errors. The text is valid until the errors
// are cleared.
const char *tofsim_get_error(void *handle,
                             int number);

// Clears the errors of a handle.
void tofsim_clear_errors(void *handle);

// Deletes a block or a photon source.
void tofsim_delete(void *handle);

// Creates the light and the detector of a scenario at power-up. Returns null if that fails, as `tofsim_new` does,
// whose arguments it shares.
//
// # Safety
// The strings are null or end with a zero.
void *tofsim_photons_new(const char *version,
                         const char *scenario);

// Processes an edge of clk_sys, with the state of the firmware after it: whether a shot begins, the laser was
// enabled at that edge, `spad_rst` is high, MODE 1 is selected, the ring oscillator drives `tdc_stop`, and a frame
// has ended.
void tofsim_photons_edge(void *handle,
                         long long time_fs,
                         int start,
                         int laser,
                         int spad_rst,
                         int mode,
                         int ring_on,
                         int frame_done);

// Returns the next time at which `tdc_stop` changes before or at the next edge [fs], or -1. `tdc_stop` then has its
// new level.
long long tofsim_photons_next(void *handle);

// Returns the level of `tdc_stop`.
int tofsim_photons_level(void *handle);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* TOFSIM_H */
