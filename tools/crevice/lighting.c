/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference.h"
#include "render.h"
#include "common/multi_bounce.h"
#include "common/nearest.h"
#include "common/reading.h"

static const double degree = 3.14159265358979323846 / 180.0;

static const arg lighting_rows[] = {
    {.name = "--sky",
     .value = "SKY",
     .computed = "painted",
     ARG_INTO(ARG_TEXT, render_settings, sky),
     .help = "the light that accessibility darkens: painted, constant[:R,G,B], gradient, "
             "or FILE.exr, an equirectangular picture (linear R, G, B; zenith on top, -Z "
             "in the centre, +X to the right of it)"},
    {.name = "--key-light",
     .value = "AZ,EL[,S]",
     .computed = "over the viewer's left shoulder",
     ARG_INTO(ARG_TEXT, render_settings, key_light),
     .help = "the light that accessibility does not darken: azimuth (0 is -Z, 90 is +X) "
             "and elevation in degrees, strength (1 is the default's); or none"},
    {.name = "--zenith",
     .value = "X,Y,Z",
     .computed = "--up, else 0,1,0",
     ARG_INTO(ARG_VECTOR, render_settings, zenith),
     .help =
         "the direction from which the sky's top shines; it turns the key light, too"},
    {.name = "--albedo",
     .value = "ALBEDO",
     ARG_INTO(ARG_TEXT, render_settings, albedo),
     .help = "accessibility with the light that surfaces pass on to each other: their "
             "albedo RHO or R,G,B, 0 to 1, or mesh for that of each surface"},
    {.name = "--sky-rays",
     .value = "N",
     ARG_RANGE(0, REFERENCE_MAX_RAYS),
     .initial = "0",
     ARG_INTO(ARG_INT, render_settings, sky_rays),
     .help = "sky light by N rays a pixel, as far as the radius, instead of ambient "
             "occlusion: what the lit picture should be; 256 to compare with. 0: none"},
};
const arg_table lighting_table = ARG_TABLE("Light of the lit pictures", lighting_rows);

static int set_key_light(const char *text, scene_lighting *l, report *r)
{
    double value[3] = {0.0, 0.0, 1.0};
    if (strcmp(text, "none") == 0) {
        memset(l->key_colour, 0, sizeof l->key_colour);
        return EXIT_DONE;
    }
    const int count = args_numbers(text, value, 3);
    if (count < 2 || fabs(value[0]) > 360.0 || fabs(value[1]) > 90.0 || value[2] < 0.0
        || value[2] > 1e6) {
        report_error(r,
                     "--key-light: \"%s\" is not valid; give AZ,EL or AZ,EL,STRENGTH "
                     "(-360 to 360 and -90 to 90 degrees, 0 to 1e6), or none",
                     text);
        return EXIT_USAGE;
    }
    const double azimuth = value[0] * degree;
    const double elevation = value[1] * degree;
    l->key_direction[0] = (float)(cos(elevation) * sin(azimuth));
    l->key_direction[1] = (float)sin(elevation);
    l->key_direction[2] = (float)(-cos(elevation) * cos(azimuth));
    for (int i = 0; i < 3; i++)
        l->key_colour[i] *= (float)value[2];
    return EXIT_DONE;
}

static int set_constant(const char *text, scene_lighting *l, report *r)
{
    double value[3];
    l->sky = SCENE_SKY_CONSTANT;
    if (text[0] == '\0')
        return EXIT_DONE;
    if (text[0] != ':' || args_numbers(text + 1, value, 3) != 3
        || !(fmin(value[0], fmin(value[1], value[2])) >= 0.0)
        || !(fmax(value[0], fmax(value[1], value[2])) <= 1e6)) {
        report_error(r,
                     "--sky: \"constant%s\" is not valid; give constant, or "
                     "constant:R,G,B with 0 to 1e6 each",
                     text);
        return EXIT_USAGE;
    }
    for (int i = 0; i < 3; i++)
        l->constant[i] = (float)value[i];
    return EXIT_DONE;
}

static int load_picture(const char *path, lighting *l, report *r)
{
    static const char *const names[] = {"R", "G", "B"};
    io_image image = {0};
    int result = EXIT_FAILED;
    if (reading_picture(path, names, 3, &image, &r->logger, r) != 0)
        return EXIT_FAILED;
    const size_t count = (size_t)image.width * (size_t)image.height;
    l->picture = malloc(count * 3 * sizeof *l->picture);
    if (!l->picture) {
        report_no_memory(r);
    } else {
        for (size_t i = 0; i < count; i++)
            for (size_t c = 0; c < 3; c++)
                l->picture[3 * i + c] = image.channels[c].data[i];
        if (scene_sky_from_equirect(l->picture, image.width, image.height, path,
                                    &l->scene, &r->logger)
            == 0)
            result = EXIT_DONE;
    }
    io_image_free(&image);
    return result;
}

/* A PNG's colours are encoded for a display; taken for light they would be wrong. */
static bool is_picture(const char *text)
{
    size_t length = strlen(text);
    return length > 4
           && (strcmp(text + length - 4, ".exr") == 0
               || strcmp(text + length - 4, ".pfm") == 0);
}

static int set_albedo(const char *text, lighting *l, report *r)
{
    l->bounces = true;
    l->of_mesh = strcmp(text, "mesh") == 0;
    if (l->of_mesh
        || (multi_bounce_parse(text, l->albedo) && multi_bounce_is_albedo(l->albedo)))
        return EXIT_DONE;
    report_error(
        r, "--albedo: \"%s\" is none; give RHO or R,G,B with 0 to 1 each, or mesh", text);
    return EXIT_USAGE;
}

static int set_sky(const char *text, lighting *l, report *r)
{
    static const char *const kinds[] = {"painted", "constant", "gradient", NULL};
    if (strncmp(text, "constant", 8) == 0 && (text[8] == '\0' || text[8] == ':'))
        return set_constant(text + 8, &l->scene, r);
    if (strcmp(text, "gradient") == 0 || strcmp(text, "painted") == 0) {
        l->scene.sky = text[0] == 'g' ? SCENE_SKY_GRADIENT : SCENE_SKY_PAINTED;
        return EXIT_DONE;
    }
    if (is_picture(text))
        return load_picture(text, l, r);
    const char *nearest = nearest_name(text, kinds, -1);
    if (nearest)
        report_error(r, "--sky: no sky \"%s\"; did you mean %s?", text, nearest);
    else
        report_error(r,
                     "--sky: \"%s\" is none; give painted, constant, constant:R,G,B, "
                     "gradient, or an .exr file",
                     text);
    return EXIT_USAGE;
}

/* The zenith, and the key light turned as scene.h has it for the sky: the shortest turn
 * that takes +Y to up. With p = Y x up, v turns to v + p x v + p x (p x v) / (1 + up.y).
 */
static void turn(scene_lighting *l, const double up[3])
{
    double length = sqrt(up[0] * up[0] + up[1] * up[1] + up[2] * up[2]);
    double p[3] = {up[2] / length, 0.0, -up[0] / length};
    double cosine = up[1] / length;
    double v[3], once[3], twice[3];
    for (int i = 0; i < 3; i++)
        l->sky_up[i] = (float)((double)up[i] / length);
    for (int i = 0; i < 3; i++)
        v[i] = (double)l->key_direction[i];
    view_cross(p, v, once);
    view_cross(p, once, twice);
    for (int i = 0; i < 3; i++) {
        if (cosine > -1.0 + 1e-9)
            v[i] += once[i] + twice[i] / (1.0 + cosine);
        else if (i > 0) /* upside down: half a turn about X */
            v[i] = -v[i];
        l->key_direction[i] = (float)v[i];
    }
}

int lighting_check(const render_settings *s, report *r)
{
    const double *zenith = s->zenith.value;
    const char *given = s->sky            ? "--sky"
                        : s->key_light    ? "--key-light"
                        : s->zenith.given ? "--zenith"
                        : s->albedo       ? "--albedo"
                                          : NULL;
    if (given && s->shade.value == SHADE_AO && !s->lit && !s->unlit) {
        report_error(r, "%s: lights no picture; add --lit FILE or --shade lit", given);
        return EXIT_USAGE;
    }
    if (s->albedo && s->shade.value != SHADE_LIT && !s->lit) {
        report_error(r, "--albedo: is for ambient occlusion; add --lit FILE or --shade "
                        "lit");
        return EXIT_USAGE;
    }
    if (s->sky_rays.value > 0 && s->shade.value != SHADE_LIT && !s->lit) {
        report_error(r, "--sky-rays: is for the lit picture; add --lit FILE or --shade "
                        "lit");
        return EXIT_USAGE;
    }
    if (s->sky_rays.value > 0 && s->albedo) {
        report_error(r, "--sky-rays: traces no light between surfaces; leave out "
                        "--albedo");
        return EXIT_USAGE;
    }
    if (s->zenith.given && !(fabs(zenith[0]) + fabs(zenith[1]) + fabs(zenith[2]) > 0.0)) {
        report_error(r, "--zenith: has no length; give a direction such as 0,1,0");
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}

int lighting_load(const render_settings *s, lighting *out, report *r)
{
    static const double usual[3] = {0.0, 1.0, 0.0};
    int result = EXIT_DONE;
    *out = (lighting){.scene = scene_lighting_default()};
    if (s->key_light)
        result = set_key_light(s->key_light, &out->scene, r);
    turn(&out->scene, s->zenith.given    ? s->zenith.value
                      : s->view.up.given ? s->view.up.value
                                         : usual);
    if (result == EXIT_DONE && s->albedo)
        result = set_albedo(s->albedo, out, r);
    if (result == EXIT_DONE && s->sky)
        result = set_sky(s->sky, out, r);
    return result;
}

int lighting_bounce(const lighting *l, const scene_gbuffer *g, const io_image *ao,
                    io_image *out, report *r)
{
    static const char *const colours[] = {"R", "G", "B"};
    const size_t count = (size_t)ao->width * (size_t)ao->height;
    if (io_image_init(out, ao->width, ao->height, colours, 3, &r->logger) != 0)
        return EXIT_FAILED;
    for (int32_t y = 0; y < ao->height; y++)
        for (int32_t x = 0; x < ao->width; x++) {
            const size_t pixel = (size_t)(y + g->desc.guard_top) * (size_t)g->desc.width
                                 + (size_t)(x + g->desc.guard_left);
            for (size_t c = 0; c < 3; c++)
                out->channels[c].data[(size_t)y * (size_t)ao->width + (size_t)x] =
                    l->of_mesh ? g->albedo[3 * pixel + c] : (float)l->albedo[c];
        }
    for (int c = 0; c < 3; c++)
        multi_bounce_plane(ao->channels[0].data, out->channels[c].data, count,
                           out->channels[c].data);
    return EXIT_DONE;
}

void lighting_free(lighting *l)
{
    free(l->picture);
    *l = (lighting){0};
}
