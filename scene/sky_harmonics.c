/* SPDX-License-Identifier: MIT */
/*
 * Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps"
 * (2001): nine real spherical harmonics of the radiance give the irradiance of every
 * normal to about 1 %.
 */
#include <stdlib.h>
#include <string.h>

#include "internal.h"
#include "sky.h"

enum { HARMONICS = 9 };

/* Infinite radiance is what half floats make of a sun: their largest number. */
#define INFINITE_RADIANCE 65504.0
/* Keeps sums finite as floats. */
#define MAX_RADIANCE 1e30

/* Factors of 1; y, z, x; xy, yz, 3z^2 - 1, xz, x^2 - y^2. */
static void get_factors(double factor[HARMONICS])
{
    const double first = sqrt(3.0 / (4.0 * SCENE_PI)), second = sqrt(15.0 / SCENE_PI) / 2;
    factor[0] = sqrt(1.0 / (4.0 * SCENE_PI));
    factor[1] = factor[2] = factor[3] = first;
    factor[4] = factor[5] = factor[7] = second;
    factor[6] = sqrt(5.0 / SCENE_PI) / 4.0;
    factor[8] = second / 2.0;
}

/* The sum over the harmonics, each band times its weight. */
static vec3 sum_of_bands(const float environment[9][3], const double band[3], vec3 d)
{
    const double polynomial[HARMONICS] = {1.0,
                                          d.y,
                                          d.z,
                                          d.x,
                                          d.x * d.y,
                                          d.y * d.z,
                                          3.0 * d.z * d.z - 1.0,
                                          d.x * d.z,
                                          d.x * d.x - d.y * d.y};
    double factor[HARMONICS];
    vec3 sum = v3(0.0, 0.0, 0.0);
    get_factors(factor);
    for (int i = 0; i < HARMONICS; i++)
        sum = v3_along(sum, v3_from(environment[i]),
                       band[i == 0  ? 0
                            : i < 4 ? 1
                                    : 2]
                           * factor[i] * polynomial[i]);
    return sum;
}

static vec3 not_below_0(vec3 v)
{
    return v3(fmax(v.x, 0.0), fmax(v.y, 0.0), fmax(v.z, 0.0));
}

vec3 sky_harmonic_radiance(const float environment[9][3], vec3 direction)
{
    const double band[3] = {1.0, 1.0, 1.0};
    return not_below_0(sum_of_bands(environment, band, direction));
}

/* The clamped cosine's own harmonics: eq. 8 of the paper. */
vec3 sky_harmonic_irradiance(const float environment[9][3], vec3 normal)
{
    const double band[3] = {SCENE_PI, 2.0 * SCENE_PI / 3.0, SCENE_PI / 4.0};
    return not_below_0(sum_of_bands(environment, band, normal));
}

sky_bands sky_harmonic_bands(const float environment[9][3], vec3 direction)
{
    return (sky_bands){
        .first = sum_of_bands(environment, (const double[3]){0.0, 1.0, 0.0}, direction),
        .second = sum_of_bands(environment, (const double[3]){0.0, 0.0, 1.0}, direction)};
}

double sky_usable_radiance(float value)
{
    if (!(value > 0.0f))
        return 0.0;
    return isfinite(value) ? fmin((double)value, MAX_RADIANCE) : INFINITE_RADIANCE;
}

/* Integrals over one column's azimuths of 1, sin, cos, sin^2, cos^2 and sin cos, in which
 * a row's share of every harmonic is expressed. With them the projection of a picture of
 * constant pixels is exact. */
enum { AZIMUTHS = 6 };
static void integrate_azimuth(double a, double b, double out[AZIMUTHS])
{
    double doubled = (sin(2.0 * b) - sin(2.0 * a)) / 4.0;
    out[0] = b - a;
    out[1] = cos(a) - cos(b);
    out[2] = sin(b) - sin(a);
    out[3] = (b - a) / 2.0 - doubled;
    out[4] = (b - a) / 2.0 + doubled;
    out[5] = (sin(b) * sin(b) - sin(a) * sin(a)) / 2.0;
}

/* Adds a row's harmonics, the polynomials only, from its sums over azimuth. The row's
 * directions are (sin t sin p, cos t, -sin t cos p), their solid angle sin t dt dp. */
static void add_row(double a, double b, const double sums[AZIMUTHS][3],
                    double out[HARMONICS][3])
{
    double sa = sin(a), sb = sin(b), ca = cos(a), cb = cos(b);
    /* Integrals of sin; sin cos, sin^2; sin cos^2, sin^2 cos, sin^3. */
    double s = ca - cb, sc = (sb * sb - sa * sa) / 2.0;
    double ss = (b - a) / 2.0 - (sb * cb - sa * ca) / 2.0;
    double scc = (ca * ca * ca - cb * cb * cb) / 3.0;
    double ssc = (sb * sb * sb - sa * sa * sa) / 3.0, sss = s - scc;
    for (int c = 0; c < 3; c++) {
        out[0][c] += s * sums[0][c];
        out[1][c] += sc * sums[0][c];
        out[2][c] -= ss * sums[2][c];
        out[3][c] += ss * sums[1][c];
        out[4][c] += ssc * sums[1][c];
        out[5][c] -= ssc * sums[2][c];
        out[6][c] += 3.0 * sss * sums[4][c] - s * sums[0][c];
        out[7][c] -= sss * sums[5][c];
        out[8][c] += sss * sums[3][c] - scc * sums[0][c];
    }
}

/* Returns how many values had to be replaced. */
static size_t sum_row(const float *row, const double (*weights)[AZIMUTHS], int32_t width,
                      double sums[AZIMUTHS][3])
{
    size_t odd = 0;
    memset(sums, 0, AZIMUTHS * sizeof *sums);
    for (int32_t x = 0; x < width; x++) {
        for (int c = 0; c < 3; c++) {
            float value = row[3 * (size_t)x + (size_t)c];
            odd += !(value >= 0.0f && isfinite(value));
            for (int i = 0; i < AZIMUTHS; i++)
                sums[i][c] += weights[x][i] * sky_usable_radiance(value);
        }
    }
    return odd;
}

/* False: out of memory. */
static bool project(const float *rgb, int32_t width, int32_t height,
                    double total[HARMONICS][3], size_t *odd)
{
    double(*weights)[AZIMUTHS] = malloc((size_t)width * sizeof *weights);
    if (!weights)
        return false;
    for (int32_t x = 0; x < width; x++)
        integrate_azimuth(2.0 * SCENE_PI * x / width - SCENE_PI,
                          2.0 * SCENE_PI * (x + 1) / width - SCENE_PI, weights[x]);
    for (int32_t y = 0; y < height; y++) {
        double sums[AZIMUTHS][3];
        *odd += sum_row(rgb + 3 * (size_t)y * (size_t)width,
                        (const double(*)[AZIMUTHS])weights, width, sums);
        add_row(SCENE_PI * y / height, SCENE_PI * (y + 1) / height,
                (const double(*)[3])sums, total);
    }
    free(weights);
    return true;
}

int scene_sky_from_equirect(const float *rgb, int32_t width, int32_t height,
                            const char *name, scene_lighting *lighting,
                            const crv_logger *log)
{
    double total[HARMONICS][3] = {{0.0}}, factor[HARMONICS];
    size_t odd = 0;
    if (!rgb || width < 1 || height < 1 || width > CRV_MAX_SIZE
        || height > CRV_MAX_SIZE) {
        scene_log(log, CRV_LOG_ERROR, name,
                  "is no picture of a sky; give one of 1 to %d pixels a side",
                  CRV_MAX_SIZE);
        return -1;
    }
    if (!project(rgb, width, height, total, &odd)) {
        scene_log(log, CRV_LOG_ERROR, name, "out of memory; close other programs");
        return -1;
    }
    get_factors(factor);
    for (int i = 0; i < HARMONICS; i++)
        for (int c = 0; c < 3; c++)
            lighting->environment[i][c] = (float)(factor[i] * total[i][c]);
    lighting->sky = SCENE_SKY_ENVIRONMENT;
    lighting->picture = rgb;
    lighting->picture_width = width;
    lighting->picture_height = height;
    if (odd > 0)
        scene_log(log, CRV_LOG_WARNING, name,
                  "%zu values are negative, infinite or not numbers and were replaced; "
                  "export the picture again if the light looks wrong",
                  odd);
    return 0;
}
