/* SPDX-License-Identifier: MIT */
#include "device.h"

#include <stdio.h>
#include <string.h>

/* "auto", then the names in the order of crv_isa. */
static const char *const isa_choices[] = {"auto",   "scalar", "sse4", "avx2",
                                          "avx512", "neon",   NULL};

static const arg device_rows[] = {
    {.name = "--isa",
     .value = "NAME",
     .type = ARG_CHOICE,
     .choices = isa_choices,
     .initial = "auto",
     .offset = offsetof(common_settings, isa),
     .help = "instruction set of the kernels; auto: the best that this machine has"},
    {.name = "--exact",
     .type = ARG_FLAG,
     .offset = offsetof(common_settings, exact),
     .help = "sample exactly where the plain code does: slower, no better"},
};
const arg_table args_device = ARG_TABLE("Device", device_rows);

/* The names of a mask's sets, ", " between them. */
static void list_sets(uint32_t mask, char *out, size_t size)
{
    size_t used = 0;

    out[0] = '\0';
    for (int i = CRV_ISA_SCALAR; crv_isa_name((crv_isa)i) != NULL && used < size; i++)
        if (mask >> i & 1)
            used += (size_t)snprintf(out + used, size - used, "%s%s", used ? ", " : "",
                                     crv_isa_name((crv_isa)i));
}

int device_context(const common_settings *common, const crv_logger *logger, report *r,
                   crv_context **out)
{
    return device_context_in(common, logger, NULL, r, out);
}

int device_context_in(const common_settings *common, const crv_logger *logger,
                      const crv_allocator *allocator, report *r, crv_context **out)
{
    const uint32_t available = crv_isa_available();
    crv_context_desc desc;

    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = *logger;
    desc.threads = common->threads.value;
    desc.exact = common->exact;
    if (allocator != NULL)
        desc.allocator = *allocator;
    if (common->isa.value > 0) {
        desc.isa_mask = 1u << (common->isa.value - 1);
        if (!(desc.isa_mask & available)) {
            char names[128];
            list_sets(available, names, sizeof names);
            report_error(r, "--isa %s: not on this machine; there are %s",
                         isa_choices[common->isa.value], names);
            return EXIT_USAGE;
        }
    }
    return report_ok(r, crv_context_create(&desc, out), "context") ? EXIT_DONE
                                                                   : EXIT_FAILED;
}
