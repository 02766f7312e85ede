/* Functions of tofsim as system functions and tasks, for simulators that have VPI and no DPI, such as Icarus:
 *
 *   iverilog-vpi tofsim_vpi.c -L<folder of libtofsim_dpi.so> -ltofsim_dpi
 *   vvp -M . -m tofsim_vpi <simulation>
 *
 * A handle is a number. $tofsim_report(handle) prints the errors of a handle and forgets them. */
#include <stdlib.h>
#include <string.h>
#include <vpi_user.h>

#include "tofsim.h"

/* What a call is given, in order; the rest is null. */
struct call {
  vpiHandle itself;
  vpiHandle args[9];
};

static struct call begin(void) {
  struct call call = {vpi_handle(vpiSysTfCall, NULL), {NULL}};
  vpiHandle args = vpi_iterate(vpiArgument, call.itself);
  vpiHandle arg;
  for (int n = 0; args && (arg = vpi_scan(args));)
    if (n < 9) call.args[n++] = arg;
  return call;
}

static long long number(vpiHandle arg) {
  s_vpi_value value = {.format = vpiVectorVal};
  if (!arg) return 0;
  vpi_get_value(arg, &value);
  unsigned long long words = value.value.vector[0].aval & ~(unsigned)value.value.vector[0].bval;
  if (vpi_get(vpiSize, arg) > 32)
    words |= (unsigned long long)(value.value.vector[1].aval & ~(unsigned)value.value.vector[1].bval) << 32;
  return (long long)words;
}

static void *handle(vpiHandle arg) { return (void *)(size_t)number(arg); }

/* A copy of a text, which the caller frees. */
static char *text(vpiHandle arg) {
  s_vpi_value value = {.format = vpiStringVal};
  if (!arg) return NULL;
  vpi_get_value(arg, &value);
  return strdup(value.value.str);
}

/* The bits of a vector, the lowest word first, x and z as 0, and behind as many words those that are x or z, if there
   are any: `unknown` is there. The caller frees them. */
static uint32_t *bits(vpiHandle arg, uint32_t **unknown) {
  s_vpi_value value = {.format = vpiVectorVal};
  *unknown = NULL;
  if (!arg) return NULL;
  int words = (vpi_get(vpiSize, arg) + 31) / 32;
  uint32_t *all = calloc(2 * words + 1, sizeof *all);
  vpi_get_value(arg, &value);
  for (int n = 0; n < words; n++) {
    uint32_t a = value.value.vector[n].aval, b = value.value.vector[n].bval;
    all[n] = a & ~b;
    all[words + n] = b;
    if (b) *unknown = all + words;
  }
  return all;
}

static PLI_INT32 give(struct call call, int result) {
  s_vpi_value value = {.format = vpiIntVal};
  value.value.integer = result;
  vpi_put_value(call.itself, &value, NULL, vpiNoDelay);
  return 0;
}

static PLI_INT32 make(PLI_BYTE8 *data) {
  struct call call = begin();
  char *version = text(call.args[0]), *scenario = text(call.args[1]), *block = text(call.args[2]);
  void *made = block ? tofsim_new(version, scenario, block) : tofsim_photons_new(version, scenario);
  free(version), free(scenario), free(block);
  (void)data;
  return give(call, (int)(size_t)made);
}

/* The width is that of the signal itself. */
static PLI_INT32 port(PLI_BYTE8 *data) {
  struct call call = begin();
  char *name = text(call.args[1]);
  int fits = tofsim_port(handle(call.args[0]), name, call.args[2] ? vpi_get(vpiSize, call.args[2]) : 0);
  free(name);
  (void)data;
  return give(call, fits);
}

static PLI_INT32 step(PLI_BYTE8 *data) {
  struct call call = begin();
  uint32_t *unknown, *inputs = bits(call.args[3], &unknown), *outputs = bits(call.args[4], &unknown);
  if (unknown) tofsim_unknown(handle(call.args[0]), unknown);
  int same = tofsim_step(handle(call.args[0]), (int)number(call.args[1]), number(call.args[2]), inputs, outputs);
  free(inputs), free(outputs);
  (void)data;
  return give(call, same);
}

static PLI_INT32 from_power_up(PLI_BYTE8 *data) {
  struct call call = begin();
  (void)data;
  tofsim_from_power_up(handle(call.args[0]));
  return 0;
}

static PLI_INT32 stop(PLI_BYTE8 *data) {
  struct call call = begin();
  (void)data;
  tofsim_stop(handle(call.args[0]), number(call.args[1]), (int)number(call.args[2]));
  return 0;
}

static PLI_INT32 report(PLI_BYTE8 *data) {
  void *of = handle(begin().args[0]);
  (void)data;
  for (int n = 0; n < tofsim_get_num_errors(of); n++) vpi_printf("%s\n", tofsim_get_error(of, n));
  tofsim_clear_errors(of);
  return 0;
}

/* Whether a block has been compared at all; prints how often. */
static PLI_INT32 ran(PLI_BYTE8 *data) {
  struct call call = begin();
  char *block = text(call.args[0]);
  long long compared = tofsim_get_num_compared(block);
  (void)data;
  if (compared > 0)
    vpi_printf("tofsim: %s: compared %lld times\n", block, compared);
  else
    vpi_printf("tofsim: %s: never compared: its clock or its reset never came\n", block);
  free(block);
  return give(call, compared > 0);
}

static PLI_INT32 photons_edge(PLI_BYTE8 *data) {
  struct call call = begin();
  int shown[6];
  (void)data;
  for (int n = 0; n < 6; n++) shown[n] = (int)number(call.args[n + 2]);
  tofsim_photons_edge(handle(call.args[0]), number(call.args[1]), shown[0], shown[1], shown[2], shown[3], shown[4],
                      shown[5]);
  return 0;
}

/* Into its second argument: a function of more than 32 bits would need a table beside it. */
static PLI_INT32 photons_next(PLI_BYTE8 *data) {
  struct call call = begin();
  long long next = tofsim_photons_next(handle(call.args[0]));
  s_vpi_vecval words[2] = {{(PLI_INT32)next, 0}, {(PLI_INT32)(next >> 32), 0}};
  s_vpi_value value = {.format = vpiVectorVal};
  value.value.vector = words;
  (void)data;
  if (call.args[1]) vpi_put_value(call.args[1], &value, NULL, vpiNoDelay);
  return 0;
}

static PLI_INT32 photons_level(PLI_BYTE8 *data) {
  struct call call = begin();
  (void)data;
  return give(call, tofsim_photons_level(handle(call.args[0])));
}

static void add(PLI_INT32 type, const char *name, PLI_INT32 (*called)(PLI_BYTE8 *)) {
  s_vpi_systf_data data = {.type = type, .tfname = (PLI_BYTE8 *)name, .calltf = called};
  if (type == vpiSysFunc) data.sysfunctype = vpiIntFunc;
  vpi_register_systf(&data);
}

static void all(void) {
  add(vpiSysFunc, "$tofsim_new", make);
  add(vpiSysFunc, "$tofsim_photons_new", make);
  add(vpiSysFunc, "$tofsim_port", port);
  add(vpiSysFunc, "$tofsim_step", step);
  add(vpiSysTask, "$tofsim_from_power_up", from_power_up);
  add(vpiSysTask, "$tofsim_stop", stop);
  add(vpiSysTask, "$tofsim_report", report);
  add(vpiSysFunc, "$tofsim_ran", ran);
  add(vpiSysTask, "$tofsim_photons_edge", photons_edge);
  add(vpiSysTask, "$tofsim_photons_next", photons_next);
  add(vpiSysFunc, "$tofsim_photons_level", photons_level);
}

void (*vlog_startup_routines[])(void) = {all, NULL};
