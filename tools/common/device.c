/* SPDX-License-Identifier: MIT */
#ifdef CREVICE_HAS_VULKAN
#include <crevice/vulkan.h>
#endif

#include "device.h"

#include <stdio.h>
#include <string.h>

static const arg device_rows[] = {
    {.name = "--device",
     .value = "DEVICE",
     .computed = "cpu",
     ARG_INTO(ARG_TEXT, common_settings, device),
     .help = "what computes: cpu, or vulkan or vulkan:N, the GPU that `crevice devices` "
             "gives that number (vulkan: 0)"},
    {.name = "--isa",
     .value = "ISA",
     .computed = "the fastest",
     ARG_INTO(ARG_TEXT, common_settings, isa),
     .help =
         "instruction set of the CPU's kernels, one that `crevice devices` lists; for "
         "comparing"},
    {.name = "--exact",
     ARG_INTO(ARG_FLAG, common_settings, exact),
     .help = "on the CPU, sample exactly where the reference code does: up to 4 times "
             "slower and no better; for comparing with other devices"},
};
const arg_table args_device = ARG_TABLE("Device", device_rows);

void device_list_isas(char *out, size_t size)
{
    const uint32_t available = crv_isa_available();
    size_t used = 0;
    out[0] = '\0';
    for (int i = CRV_ISA_SCALAR; crv_isa_name((crv_isa)i) && used < size; i++)
        if (available >> i & 1)
            used += (size_t)snprintf(out + used, size - used, "%s%s",
                                     used > 0 ? ", " : "", crv_isa_name((crv_isa)i));
}

bool device_is_cpu(const common_settings *common)
{
    return !common->device || strcmp(common->device, "cpu") == 0;
}

/* Reads --device; false if it names nothing. */
static bool parse_device(const char *name, crv_context_desc *desc)
{
    int index = 0, end = 0;
    if (!name || strcmp(name, "cpu") == 0)
        return true;
    desc->device = CRV_DEVICE_VULKAN;
    if (strcmp(name, "vulkan") == 0)
        return true;
    if (strspn(name + strcspn(name, ":"), ":0123456789") > 4
        || sscanf(name, "vulkan:%d%n", &index, &end) != 1 || name[end] != '\0'
        || index < 0)
        return false;
    desc->device_index = index;
    return true;
}

/* Reads --isa; false if this machine has no such set. */
static bool parse_isa(const char *name, crv_context_desc *desc)
{
    const uint32_t available = crv_isa_available();
    for (int i = CRV_ISA_SCALAR; name && crv_isa_name((crv_isa)i); i++)
        if (strcmp(crv_isa_name((crv_isa)i), name) == 0)
            desc->isa_mask = 1u << i & available;
    return !name || desc->isa_mask;
}

static int choose_device(const common_settings *common, crv_context_desc *desc, report *r)
{
    if (!parse_device(common->device, desc)) {
        report_error(r, "--device: \"%s\" is no device; give cpu, vulkan or vulkan:N",
                     common->device);
        return EXIT_USAGE;
    }
    if (desc->device != CRV_DEVICE_CPU && (common->isa || common->exact)) {
        report_error(r, "%s: is for the CPU; leave it out with --device %s",
                     common->exact ? "--exact" : "--isa", common->device);
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}

/* How plans on a GPU work. */
static crv_status tune_plans(const common_settings *common, crv_context *context)
{
    if (common->depth_layout == 0 && !common->half_filters)
        return CRV_OK;
#ifdef CREVICE_HAS_VULKAN
    return crv_vulkan_context_set_plans(
        context, (crv_vulkan_depth_layout)common->depth_layout,
        common->half_filters ? CRV_VULKAN_HALF_ON : CRV_VULKAN_HALF_OFF);
#else
    (void)context;
    return CRV_ERROR_UNSUPPORTED;
#endif
}

int device_context_in(const common_settings *common, crv_context_desc *desc, report *r,
                      crv_context **out)
{
    desc->threads = common->threads.value;
    desc->exact = common->exact;
    if (choose_device(common, desc, r) != EXIT_DONE)
        return EXIT_USAGE;
    if (!parse_isa(common->isa, desc)) {
        char names[128];
        device_list_isas(names, sizeof names);
        report_error(r, "--isa %s: not on this machine; there are %s", common->isa,
                     names);
        return EXIT_USAGE;
    }
    return report_ok(r, crv_context_create(desc, out), "context")
                   && report_ok(r, tune_plans(common, *out), "context")
               ? EXIT_DONE
               : EXIT_FAILED;
}

int device_context(const common_settings *common, report *r, progress *run,
                   crv_context **out)
{
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = r->logger;
    desc.progress = progress_runs(run);
    desc.parallel = progress_loops(r, common->threads.value);
    return device_context_in(common, &desc, r, out);
}
