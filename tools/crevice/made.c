/* SPDX-License-Identifier: MIT */
#include "made.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "append.h"
#include "frame_copy.h"

static void append(char made[IO_MADE_SIZE], const char *format, ...) REPORT_PRINTF;

static void append(char made[IO_MADE_SIZE], const char *format, ...)
{
    const size_t used = strlen(made);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(made + used, IO_MADE_SIZE - used, format, arguments);
    va_end(arguments);
}

static void append_number(char made[IO_MADE_SIZE], const char *name, const arg_number *n)
{
    if (n->given)
        append(made, " %s=%.9g", name, n->value);
}

void made_describe(const ao_settings *s, const crv_options *o, float vfov_rad,
                   uint64_t cameras, char made[IO_MADE_SIZE])
{
    made[0] = '\0';
    append(made, "crevice %s ao: method=%s filter=%s", crv_version(), o->method->name,
           o->filter ? o->filter->name : "none");
    for (int32_t i = 0; i < crv_option_count(); i++) {
        const crv_option *option = crv_option_at(i);
        if (strcmp(option->key, "radius") != 0
            && crv_option_applies(option, o->method, o->filter))
            append(made, " %s=%.9g", option->key, crv_options_get(o, option));
    }
    append(made, " depth=%s normal=%s space=%d flip=%s",
           s->passes.depth ? s->passes.depth : "",
           s->passes.normal ? s->passes.normal : "", (int)s->passes.normal_space.value,
           s->passes.normal_flip ? s->passes.normal_flip : "");
    if (s->passes.depth_encoding.given)
        append(made, " encoding=%d", (int)s->passes.depth_encoding.value);
    if (s->layer_kind.given)
        append(made, " layers=%d", (int)s->layer_kind.value);
    append_number(made, "near", &s->passes.z_near);
    append_number(made, "far", &s->passes.z_far);
    append_number(made, "background", &s->passes.background);
    append_number(made, "vfov", &s->camera.vfov_deg);
    if (s->camera.vfov_deg.given && isnan(s->camera.vfov_deg.value))
        append(made, ",%.9g", (double)vfov_rad);
    append_number(made, "hfov", &s->camera.hfov_deg);
    append_number(made, "lens", &s->camera.lens_mm);
    append_number(made, "sensor", &s->camera.sensor_mm);
    append_number(made, "ortho", &s->camera.ortho);
    if (s->camera.file)
        append(made, " camera=%016" PRIx64 ",%d", cameras, (int)s->camera.order.value);
    append(made, " exact=%d half=%d bits=%d crop=%d", s->common.exact, s->half,
           s->bits.value == 0 ? 8 : 16, s->crop);
    if (s->aa.value > 1)
        append(made, " aa=%d", (int)s->aa.value);
    if (s->views)
        append(made, " views=%s", s->views);
    if (s->receive)
        append(made, " receive=%s", s->receive);
    if (s->occlude)
        append(made, " occlude=%s", s->occlude);
    if (s->bent.space.given)
        append(made, " bent-space=%d", (int)s->bent.space.value);
    if (s->bent_channel)
        append(made, " bent-channel=%s", s->bent_channel);
    if (append_is_wanted(s))
        append(made, " append=%d channel=%s apply=%s tint=%.9g,%.9g,%.9g", s->append,
               append_channel(s), s->apply ? s->apply : "", s->tint.value[0],
               s->tint.value[1], s->tint.value[2]);
    if (s->albedo)
        append(made, " albedo=%s", s->albedo);
}

/* It stands last. */
void made_add_state(char made[IO_MADE_SIZE], const made_state *state)
{
    append(made, " radius=%.9g reading=%d encoding=%d",
           state->has_radius ? (double)state->radius : 0.0, state->reading,
           (int)state->encoding);
    if (state->bent_space)
        append(made, " bent=%s", state->bent_space);
}

/* Reads the value behind " NAME=" and goes on behind it. */
static bool read_value(const char **at, const char *name, double *value)
{
    char word[64];
    const size_t length = strlen(name);
    if (strncmp(*at, name, length) != 0)
        return false;
    *at += length;
    const size_t digits = strcspn(*at, " ");
    if (digits >= sizeof word)
        return false;
    memcpy(word, *at, digits);
    word[digits] = '\0';
    *at += digits;
    return args_number(word, value);
}

bool made_matches(const char *settings, const char *made, made_state *state)
{
    const size_t length = strlen(settings);
    double radius, reading, encoding;
    if (strncmp(made, settings, length) != 0)
        return false;
    made += length;
    if (!read_value(&made, " radius=", &radius)
        || !read_value(&made, " reading=", &reading)
        || !read_value(&made, " encoding=", &encoding)
        || (*made != '\0' && strncmp(made, " bent=", 6) != 0)
        || !(radius >= 0.0 && radius <= 1e30 && reading >= 0.0 && reading <= 1e6
             && encoding >= 0.0 && encoding <= 100.0))
        return false;
    *state = (made_state){.has_radius = radius > 0.0,
                          .radius = (float)radius,
                          .reading = (int)reading,
                          .encoding = (crv_depth_encoding)(int)encoding};
    return true;
}

void made_glance(const char *output, const char *channel, char made[IO_MADE_SIZE])
{
    io_image image = {0};
    made[0] = '\0';
    if (channel) {
        io_append_made(output, channel, made);
        return;
    }
    if (io_probe(output, &image, NULL) == 0)
        snprintf(made, IO_MADE_SIZE, "%s", image.made);
    io_image_free(&image);
}

bool made_read(const char *output, const char *channel, char made[IO_MADE_SIZE])
{
    io_image image = {0};
    made_glance(output, channel, made);
    if (channel)
        return made[0] != '\0';
    const bool whole = io_read(output, NULL, 0, &image, NULL) == 0;
    io_image_free(&image);
    return whole;
}
