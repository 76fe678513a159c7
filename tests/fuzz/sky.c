/* SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include <math.h>
#include <string.h>

#include "render.h"

static void check_light(const scene_lighting *l)
{
    const float up[3] = {0.0f, 1.0f, 0.0f};
    float rgb[3];
    scene_sky_irradiance(l, up, rgb);
    for (int c = 0; c < 3; c++)
        FUZZ_CHECK(isfinite(rgb[c]) && rgb[c] >= 0.0f, "irradiance %g", (double)rgb[c]);
    scene_sky_radiance(l, up, rgb);
    for (int c = 0; c < 3; c++) {
        FUZZ_CHECK(isfinite(rgb[c]), "radiance %g", (double)rgb[c]);
        FUZZ_CHECK(isfinite(l->key_colour[c]) && isfinite(l->key_direction[c]),
                   "the key light");
    }
}

static void light(render_settings *s, report *r)
{
    lighting l = {0};
    const int before = fuzz_errors;
    int result = lighting_check(s, r);
    if (result == EXIT_DONE)
        result = lighting_load(s, &l, r);
    const int errors = r->errors + fuzz_errors - before;
    FUZZ_CHECK(errors == (result != EXIT_DONE), "%d lines", errors);
    if (result == EXIT_DONE)
        check_light(&l.scene);
    lighting_free(&l);
}

/* Two lines, at most 200 letters each. A file's name would be opened. */
static void light_by_words(render_settings *s, const uint8_t *data, size_t size,
                           report *r)
{
    char text[402];
    if (size >= sizeof text)
        return;
    memcpy(text, data, size);
    text[size] = '\0';
    char *end = strchr(text, '\n');
    if (end)
        *end = '\0';
    s->sky = text[0] && !strchr(text, '.') ? text : NULL;
    s->key_light = end && end[1] ? end + 1 : NULL;
    light(s, r);
}

static void light_by_picture(render_settings *s, const uint8_t *data, size_t size,
                             report *r)
{
    io_image map = {0};
    s->sky = fuzz_file("input.exr", data, size);
    light(s, r);
    s->height_map = s->sky;
    s->height_scale = (arg_number){.given = true, .value = 0.1};
    if (relief_load(s, &map, r) == EXIT_DONE)
        FUZZ_CHECK(map.channel_count == 1, "%d channels", map.channel_count);
    io_image_free(&map);
}

void fuzz_sky(const uint8_t *data, size_t size)
{
    report r;
    if (size < 2)
        return;
    report_init(&r);
    r.logger = fuzz_logger;
    r.quiet = true;
    render_settings s = {.lit = "lit.png", .shade = {.value = SHADE_LIT}};
    if (data[0] == 'w')
        light_by_words(&s, data + 1, size - 1, &r);
    else
        light_by_picture(&s, data + 1, size - 1, &r);
}
