/* SPDX-License-Identifier: MIT */
/* render.h: the settings of render, and the parts of it that have a file of their own. */
#ifndef TOOL_RENDER_H
#define TOOL_RENDER_H

#include "bent.h"
#include "io.h"
#include "common/view.h"

/* What the main picture shows. */
enum { SHADE_AO, SHADE_LIT, SHADE_LIT_NO_AO };

typedef struct render_settings {
    view_settings view;
    arg_int shade;
    const char *lit, *unlit;
    arg_int bits, aa;
    bool half;
    bent_settings bent;
    const char *height_map;
    arg_number height_scale;
    arg_int height_wrap;
    const char *sky, *key_light, *albedo;
    arg_int sky_rays;
    arg_vector zenith;
} render_settings;

/* relief.c: height maps. All do nothing without one. */
extern const arg_table relief_table;

/* Before anything is loaded: whether the method takes one, and so on. */
int relief_check(const render_settings *s, report *r);

/* Reads the map into *map, one channel; the caller frees it. */
int relief_load(const render_settings *s, io_image *map, report *r);

/* Tells of pixels that show a surface without texture coordinates; all of them so is an
 * error. */
int relief_check_mesh(const render_settings *s, const scene_gbuffer *g, report *r);

/* Hands the height field to the library's G-buffer, filled from g before. */
int relief_apply(const render_settings *s, const io_image *map, const scene_gbuffer *g,
                 crv_gbuffer *gbuffer, report *r);

/* Gives g the normals of the relief, for lit pictures. */
void relief_bend_normals(const render_settings *s, const io_image *map, scene_gbuffer *g);

/* lighting.c: sky and key light of the lit pictures. */
extern const arg_table lighting_table;

typedef struct lighting {
    scene_lighting scene;
    float *picture; /* the environment's; owned */
    bool bounces;   /* between surfaces, as --albedo wants it: of this albedo, */
    bool of_mesh;   /* or of that of each surface */
    double albedo[3];
} lighting;

int lighting_check(const render_settings *s, report *r);

/* What the settings say, the sky's picture included. Free it, also after an error. */
int lighting_load(const render_settings *s, lighting *out, report *r);

/* Accessibility of red, green and blue light after all bounces; ao: its first channel is
 * that of the first. The caller frees *out. */
int lighting_bounce(const lighting *l, const scene_gbuffer *g, const io_image *ao,
                    io_image *out, report *r);
void lighting_free(lighting *l);

#endif
