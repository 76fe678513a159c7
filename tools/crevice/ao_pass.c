/* SPDX-License-Identifier: MIT */
#include "ao_pass.h"

#include <string.h>

#include "passes/passes.h"

const char *ao_pass_choose(const char *path, const io_image *probe, const char *wanted,
                           const char *cure, report *r)
{
    const char *found[3];
    if (wanted)
        return wanted; /* io_read() lists them if it is not one of them */
    if (probe->channel_count == 1)
        return probe->channels[0].name;
    if (io_find_pass(probe, IO_PASS_AO, found)) {
        if (strcmp(found[0], "AO") != 0)
            report_info(r, "%s: \"%s\" is taken (choose with %s)", path, found[0], cure);
        return found[0];
    }
    if (io_image_find(probe, "Y"))
        return "Y";
    report_error(r,
                 "%s: has %d channels and none is named AO or the like; choose one with "
                 "%s",
                 path, probe->channel_count, cure);
    return NULL;
}
