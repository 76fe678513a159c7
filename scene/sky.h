/* SPDX-License-Identifier: MIT */
/*
 * sky.h: what the sky's light amounts to, in the sky's own space (+Y at the zenith).
 */
#ifndef CREVICE_SCENE_SKY_H
#define CREVICE_SCENE_SKY_H

#include "scene.h"
#include "vec.h"

/* What of a non-finite or negative radiance can be used. */
double sky_usable_radiance(float value);

/* Radiance and irradiance of the environment, not below 0. */
vec3 sky_harmonic_radiance(const float environment[9][3], vec3 direction);
vec3 sky_harmonic_irradiance(const float environment[9][3], vec3 normal);

/* The sums of bands 1 and 2 of a sky's spherical harmonics in one direction. */
typedef struct sky_bands {
    vec3 first, second;
} sky_bands;

sky_bands sky_harmonic_bands(const float environment[9][3], vec3 direction);
sky_bands sky_bands_at(const scene_lighting *l, vec3 direction);

/* The share of a gradient's zenith colour in the irradiance of a surface whose normal has
 * this cosine to the zenith; ground has pi (1 - cosine) / 2, the horizon what is left of
 * pi. */
double sky_zenith_share(double cosine);

/* That share at evenly spaced cosines: computing it takes an integral. */
enum { SKY_TABLE_STEPS = 256 };
typedef struct sky_table {
    double zenith_share[SKY_TABLE_STEPS + 1];
} sky_table;

void sky_fill_table(sky_table *table);

/* table: NULL computes what it would hold. */
vec3 sky_irradiance(const scene_lighting *l, const sky_table *table, vec3 normal);
vec3 sky_open_irradiance(const scene_lighting *l, const sky_table *table,
                         vec3 bent_normal, vec3 accessibility);
vec3 sky_radiance(const scene_lighting *l, vec3 direction);

/* The radiance that lights: of the painted sky, not that of its backdrop. */
vec3 sky_lighting_radiance(const scene_lighting *l, vec3 direction);

#endif
