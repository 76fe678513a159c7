/* SPDX-License-Identifier: MIT */
#include "sky.h"

/* Of the painted sky: what lights, and what is seen. */
static const vec3 sky_light = {0.30, 0.36, 0.46};
static const vec3 ground_light = {0.17, 0.15, 0.13};
static const vec3 painted_zenith = {0.22, 0.36, 0.62};
static const vec3 painted_horizon = {0.66, 0.74, 0.84};

scene_lighting scene_lighting_default(void)
{
    /* Sky and ground light add up with the key light to less than 1 on white paper that
     * faces both. The environment is a white one, about as bright. */
    return (scene_lighting){.sky = SCENE_SKY_PAINTED,
                            .constant = {0.35f, 0.35f, 0.35f},
                            .zenith = {0.20f, 0.32f, 0.52f},
                            .horizon = {0.58f, 0.63f, 0.66f},
                            .ground = {0.17f, 0.15f, 0.13f},
                            .environment = {{1.24f, 1.24f, 1.24f}},
                            .key_colour = {0.66f, 0.60f, 0.50f}};
}

static vec3 mix(vec3 a, vec3 b, double t)
{
    return v3_along(a, v3_sub(b, a), t);
}

/* From the horizon to the zenith with the square root of the height. */
static vec3 gradient(vec3 low, vec3 high, double height)
{
    return mix(low, high, sqrt(fmin(fmax(height, 0.0), 1.0)));
}

/* The integral over azimuth of max(0, n.w) at this sine of elevation; cosine is that of
 * the normal to the zenith. */
static double facing_over_azimuth(double cosine, double height)
{
    double across = sqrt(fmax(0.0, 1.0 - cosine * cosine) * (1.0 - height * height));
    double along = cosine * height;
    if (along >= across)
        return 2.0 * SCENE_PI * along;
    if (along <= -across)
        return 0.0;
    const double half = acos(-along / across);
    return 2.0 * (along * half + across * sin(half));
}

double sky_zenith_share(double cosine)
{
    enum { STEPS = 256 };
    double sum = 0.0;
    /* Over height = sin(s)^2, which makes the integrand smooth at both ends. */
    for (int i = 0; i < STEPS; i++) {
        double s = 0.5 * SCENE_PI * (i + 0.5) / STEPS, root = sin(s);
        sum += root * facing_over_azimuth(cosine, root * root) * 2.0 * root * cos(s);
    }
    return sum * 0.5 * SCENE_PI / STEPS;
}

void sky_fill_table(sky_table *table)
{
    for (int i = 0; i <= SKY_TABLE_STEPS; i++)
        table->zenith_share[i] = sky_zenith_share(2.0 * i / SKY_TABLE_STEPS - 1.0);
}

static double table_share(const sky_table *table, double cosine)
{
    double at = 0.5 * (cosine + 1.0) * SKY_TABLE_STEPS;
    int i = at < SKY_TABLE_STEPS - 1 ? (int)at : SKY_TABLE_STEPS - 1;
    const double *share = table->zenith_share + i;
    return share[0] + (share[1] - share[0]) * (at - i);
}

vec3 sky_irradiance(const scene_lighting *l, const sky_table *table, vec3 normal)
{
    double cosine = fmin(fmax(normal.y, -1.0), 1.0);
    double ground = 0.5 * SCENE_PI * (1.0 - cosine), zenith;
    vec3 sum;
    switch (l->sky) {
    case SCENE_SKY_CONSTANT:
        return v3_scale(v3_from(l->constant), SCENE_PI);
    case SCENE_SKY_GRADIENT:
        zenith = table ? table_share(table, cosine) : sky_zenith_share(cosine);
        sum = v3_scale(v3_from(l->ground), ground);
        sum = v3_along(sum, v3_from(l->zenith), zenith);
        return v3_along(sum, v3_from(l->horizon), SCENE_PI - ground - zenith);
    case SCENE_SKY_ENVIRONMENT:
        return sky_harmonic_irradiance(l->environment, normal);
    case SCENE_SKY_PAINTED:
    default:
        return v3_scale(mix(ground_light, sky_light, 0.5 + 0.5 * cosine), SCENE_PI);
    }
}

/* Of a sky that is the same all around the zenith band l is P_l(cosine) times
 * (2 l + 1)/2 Int L P_l. */
sky_bands sky_bands_at(const scene_lighting *l, vec3 direction)
{
    const double cosine = fmin(fmax(direction.y, -1.0), 1.0);
    sky_bands bands = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    switch (l->sky) {
    case SCENE_SKY_CONSTANT:
        return bands;
    case SCENE_SKY_GRADIENT:
        /* 3/2 (-g/2 + h/2 + 2/5 (z - h)) and 5/2 (2/21) (z - h). */
        bands.first = v3_scale(v3_from(l->ground), -0.75 * cosine);
        bands.first = v3_along(bands.first, v3_from(l->horizon), 0.15 * cosine);
        bands.first = v3_along(bands.first, v3_from(l->zenith), 0.6 * cosine);
        bands.second = v3_scale(v3_sub(v3_from(l->zenith), v3_from(l->horizon)),
                                5.0 / 21.0 * (1.5 * cosine * cosine - 0.5));
        return bands;
    case SCENE_SKY_ENVIRONMENT:
        return sky_harmonic_bands(l->environment, direction);
    case SCENE_SKY_PAINTED:
    default:
        /* What lights is linear in the normal's cosine, of which 2/3 is kept. */
        bands.first = v3_scale(v3_sub(sky_light, ground_light), 0.75 * cosine);
        return bands;
    }
}

static vec3 texel(const scene_lighting *l, int64_t column, int64_t row)
{
    int64_t x = (column + l->picture_width) % l->picture_width;
    int64_t y = row < 0 ? 0 : row < l->picture_height ? row : l->picture_height - 1;
    const float *p = l->picture + 3 * ((size_t)y * (size_t)l->picture_width + (size_t)x);
    return v3(sky_usable_radiance(p[0]), sky_usable_radiance(p[1]),
              sky_usable_radiance(p[2]));
}

static vec3 picture_radiance(const scene_lighting *l, vec3 d)
{
    double azimuth = atan2(d.x, -d.z), polar = acos(fmin(fmax(d.y, -1.0), 1.0));
    double x = (0.5 + 0.5 * azimuth / SCENE_PI) * l->picture_width - 0.5;
    double y = polar / SCENE_PI * l->picture_height - 0.5;
    int64_t column = (int64_t)floor(x), row = (int64_t)floor(y);
    vec3 above = mix(texel(l, column, row), texel(l, column + 1, row), x - floor(x));
    vec3 below =
        mix(texel(l, column, row + 1), texel(l, column + 1, row + 1), x - floor(x));
    return mix(above, below, y - floor(y));
}

vec3 sky_radiance(const scene_lighting *l, vec3 direction)
{
    switch (l->sky) {
    case SCENE_SKY_CONSTANT:
        return v3_from(l->constant);
    case SCENE_SKY_GRADIENT:
        if (direction.y < 0.0)
            return v3_from(l->ground);
        return gradient(v3_from(l->horizon), v3_from(l->zenith), direction.y);
    case SCENE_SKY_ENVIRONMENT:
        if (l->picture && l->picture_width > 0 && l->picture_height > 0)
            return picture_radiance(l, direction);
        return sky_harmonic_radiance(l->environment, direction);
    case SCENE_SKY_PAINTED:
    default:
        return gradient(painted_horizon, painted_zenith, direction.y);
    }
}

/* The painted sky's irradiance is pi times the mix at half the cosine; band 1 of radiance
 * counts 2/3 in it. */
vec3 sky_lighting_radiance(const scene_lighting *l, vec3 direction)
{
    if (l->sky == SCENE_SKY_PAINTED)
        return mix(ground_light, sky_light, 0.5 + 0.75 * direction.y);
    return sky_radiance(l, direction);
}

void scene_sky_irradiance(const scene_lighting *lighting, const float normal[3],
                          float rgb[3])
{
    v3_store(sky_irradiance(lighting, NULL, v3_from(normal)), rgb);
}

void scene_sky_radiance(const scene_lighting *lighting, const float direction[3],
                        float rgb[3])
{
    v3_store(sky_radiance(lighting, v3_from(direction)), rgb);
}
