/* SPDX-License-Identifier: MIT */
#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "io.h"
#include "metrics.h"

typedef struct compare_settings {
    common_settings common;
    const char *a, *b;
    const char *channel, *channel_b;
    bool json;
} compare_settings;

static const arg compare_rows[] = {
    {.name = "A",
     .type = ARG_TEXT,
     .required = true,
     .offset = offsetof(compare_settings, a),
     .help = "picture: EXR, PNG or PFM"},
    {.name = "B",
     .type = ARG_TEXT,
     .required = true,
     .offset = offsetof(compare_settings, b),
     .help = "picture of the same size"},
    {.name = "--channel",
     .value = "NAME",
     .type = ARG_TEXT,
     .offset = offsetof(compare_settings, channel),
     .computed = "AO, or the only channel",
     .help = "the channel to compare"},
    {.name = "--channel-b",
     .value = "NAME",
     .type = ARG_TEXT,
     .offset = offsetof(compare_settings, channel_b),
     .computed = "as for A",
     .help = "the channel of B, where its name differs"},
    {.name = "--json",
     .type = ARG_FLAG,
     .offset = offsetof(compare_settings, json),
     .help = "write JSON; numbers that are not finite become null"},
};
static const arg_table compare_table = ARG_TABLE("Pictures", compare_rows);

static const arg_table *const tables[] = {&compare_table, &args_output_lines, NULL};

static const char *const examples[] = {
    "how far is the estimate from the renderer's own ambient occlusion?",
    "crevice compare ao.exr blender.exr",
    "for a script",
    "crevice compare --json a.png b.png | jq .rmse",
    NULL,
};

/* What is read of a file: the compared channel, and what tells background. */
typedef struct picture {
    io_image image;
    const float *values;
    const float *depth;     /* NULL: there is none */
    const float *normal[3]; /* all or none */
} picture;

static const char *const normal_names[3] = {"N.X", "N.Y", "N.Z"};

static const char *choose_channel(const char *path, const io_image *probe,
                                  const char *wanted, report *r)
{
    const char *grey[] = {"AO", "Y"};

    if (wanted != NULL)
        return wanted; /* io_read() says which there are where it is not one of them */
    if (probe->channel_count == 1)
        return probe->channels[0].name;
    for (size_t i = 0; i < sizeof grey / sizeof grey[0]; i++)
        if (io_image_find(probe, grey[i]) != NULL)
            return grey[i];
    report_error(r, "%s: has %d channels and none is named AO; choose one with --channel",
                 path, probe->channel_count);
    return NULL;
}

static const float *channel_data(const io_image *image, const char *name)
{
    const io_channel *channel = io_image_find(image, name);

    return channel != NULL ? channel->data : NULL;
}

static int load(const char *path, const char *wanted, picture *out, report *r)
{
    io_image probe = {0};
    char name[IO_NAME_SIZE];
    const char *names[5];
    int32_t count = 0;
    const char *chosen;

    if (io_probe(path, &probe, &r->logger) != 0)
        return EXIT_FAILED;
    chosen = choose_channel(path, &probe, wanted, r);
    if (chosen == NULL) {
        io_image_free(&probe);
        return EXIT_USAGE;
    }
    snprintf(name, sizeof name, "%s", chosen);
    names[count++] = name;
    if (strcmp(name, "Z") != 0 && io_image_find(&probe, "Z") != NULL)
        names[count++] = "Z";
    for (int i = 0; i < 3; i++)
        if (strcmp(name, normal_names[i]) != 0
            && io_image_find(&probe, normal_names[i]) != NULL)
            names[count++] = normal_names[i];
    io_image_free(&probe);
    if (io_read(path, names, count, &out->image, &r->logger) != 0)
        return EXIT_FAILED;
    out->values = channel_data(&out->image, name);
    out->depth = channel_data(&out->image, "Z");
    for (int i = 0; i < 3; i++)
        out->normal[i] = channel_data(&out->image, normal_names[i]);
    return EXIT_DONE;
}

static bool is_background(const picture *p, size_t i)
{
    if (p->depth != NULL && !(p->depth[i] > 0.0f && p->depth[i] < 1e10f))
        return true;
    if (p->normal[0] == NULL || p->normal[1] == NULL || p->normal[2] == NULL)
        return false;
    double x = (double)p->normal[0][i], y = (double)p->normal[1][i],
           z = (double)p->normal[2][i];
    /* Where a renderer averaged over a silhouette the mean normal is shorter than one. */
    return !(fabs(sqrt(x * x + y * y + z * z) - 1.0) <= 0.01);
}

static uint8_t *make_mask(const picture *a, const picture *b, report *r)
{
    size_t count = (size_t)a->image.width * (size_t)a->image.height;
    uint8_t *mask = malloc(count);

    if (mask == NULL) {
        report_no_memory(r);
        return NULL;
    }
    for (size_t i = 0; i < count; i++)
        mask[i] = !is_background(a, i) && !is_background(b, i);
    return mask;
}

static void add_number(cJSON *object, const char *key, double value)
{
    if (isfinite(value))
        cJSON_AddNumberToObject(object, key, value);
    else
        cJSON_AddNullToObject(object, key);
}

static int print_json(const compare_settings *s, const picture *a, const metrics *m,
                      report *r)
{
    cJSON *root = cJSON_CreateObject();
    char *text;

    cJSON_AddStringToObject(root, "a", s->a);
    cJSON_AddStringToObject(root, "b", s->b);
    add_number(root, "width", a->image.width);
    add_number(root, "height", a->image.height);
    add_number(root, "pixels", (double)m->pixels);
    add_number(root, "mean_a", m->mean_a);
    add_number(root, "mean_b", m->mean_b);
    add_number(root, "rmse", m->rmse);
    add_number(root, "mae", m->mae);
    add_number(root, "psnr_db", m->psnr_db);
    add_number(root, "ssim", m->ssim);
    add_number(root, "ssim_windows", (double)m->ssim_windows);
    add_number(root, "max_error", m->max_error);
    add_number(root, "max_x", m->max_x);
    add_number(root, "max_y", m->max_y);
    text = cJSON_Print(root);
    cJSON_Delete(root);
    if (text == NULL)
        return report_no_memory(r);
    puts(text);
    cJSON_free(text);
    return EXIT_DONE;
}

static void print_text(const picture *a, const metrics *m)
{
    printf("pixels   %lld of %lld\n", (long long)m->pixels,
           (long long)a->image.width * a->image.height);
    printf("mean     %.6f and %.6f\n", m->mean_a, m->mean_b);
    printf("RMSE     %.6f\n", m->rmse);
    printf("MAE      %.6f\n", m->mae);
    printf("PSNR     %.2f dB\n", m->psnr_db);
    if (m->ssim_windows > 0)
        printf("SSIM     %.6f\n", m->ssim);
    else
        printf("SSIM     none: no 11x11 window without background\n");
    printf("largest  %.6f at (%d, %d)\n", m->max_error, m->max_x, m->max_y);
}

static bool finite_values(const char *path, const picture *p, const uint8_t *mask,
                          report *r)
{
    int64_t bad =
        metrics_count_not_finite(p->values, mask, p->image.width, p->image.height);

    if (bad > 0)
        report_error(r, "%s: %lld compared values are NaN or infinite; mend the picture",
                     path, (long long)bad);
    return bad == 0;
}

static int compare(const compare_settings *s, const picture *a, const picture *b,
                   report *r)
{
    metrics m;
    int result = EXIT_FAILED;
    uint8_t *mask;

    if (a->image.width != b->image.width || a->image.height != b->image.height) {
        report_error(r, "%s: is %dx%d, but %s is %dx%d; compare pictures of one size",
                     s->b, b->image.width, b->image.height, s->a, a->image.width,
                     a->image.height);
        return EXIT_FAILED;
    }
    mask = make_mask(a, b, r);
    if (mask == NULL)
        return EXIT_FAILED;
    if (finite_values(s->a, a, mask, r) && finite_values(s->b, b, mask, r)) {
        if (!metrics_compare(a->values, b->values, mask, a->image.width, a->image.height,
                             &m))
            report_no_memory(r);
        else if (m.pixels == 0)
            report_error(r,
                         "%s: no pixel to compare, all is background; check the Z "
                         "and N channels of both files",
                         s->a);
        else
            result = EXIT_DONE;
    }
    free(mask);
    if (result == EXIT_DONE && s->json)
        return print_json(s, a, &m, r);
    if (result == EXIT_DONE)
        print_text(a, &m);
    return result;
}

static int run(const void *settings, report *r)
{
    const compare_settings *s = settings;
    picture a = {0}, b = {0};
    int result = load(s->a, s->channel, &a, r);

    if (result == EXIT_DONE)
        result = load(s->b, s->channel_b != NULL ? s->channel_b : s->channel, &b, r);
    if (result == EXIT_DONE)
        result = compare(s, &a, &b, r);
    io_image_free(&a.image);
    io_image_free(&b.image);
    return result;
}

const command command_compare = {
    .name = "compare",
    .summary = "the difference of two pictures: RMSE, MAE, PSNR, SSIM, largest error",
    .synopsis = "A B [--channel NAME] [--json]",
    .details =
        "Pixels that are background in either file are left out: where a channel Z "
        "is not finite, not positive or at least 1e10, and where the normals N.X, "
        "N.Y, N.Z are not of unit length (1 % off). SSIM is the mean over 11x11 "
        "windows without such pixels.",
    .tables = tables,
    .examples = examples,
    .settings_size = sizeof(compare_settings),
    .run = run,
};
