/* SPDX-License-Identifier: MIT */
/*
 * The sky's light on a surface that is open to a part of it.
 *
 * The opening lets in E = Int V L max(0, n.w) dw. Of V (n.w) / pi the accessibility A is
 * the integral, and the bent normal b the direction of the mean m = Int V w (n.w) / pi.
 * Taken as a lobe around b, it weighs each band of the sky's spherical harmonics, whose
 * sum at b is L_l(b):
 *
 *     E = pi A Sum h_l L_l(b),   h_l = Int V P_l(b.w) (n.w) dw / (pi A)              (1)
 *
 * If all is open, these are the clamped cosine's: h_0 = 1, h_1 = 2/3, h_2 = 1/4,
 * and E is the irradiance of the normal. The less is open, the narrower is the lobe. h is
 * that beside a wall: directions are open from the tangent t up to the angle psi towards
 * n. With Q = Int V w w (n.w) dw / pi and b = m/|m|,
 *
 *     A    = (1 - cos psi)/2
 *     m    = 2/(3 pi) (t sin^2 psi + n (psi - sin psi cos psi))                   (2)
 *     Q_tt = (1 - cos^3)/8,   Q_tn = sin^3/8,   Q_nn = (2 - 3 cos + cos^3)/8
 *     h_1  = |m|/A,   h_2 = (3 b.Q b/A - 1)/2
 *
 * As functions of A these are, within 0.0015,
 *
 *     h_1 = 2/3 + x (0.583 - 0.653 sqrt(x) + 0.253 x)
 *     h_2 = 1/4 + x (0.816 - 0.636 sqrt(x) + 0.195 x),   x = 1 - A                (3)
 *
 * Bands above 2 keep the clamped cosine's weight around b.
 */
#include "sky.h"

/* One colour's h_1 and h_2, less those of the whole hemisphere. */
typedef struct narrowing {
    double first, second;
} narrowing;

static narrowing narrowing_of(double accessibility)
{
    const double x = 1.0 - fmin(fmax(accessibility, 0.0), 1.0), root = sqrt(x);
    return (narrowing){x * (0.583 - 0.653 * root + 0.253 * x),
                       x * (0.816 - 0.636 * root + 0.195 * x)};
}

/* Eq. 1 of one colour; the irradiance is that of the whole hemisphere around b. */
static double through(double accessibility, double irradiance, double first,
                      double second)
{
    const narrowing h = narrowing_of(accessibility);
    const double more = SCENE_PI * (h.first * first + h.second * second);
    return accessibility * fmax(irradiance + more, 0.0);
}

vec3 sky_open_irradiance(const scene_lighting *l, const sky_table *table,
                         vec3 bent_normal, vec3 accessibility)
{
    const vec3 A = accessibility, whole = sky_irradiance(l, table, bent_normal);
    const sky_bands L = sky_bands_at(l, bent_normal);
    return v3(through(A.x, whole.x, L.first.x, L.second.x),
              through(A.y, whole.y, L.first.y, L.second.y),
              through(A.z, whole.z, L.first.z, L.second.z));
}

void scene_sky_open_irradiance(const scene_lighting *lighting, const float bent_normal[3],
                               const float accessibility[3], float rgb[3])
{
    v3_store(
        sky_open_irradiance(lighting, NULL, v3_from(bent_normal), v3_from(accessibility)),
        rgb);
}
