// tofsim as a golden model inside a bench: see docs/bench.md. Written by cbindgen from crates/dpi.

#ifndef TOFSIM_H
#define TOFSIM_H

#include <stdint.h>

// The version of this header, for the functions that take that of whoever calls.
#define TOFSIM_VERSION "0.1.0"

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The version of this library, such as "0.1.0".
const char *tofsim_version(void);

// A block of the model at power-up, for `tofsim_step`; null if there is none, and `tofsim_get_error(null, n)` says why.
// `version` is that of whoever calls, `scenario` the name or path of a scenario, with a line for each KEY=VALUE that
// it is to have besides, and `block` the name of a module of rtl_ref.
//
// # Safety
// The strings are null or end with a zero.
void *tofsim_new(const char *version,
                 const char *scenario,
                 const char *block);

// Whether a port of the bench's has as many bits as the block's; 1 or 0, and an error.
//
// # Safety
// The string is null or ends with a zero.
int tofsim_port(void *handle, const char *name, int bits);

// Compares from power-up on. Without this, outputs are compared after the first reset, or where a block has none
// once its registers have taken their first values.
void tofsim_from_power_up(void *handle);

// `tdc_stop` has changed to `level`.
void tofsim_stop(void *handle, long long time_fs, int level);

// Bits of the outputs of the coming `tofsim_step` that are neither 0 nor 1: they differ from any. A simulator that has
// no others need not call it.
//
// # Safety
// The vector is null or as long as the block's outputs.
void tofsim_unknown(void *handle,
                    const uint32_t *bits);

// Compares a block's outputs with those of the model just before an edge, and takes the edge; 1 if they agree, or 0,
// and an error for each that does not. `what` is 0 for a look without an edge, 1 for an edge of the block's clock
// (of both clocks, where it has two), 2 for one of clk_laser alone, and 3 for its fall. `inputs` and `outputs` are all
// ports but the clocks, in the order of the module, the first in the highest bits.
//
// # Safety
// The vectors are null or as long as the block's.
int tofsim_step(void *handle,
                int what,
                long long time_fs,
                const uint32_t *inputs,
                const uint32_t *outputs);

// The outputs that the model has with those inputs, before an edge; 1, or 0 and an error.
//
// # Safety
// As of `tofsim_step`.
int tofsim_outputs(void *handle, long long time_fs, const uint32_t *inputs, uint32_t *outputs);

// Errors of a handle since the last `tofsim_clear_errors`; of null those of what could not be made.
int tofsim_get_num_errors(void *handle);

// One of them, from 0 on; empty if there are not so many. It is there until they are cleared.
const char *tofsim_get_error(void *handle, int number);

// Forgets the errors of a handle.
void tofsim_clear_errors(void *handle);

// Takes a block or a source of photons back.
void tofsim_delete(void *handle);

// The light of a scenario and its detector, from power-up; null if there is none, as `tofsim_new`.
//
// # Safety
// As of `tofsim_new`.
void *tofsim_photons_new(const char *version, const char *scenario);

// An edge of clk_sys, and what the firmware shows after it: a shot begins, the laser has been switched on by it, the
// SPAD is held, MODE, tdc_stop is to come from the ring oscillator, a frame has ended.
void tofsim_photons_edge(void *handle,
                         long long time_fs,
                         int start,
                         int laser,
                         int spad_rst,
                         int mode,
                         int ring_on,
                         int frame_done);

// When `tdc_stop` changes next before the coming edge or on it [fs], or -1; it has its new level then.
long long tofsim_photons_next(void *handle);

// The level of `tdc_stop`.
int tofsim_photons_level(void *handle);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* TOFSIM_H */
