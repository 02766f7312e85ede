/* The model's spad_control by itself: its outputs over some edges, and what it says of a design that has others. */
#include <stdint.h>
#include <stdio.h>
#include "tofsim.h"

static void print_errors(void *handle) {
  for (int number = 0; number < tofsim_get_num_errors(handle); number++)
    puts(tofsim_get_error(handle, number));
  tofsim_clear_errors(handle);
}

int main(int count, char **words) {
  /* Inputs are rst, mode and pre_start, from the highest bit on; outputs are spad_rst and the 40 bits of spad_sel. */
  static const uint32_t inputs[] = {4, 0, 1, 0, 0};
  void *model = tofsim_new(TOFSIM_VERSION, count > 1 ? words[1] : "kc705", "spad_control");
  if (!model) {
    print_errors(NULL);
    return 1;
  }
  for (int edge = 0; edge < 5; edge++) {
    int64_t time_fs = edge * INT64_C(8000000);
    uint32_t outputs[2];
    tofsim_outputs(model, time_fs, &inputs[edge], outputs);
    printf("edge %d: spad_rst %u, spad_sel %02x%08x\n", edge, outputs[1] >> 8 & 1, outputs[1] & 0xff, outputs[0]);
    if (edge == 4)
      outputs[0] ^= 1;
    tofsim_step(model, 1, time_fs, &inputs[edge], outputs);
  }
  print_errors(model);
  tofsim_delete(model);
  return 0;
}
