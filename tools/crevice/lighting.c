/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render.h"
#include "common/nearest.h"

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
};
const arg_table lighting_table = ARG_TABLE("Light of the lit pictures", lighting_rows);

/* "1,2,3" to at most max numbers in [low, high]: how many there are, or -1. */
static int numbers(const char *text, double *out, int max)
{
    char copy[128];
    char *part = copy;
    int count = 0;
    if (strlen(text) >= sizeof copy)
        return -1;
    memcpy(copy, text, strlen(text) + 1);
    while (part) {
        char *comma = strchr(part, ',');

        if (comma)
            *comma = '\0';
        if (count == max || !args_number(part, &out[count]) || !isfinite(out[count]))
            return -1;
        count++;
        part = comma ? comma + 1 : NULL;
    }
    return count;
}

static int set_key_light(const char *text, scene_lighting *l, report *r)
{
    double value[3] = {0.0, 0.0, 1.0};
    if (strcmp(text, "none") == 0) {
        memset(l->key_colour, 0, sizeof l->key_colour);
        return EXIT_DONE;
    }
    const int count = numbers(text, value, 3);
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
    if (text[0] != ':' || numbers(text + 1, value, 3) != 3
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
    if (io_read(path, names, 3, &image, &r->logger) != 0)
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
                                          : NULL;
    if (given && s->shade.value == SHADE_AO && !s->lit && !s->unlit) {
        report_error(r, "%s: lights no picture; add --lit FILE or --shade lit", given);
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
    if (result == EXIT_DONE && s->sky)
        result = set_sky(s->sky, out, r);
    return result;
}

void lighting_free(lighting *l)
{
    free(l->picture);
    *l = (lighting){0};
}
