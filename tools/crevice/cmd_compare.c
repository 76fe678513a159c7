/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ao_pass.h"
#include "commands.h"
#include "common/flip.h"
#include "common/heatmap.h"
#include "common/metrics.h"
#include "common/metrics_print.h"
#include "common/progress.h"
#include "common/reading.h"
#include "passes/passes.h"

typedef struct compare_settings {
    common_settings common;
    const char *a, *b;
    const char *channel, *channel_b;
    arg_number ppd;
    const char *heat_map;
    arg_number heat_scale, open;
    bool json;
} compare_settings;

static const arg compare_rows[] = {
    {.name = "A",
     .required = true,
     ARG_INTO(ARG_TEXT, compare_settings, a),
     .help = "picture: EXR, PNG or PFM"},
    {.name = "B",
     .required = true,
     ARG_INTO(ARG_TEXT, compare_settings, b),
     .help = "picture of the same size"},
    {.name = "--channel",
     .value = "NAME",
     ARG_INTO(ARG_TEXT, compare_settings, channel),
     .computed = "AO, or the only channel",
     .help = "the channel to compare"},
    {.name = "--channel-b",
     .value = "NAME",
     ARG_INTO(ARG_TEXT, compare_settings, channel_b),
     .computed = "as for A",
     .help = "the channel of B, if its name differs"},
    {.name = "--open",
     .value = "A",
     ARG_RANGE(0.0, 1.0),
     .initial = "0.5",
     ARG_INTO(ARG_NUMBER, compare_settings, open),
     .help = "bent normals are also compared on open surfaces alone: where the channel "
             "of B is above this"},
    {.name = "--ppd",
     .value = "X",
     ARG_RANGE(FLIP_PPD_MIN, FLIP_PPD_MAX),
     .unit = "pixels per degree",
     ARG_INTO(ARG_NUMBER, compare_settings, ppd),
     .initial = FLIP_PPD_TEXT,
     .help = "from where FLIP looks at the pictures; the default is 0.7 m before a "
             "screen 0.7 m wide of 3840 pixels"},
    {.name = "--heat-map",
     .value = "FILE",
     ARG_INTO(ARG_TEXT, compare_settings, heat_map),
     .help = "write a picture (.png or .exr) of the signed error: orange where A is "
             "above B, blue where below, white where equal, grey background"},
    {.name = "--heat-scale",
     .value = "X",
     ARG_RANGE(1e-4, 1e3),
     ARG_INTO(ARG_NUMBER, compare_settings, heat_scale),
     .initial = "0.25",
     .help = "the error that gets the darkest colours of the heat map"},
    {.name = "--json",
     ARG_INTO(ARG_FLAG, compare_settings, json),
     .help = "write JSON; numbers that are not finite become null"},
};
static const arg_table compare_table = ARG_TABLE("Pictures", compare_rows);

static const arg_table *const tables[] = {&compare_table, &args_output_lines, NULL};

static const char *const examples[] = {
    "how far is the estimate from the renderer's own ambient occlusion?",
    "crevice compare ao.exr blender.exr",
    "for a script",
    "crevice compare --json a.png b.png | jq .rmse",
    "where it is too bright (orange) and too dark (blue) by up to 0.1",
    "crevice compare ao.exr reference.exr --heat-map error.png --heat-scale 0.1",
    NULL,
};

/* What is read of a file: the compared channel, and what tells background. */
typedef struct picture {
    io_image image;
    const float *values;
    const float *depth;     /* NULL: there is none */
    const float *normal[3]; /* all or none */
    const float *bent[3];   /* bent normals: all or none */
} picture;

enum { MAX_READ = 8 };

/* The place of a name in the list, to which it is added if it is not there yet. */
static int32_t place_of(const char *names[MAX_READ], int32_t *count, const char *name)
{
    for (int32_t i = 0; i < *count; i++)
        if (strcmp(names[i], name) == 0)
            return i;
    names[*count] = name;
    return (*count)++;
}

static int read_channels(const char *path, const io_image *probe, const char *chosen,
                         picture *out, report *r)
{
    const char *names[MAX_READ], *depth[3], *normal[3], *bent[3];
    int32_t count = 0, depth_at = -1, normal_at[3] = {-1, -1, -1};
    int32_t bent_at[3] = {-1, -1, -1};
    place_of(names, &count, chosen);
    if (io_find_pass(probe, IO_PASS_DEPTH, depth))
        depth_at = place_of(names, &count, depth[0]);
    if (io_find_pass(probe, IO_PASS_NORMAL, normal))
        for (int i = 0; i < 3; i++)
            normal_at[i] = place_of(names, &count, normal[i]);
    if (io_find_pass(probe, IO_PASS_BENT_NORMAL, bent))
        for (int i = 0; i < 3; i++)
            bent_at[i] = place_of(names, &count, bent[i]);
    /* Passes of parts with other windows tell nothing of the compared pixels. */
    if (reading_picture(path, names, count, &out->image, NULL, r) != 0) {
        depth_at = normal_at[0] = bent_at[0] = -1;
        if (reading_picture(path, names, 1, &out->image, &r->logger, r) != 0)
            return EXIT_FAILED;
    }
    out->values = out->image.channels[0].data;
    out->depth = depth_at >= 0 ? out->image.channels[depth_at].data : NULL;
    for (int i = 0; i < 3 && normal_at[0] >= 0; i++)
        out->normal[i] = out->image.channels[normal_at[i]].data;
    for (int i = 0; i < 3 && bent_at[0] >= 0; i++)
        out->bent[i] = out->image.channels[bent_at[i]].data;
    return EXIT_DONE;
}

static double normal_length(const picture *p, size_t i)
{
    const double x = (double)p->normal[0][i], y = (double)p->normal[1][i],
                 z = (double)p->normal[2][i];
    return sqrt(x * x + y * y + z * z);
}

/* A renderer's mean over a silhouette is shorter than one. */
static bool is_unit(const picture *p, size_t i)
{
    return fabs(normal_length(p, i) - 1.0) <= 0.01;
}

/* Whether normals tell background at all: those that are stored as n / 2 + 1/2 do not. */
static bool are_unit(const picture *p)
{
    const size_t count = (size_t)p->image.width * (size_t)p->image.height;
    size_t unit = 0, none = 0;
    for (size_t i = 0; i < count; i++) {
        unit += is_unit(p, i);
        none += !(normal_length(p, i) > 0.0);
    }
    return 2 * (unit + none) > count;
}

static int load(const char *path, const char *wanted, picture *out, report *r)
{
    io_image probe = {0};
    if (io_probe(path, &probe, &r->logger) != 0)
        return EXIT_FAILED;
    const char *chosen = ao_pass_choose(path, &probe, wanted, "--channel", r);
    const int result = chosen ? read_channels(path, &probe, chosen, out, r) : EXIT_USAGE;
    io_image_free(&probe);
    if (result == EXIT_DONE && out->normal[0] && !are_unit(out))
        out->normal[0] = NULL;
    return result;
}

static bool is_background(const picture *p, size_t i)
{
    if (p->depth && !(p->depth[i] > 0.0f && p->depth[i] < 1e10f))
        return true;
    return p->normal[0] && !is_unit(p, i);
}

static uint8_t *make_mask(const picture *a, const picture *b, report *r)
{
    const size_t count = (size_t)a->image.width * (size_t)a->image.height;
    uint8_t *mask = malloc(count);
    if (!mask) {
        report_no_memory(r);
        return NULL;
    }
    for (size_t i = 0; i < count; i++)
        mask[i] = !is_background(a, i) && !is_background(b, i);
    return mask;
}

static bool finite_values(const char *path, const picture *p, const float *values,
                          const uint8_t *mask, report *r)
{
    const int64_t bad =
        metrics_count_not_finite(values, mask, p->image.width, p->image.height);
    if (bad > 0)
        report_error(r, "%s: %lld compared values are NaN or infinite; mend the picture",
                     path, (long long)bad);
    return bad == 0;
}

/* The space of the bent normals, if the file says it; else NULL. */
static const char *space_of(const picture *p)
{
    return strstr(p->image.made, " bent=view")    ? "view"
           : strstr(p->image.made, " bent=world") ? "world"
                                                  : NULL;
}

/* Angles of the bent normals, if both files have them; the mask is narrowed to the open
 * surfaces. */
static int measure_angles(const compare_settings *s, const picture *a, const picture *b,
                          uint8_t *mask, metrics_findings *f, report *r)
{
    const size_t count = (size_t)a->image.width * (size_t)a->image.height;
    const char *space_a = space_of(a), *space_b = space_of(b);
    f->has_bent = a->bent[0] && b->bent[0];
    if (!f->has_bent && s->open.given) {
        report_error(r, "--open: is for bent normals, which %s lacks; leave it out",
                     a->bent[0] ? s->b : s->a);
        return EXIT_USAGE;
    }
    if (!f->has_bent)
        return EXIT_DONE;
    if (space_a && space_b && strcmp(space_a, space_b) != 0) {
        report_error(r,
                     "%s: its bent normals are in %s space, those of %s in %s space; "
                     "make both with one --bent-space",
                     s->a, space_a, s->b, space_b);
        return EXIT_FAILED;
    }
    for (int i = 0; i < 3; i++)
        if (!finite_values(s->a, a, a->bent[i], mask, r)
            || !finite_values(s->b, b, b->bent[i], mask, r))
            return EXIT_FAILED;
    if (!metrics_compare_angles(a->bent, b->bent, mask, count, &f->bent))
        return report_no_memory(r);
    for (size_t i = 0; i < count; i++)
        mask[i] = mask[i] && (double)b->values[i] > s->open.value;
    return metrics_compare_angles(a->bent, b->bent, mask, count, &f->bent_open)
               ? EXIT_DONE
               : report_no_memory(r);
}

/* Pixels from which on it may take longer than ten seconds, and the share of them that
 * tells for how long. */
enum { MANY_PIXELS = 1000000, TRIAL_SHARE = 32 };

/* Signed errors and SSIM take about a quarter of the work, FLIP another. */
enum { PART_METRICS = 1, PARTS = 4 };

static void show_rows(void *user, int32_t rows)
{
    progress *p = user;
    progress_show(p, PART_METRICS * p->total / PARTS + rows);
}

/* Rows from y on. p NULL: without a word. False: no memory. */
static bool measure_rows(const compare_settings *s, const picture *a, const picture *b,
                         const uint8_t *mask, int32_t y, int32_t rows, progress *p,
                         metrics_findings *f)
{
    const int32_t width = a->image.width;
    const size_t first = (size_t)y * (size_t)width;
    const float *va = a->values + first, *vb = b->values + first;
    mask += first;
    return metrics_compare(va, vb, mask, width, rows, &f->m)
           && flip_compare(va, vb, mask, width, rows, s->ppd.value, p ? show_rows : NULL,
                           p, &f->flip)
           && metrics_fit_curves(va, vb, mask, width, rows, &f->fit);
}

/* A strip in the middle tells how long the whole takes. */
static void announce(const compare_settings *s, const picture *a, const picture *b,
                     const uint8_t *mask, report *r)
{
    const int32_t height = a->image.height, rows = height / TRIAL_SHARE;
    metrics_findings nobody = {0};
    if ((int64_t)a->image.width * height < MANY_PIXELS || rows < 1)
        return;
    const double start = report_seconds();
    if (measure_rows(s, a, b, mask, (height - rows) / 2, rows, NULL, &nobody))
        progress_announce(r, "compare", (report_seconds() - start) * height / rows);
}

static int measure(const compare_settings *s, const picture *a, const picture *b,
                   const uint8_t *mask, metrics_findings *f, report *r)
{
    const int32_t height = a->image.height;
    if (!finite_values(s->a, a, a->values, mask, r)
        || !finite_values(s->b, b, b->values, mask, r))
        return EXIT_FAILED;
    announce(s, a, b, mask, r);
    progress p = progress_begin(r, "compare", 0, (int64_t)PARTS * height);
    const bool done = measure_rows(s, a, b, mask, 0, height, &p, f);
    progress_end(&p);
    if (!done)
        return report_no_memory(r);
    if (f->m.pixels == 0) {
        report_error(r,
                     "%s: no pixel to compare, all is background; check the Z and N "
                     "channels of both files",
                     s->a);
        return EXIT_FAILED;
    }
    return EXIT_DONE;
}

static int compare(const compare_settings *s, const picture *a, const picture *b,
                   report *r)
{
    heatmap_source source = {a->values,      b->values,       NULL,
                             a->image.width, a->image.height, s->heat_scale.value};
    metrics_findings f = {.a = s->a,
                          .b = s->b,
                          .width = a->image.width,
                          .height = a->image.height,
                          .flip_ppd = s->ppd.value,
                          .open = s->open.value,
                          .heat_map = s->heat_map,
                          .heat_scale = s->heat_scale.value};
    if (a->image.width != b->image.width || a->image.height != b->image.height) {
        report_error(r, "%s: is %dx%d, but %s is %dx%d; compare pictures of one size",
                     s->b, b->image.width, b->image.height, s->a, a->image.width,
                     a->image.height);
        return EXIT_FAILED;
    }
    uint8_t *mask = make_mask(a, b, r);
    if (!mask)
        return EXIT_FAILED;
    int result = measure(s, a, b, mask, &f, r);
    source.mask = mask;
    if (result == EXIT_DONE && s->heat_map)
        result = heatmap_write(s->heat_map, &source, r);
    if (result == EXIT_DONE)
        result = measure_angles(s, a, b, mask, &f, r);
    free(mask);
    if (result == EXIT_DONE && s->json)
        return metrics_print_json(&f, r);
    if (result == EXIT_DONE)
        metrics_print_text(&f);
    return result;
}

static int check_heat_map(const compare_settings *s, report *r)
{
    if (s->heat_map)
        return heatmap_check(s->heat_map, s->a, s->b, r);
    if (!s->heat_scale.given)
        return EXIT_DONE;
    report_error(r, "--heat-scale: there is no heat map; add --heat-map FILE");
    return EXIT_USAGE;
}

static int run(const void *settings, report *r)
{
    const compare_settings *s = settings;
    picture a = {0}, b = {0};
    int result = check_heat_map(s, r);
    if (result == EXIT_DONE)
        result = load(s->a, s->channel, &a, r);
    if (result == EXIT_DONE)
        result = load(s->b, s->channel_b ? s->channel_b : s->channel, &b, r);
    if (result == EXIT_DONE)
        result = compare(s, &a, &b, r);
    io_image_free(&a.image);
    io_image_free(&b.image);
    return result;
}

const command command_compare = {
    .name = "compare",
    .summary = "compare two pictures: RMSE, MAE, PSNR, SSIM, FLIP, signed error, heat "
               "map",
    .synopsis = "A B [--channel NAME] [--heat-map FILE] [--json]",
    .details =
        "Of a renderer's file the pass of ambient occlusion is taken by its name, and "
        "depth and normals tell background (`crevice help passes`). Pixels that are "
        "background in either file are left out: those whose depth is not finite, not "
        "positive or at least 1e10, and those whose normals are not of unit length (1 % "
        "off), if most are. SSIM is the mean over 11x11 "
        "windows without such pixels. FLIP (Andersson et al. 2020) is the mean of the "
        "difference seen when the pictures alternate on a screen, their values shown as "
        "sRGB grey and the background white. Signed errors are A - B: bias is their "
        "mean, 1 and 99 percent of them are below the two ends given. Fitted is A as "
        "max(0, 1 - intensity (1 - A))^power with the intensity in 0 to 100 and the "
        "power "
        "in 0.01 to 100 that bring it nearest to B: what differs in strength only can be "
        "mended with --intensity and --contrast. If both files have bent normals (bent.X "
        "bent.Y bent.Z, in the same space), 50 and 95 percent of the angles between them "
        "are below the two given.",
    .tables = tables,
    .examples = examples,
    .settings_size = sizeof(compare_settings),
    .run = run,
};
