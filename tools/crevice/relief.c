/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/estimate.h"
#include "common/reading.h"
#include "render.h"

/* In the order of crv_wrap. */
static const char *const wraps[] = {"repeat", "clamp", NULL};

static const arg relief_rows[] = {
    {.name = "--height-map",
     .value = "FILE",
     ARG_INTO(ARG_TEXT, render_settings, height_map),
     .help = "relief over the mesh's texture coordinates, white being high: .png (0 to "
             "1), or .exr or .pfm (one channel, Y or R). Makes vao the default method"},
    {.name = "--height-scale",
     .value = "H",
     ARG_RANGE(-1e9, 1e9),
     .unit = "scene units",
     ARG_INTO(ARG_NUMBER, render_settings, height_scale),
     .help = "how far a height of 1 stands out; negative: lies in"},
    {.name = "--height-wrap",
     .value = "KIND",
     .choices = wraps,
     .initial = "repeat",
     ARG_INTO(ARG_CHOICE, render_settings, height_wrap),
     .help = "what lies beyond the map's edge"},
};
const arg_table relief_table = ARG_TABLE("Relief", relief_rows);

int relief_check(const render_settings *s, report *r)
{
    if (s->height_map) {
        const int result = estimate_check_method("--height-map", "characteristic",
                                                 s->view.common.options.method, r);
        if (result != EXIT_DONE)
            return result;
    }
    if (s->height_map && s->height_scale.given)
        return EXIT_DONE;
    if (s->height_map)
        report_error(r, "--height-map: has no scale; add --height-scale, scene units for "
                        "a height of 1");
    else if (estimate_is_of_relief(&s->view.common.options))
        report_error(r, "--characteristic field: there is no relief; add --height-map "
                        "FILE");
    else if (s->height_scale.given || s->height_wrap.given)
        report_error(r, "--height-%s: is for a relief; add --height-map FILE",
                     s->height_scale.given ? "scale" : "wrap");
    else
        return EXIT_DONE;
    return EXIT_USAGE;
}

int relief_load(const render_settings *s, io_image *map, report *r)
{
    static const char *const usual[] = {"Y", "R"};
    io_image probed = {0};
    const char *name = NULL;
    int result = EXIT_FAILED;
    if (!s->height_map)
        return EXIT_DONE;
    if (io_probe(s->height_map, &probed, &r->logger) != 0)
        return EXIT_FAILED;
    if (probed.channel_count == 1)
        name = probed.channels[0].name;
    for (int i = 0; i < 2 && !name; i++)
        if (io_image_find(&probed, usual[i]))
            name = usual[i];
    if (!name)
        report_error(r,
                     "%s: has several channels, none of them Y or R; write the height as "
                     "one channel",
                     s->height_map);
    else if (reading_picture(s->height_map, &name, 1, map, &r->logger, r) == 0)
        result = EXIT_DONE;
    io_image_free(&probed);
    if (result == EXIT_DONE)
        report_info(r, "%s: height map, %dx%d", s->height_map, map->width, map->height);
    return result;
}

int relief_check_mesh(const render_settings *s, const scene_gbuffer *g, report *r)
{
    size_t count = (size_t)g->desc.width * (size_t)g->desc.height;
    size_t surface = 0, bare = 0;
    if (!s->height_map)
        return EXIT_DONE;
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(g->depth[0][i]))
            continue;
        surface++;
        bare += isnan(g->uv[2 * i]) ? 1 : 0;
    }
    if (surface > 0 && bare == surface) {
        report_error(r,
                     "%s: what is seen of it has no texture coordinates, which "
                     "--height-map needs; unwrap the mesh and write it again",
                     s->view.model);
        return EXIT_FAILED;
    }
    if (bare > 0)
        report_info(r,
                    "%s: %.3g %% of what is seen has no texture coordinates and stays "
                    "flat",
                    s->view.model, 100.0 * (double)bare / (double)surface);
    return EXIT_DONE;
}

int relief_apply(const render_settings *s, const io_image *map, const scene_gbuffer *g,
                 crv_gbuffer *gbuffer, report *r)
{
    int32_t width = g->desc.width, height = g->desc.height;
    if (!s->height_map)
        return EXIT_DONE;
    crv_height_field field = (crv_height_field){
        .uv = crv_const_image_packed(g->uv, width, height, 2),
        .tangent = crv_const_image_packed(g->tangent, width, height, 3),
        .bitangent = crv_const_image_packed(g->bitangent, width, height, 3),
        .height =
            crv_const_image_packed(map->channels[0].data, map->width, map->height, 1),
        .scale = (float)s->height_scale.value,
        .wrap = (crv_wrap)s->height_wrap.value,
    };
    return report_ok(r, crv_gbuffer_set_height_field(gbuffer, &field), "height field")
               ? EXIT_DONE
               : EXIT_FAILED;
}

static double texel(const io_image *map, double column, double row, bool clamp)
{
    double width = map->width, height = map->height;
    column = clamp ? fmin(fmax(column, 0.0), width - 1.0)
                   : column - width * floor(column / width);
    row = clamp ? fmin(fmax(row, 0.0), height - 1.0) : row - height * floor(row / height);
    const float value =
        map->channels[0].data[(size_t)row * (size_t)map->width + (size_t)column];
    return isfinite(value) ? (double)value : 0.0;
}

/* The slopes of the bilinear map by u and v, texel centres at half-integers, as the
 * library sees them. */
static void slopes(const io_image *map, const float uv[2], bool clamp, double *by_u,
                   double *by_v)
{
    double x = (double)uv[0] * map->width - 0.5, y = (double)uv[1] * map->height - 0.5;
    double s = x - floor(x), t = y - floor(y);
    double a = texel(map, floor(x), floor(y), clamp);
    double b = texel(map, floor(x) + 1.0, floor(y), clamp);
    double c = texel(map, floor(x), floor(y) + 1.0, clamp);
    double d = texel(map, floor(x) + 1.0, floor(y) + 1.0, clamp);
    *by_u = ((1.0 - t) * (b - a) + t * (d - c)) * map->width;
    *by_v = ((1.0 - s) * (c - a) + s * (d - b)) * map->height;
}

/* P + h n changes with u by dP/du + h_u n, where n is the mesh's normal. */
static void bend(double by_u, double by_v, const float *tangent, const float *bitangent,
                 float n[3])
{
    double along_u[3], along_v[3], normal[3], length = 0.0, side = 0.0;
    for (int k = 0; k < 3; k++) {
        along_u[k] = (double)tangent[k] + by_u * (double)n[k];
        along_v[k] = (double)bitangent[k] + by_v * (double)n[k];
    }
    view_cross(along_u, along_v, normal);
    for (int k = 0; k < 3; k++) {
        length += normal[k] * normal[k];
        side += normal[k] * (double)n[k];
    }
    if (!(length > 0.0) || !isfinite(length))
        return;
    length = copysign(sqrt(length), side);
    for (int k = 0; k < 3; k++)
        n[k] = (float)(normal[k] / length);
}

void relief_bend_normals(const render_settings *s, const io_image *map, scene_gbuffer *g)
{
    size_t count = (size_t)g->desc.width * (size_t)g->desc.height;
    double scale = s->height_scale.value;
    if (!s->height_map)
        return;
    for (size_t i = 0; i < count; i++) {
        const float *uv = g->uv + 2 * i;
        double by_u, by_v;

        /* Far from the map a float cannot tell texels apart. */
        if (!(fabsf(uv[0]) < 1e6f && fabsf(uv[1]) < 1e6f))
            continue;
        slopes(map, uv, s->height_wrap.value == CRV_WRAP_CLAMP, &by_u, &by_v);
        bend(scale * by_u, scale * by_v, g->tangent + 3 * i, g->bitangent + 3 * i,
             g->normals + 3 * i);
    }
}
