/* SPDX-License-Identifier: MIT */
/* section_fetches.c: by which path a GPU reads depth how fast. */
#include <math.h>

#include "bench/bench.h"
#include "common/device.h"
#include "study/study.h"

static const char *const paths[CRV_FETCH_PATHS] = {
    [CRV_FETCH_SAMPLED] = "sampled image", [CRV_FETCH_STORAGE_IMAGE] = "storage image",
    [CRV_FETCH_BUFFER] = "storage buffer", [CRV_FETCH_GATHER] = "gather of four",
    [CRV_FETCH_SHARED] = "shared memory",
};

static const char *const patterns[CRV_FETCH_PATTERNS] = {
    [CRV_FETCH_ROW] = "row",
    [CRV_FETCH_NEAR] = "near",
    [CRV_FETCH_DISK] = "disk",
    [CRV_FETCH_IN_STEP] = "in_step",
};

static void print(const bench *b)
{
    static const bench_column columns[] = {
        {"path", "path", -1, 0},
        {"row", "row", 2, 1e-9},
        {"8 px", "near", 2, 1e-9},
        {"64 px", "disk", 2, 1e-9},
        {"64 px, in step", "in_step", 2, 1e-9},
    };

    bench_print_list(b,
                     "Depths fetched, 10^9 a second by the device's clock: 64 of a row, "
                     "or of a disk around each pixel, at most so far off",
                     "device_fetches", columns, sizeof columns / sizeof columns[0]);
}

int bench_fetch_section(bench *b)
{
    double per_s[CRV_FETCH_PATHS][CRV_FETCH_PATTERNS];
    crv_context *context = NULL;
    int result = device_context(&b->settings->common, &b->r->logger, b->r, &context);

    bench_progress(b, "fetches of %s", b->settings->common.device);
    if (result == EXIT_DONE
        && !report_ok(b->r, crv_context_device_fetches(context, per_s), "fetches"))
        result = EXIT_FAILED;
    crv_context_destroy(context);
    for (int i = 0; i < CRV_FETCH_PATHS && result == EXIT_DONE; i++) {
        cJSON *row = cJSON_CreateObject();
        cJSON_AddStringToObject(row, "path", paths[i]);
        for (int k = 0; k < CRV_FETCH_PATTERNS; k++)
            study_add_number(row, patterns[k], per_s[i][k] > 0 ? per_s[i][k] : NAN);
        bench_append(b, "device_fetches", row);
    }
    if (result == EXIT_DONE)
        print(b);
    return result;
}
