/* SPDX-License-Identifier: MIT */
#include "shapes.h"

#define PRESSURE_ANGLE_RAD (20.0 * SCENE_PI / 180.0)
/* Teeth are cut a little thinner than half the pitch, so that they mesh without
 * touching. */
#define BACKLASH       0.04
#define MAX_TEETH      64
#define FLANK_POINTS   4
#define POINTS_A_TOOTH (2 * FLANK_POINTS + 2)

static vec3 on_circle(double radius, double angle, double z)
{
    return v3(radius * cos(angle), radius * sin(angle), z);
}

/* Both caps and both walls of one piece of outline from a to b. */
static void add_plate_piece(mesh *m, const place *at, const double a[2],
                            const double b[2], double bore, double z0, double z1)
{
    double angle_a = atan2(a[1], a[0]), angle_b = atan2(b[1], b[0]);
    vec3 low_a = v3(a[0], a[1], z0), low_b = v3(b[0], b[1], z0);
    vec3 high_a = v3(a[0], a[1], z1), high_b = v3(b[0], b[1], z1);
    shape_quad(m, at, low_a, low_b, high_b, high_a);
    if (bore <= 0.0) {
        shape_triangle(m, at, v3(0, 0, z1), high_a, high_b);
        shape_triangle(m, at, v3(0, 0, z0), low_b, low_a);
        return;
    }
    shape_quad(m, at, on_circle(bore, angle_a, z1), high_a, high_b,
               on_circle(bore, angle_b, z1));
    shape_quad(m, at, on_circle(bore, angle_b, z0), low_b, low_a,
               on_circle(bore, angle_a, z0));
    shape_quad(m, at, on_circle(bore, angle_b, z0), on_circle(bore, angle_a, z0),
               on_circle(bore, angle_a, z1), on_circle(bore, angle_b, z1));
}

void shape_plate(mesh *m, const place *at, const double (*outline)[2], int count,
                 double bore, double z0, double z1)
{
    for (int i = 0; i < count; i++)
        add_plate_piece(m, at, outline[i], outline[(i + 1) % count], bore, z0, z1);
}

void shape_prism(mesh *m, const place *at, int sides, double radius, double z0, double z1)
{
    for (int i = 0; i < sides; i++) {
        vec3 a = on_circle(radius, 2.0 * SCENE_PI * i / sides, 0.0);
        vec3 b = on_circle(radius, 2.0 * SCENE_PI * ((i + 1) % sides) / sides, 0.0);
        add_plate_piece(m, at, (const double[2]){a.x, a.y}, (const double[2]){b.x, b.y},
                        0.0, z0, z1);
    }
}

double gear_pitch_radius(const gear *g)
{
    return 0.5 * g->module * g->teeth;
}

/* The involute function: how far the flank has turned where the pressure angle is a. */
static double involute(double a)
{
    return tan(a) - a;
}

/* Half the angle that a tooth takes up at this radius. */
static double half_tooth_angle(const gear *g, double radius)
{
    double base = gear_pitch_radius(g) * cos(PRESSURE_ANGLE_RAD);
    double at_pitch = (0.5 - BACKLASH) * SCENE_PI / g->teeth;
    /* Below the base circle the flank goes straight to the root. */
    double pressure = radius > base ? acos(base / radius) : 0.0;
    return at_pitch + involute(PRESSURE_ANGLE_RAD) - involute(pressure);
}

/* Tooth after tooth: root, rising flank, falling flank, root. */
static int gear_outline(const gear *g, double (*outline)[2])
{
    double pitch = gear_pitch_radius(g);
    double root = pitch - 1.25 * g->module, tip = pitch + g->module;
    int count = 0;
    for (int tooth = 0; tooth < g->teeth; tooth++) {
        double middle = g->phase_rad + 2.0 * SCENE_PI * tooth / g->teeth;
        for (int i = 0; i < POINTS_A_TOOTH; i++) {
            int step = i < POINTS_A_TOOTH / 2 ? i : POINTS_A_TOOTH - 1 - i;
            double radius = root + (tip - root) * step / FLANK_POINTS;
            double half = half_tooth_angle(g, radius);
            vec3 p =
                on_circle(radius, middle + (i < POINTS_A_TOOTH / 2 ? -half : half), 0.0);
            outline[count][0] = p.x;
            outline[count][1] = p.y;
            count++;
        }
    }
    return count;
}

/* A ring with smooth walls inside and outside and flat ends. */
static void add_ring(mesh *m, const place *at, double inner, double outer,
                     double half_width)
{
    /* The lathe turns around Y: here local Z. */
    place upright = {at->origin, at->x, at->z, v3_scale(at->y, -1.0)};
    const profile_point profile[5] = {{inner, -half_width, true},
                                      {outer, -half_width, true},
                                      {outer, half_width, true},
                                      {inner, half_width, true},
                                      {inner, -half_width, true}};
    shape_lathe(m, &upright, profile, 5, 64);
}

/* Large gears have spokes, small ones a thin web. */
static void add_spokes(mesh *m, const place *at, double inner, double outer, double size,
                       double phase)
{
    enum { SPOKES = 6 };
    for (int i = 0; i < SPOKES; i++) {
        double c = cos(phase + 2.0 * SCENE_PI * i / SPOKES);
        double s = sin(phase + 2.0 * SCENE_PI * i / SPOKES);
        place turned = {at->origin, place_direction(at, v3(c, s, 0)),
                        place_direction(at, v3(-s, c, 0)), at->z};
        shape_box(m, &turned, v3(inner, -size, -0.6 * size), v3(outer, size, 0.6 * size),
                  0.15 * size);
    }
}

void shape_gear(mesh *m, const place *at, const gear *g)
{
    double outline[MAX_TEETH * POINTS_A_TOOTH][2];
    double half = 0.5 * g->width;
    double rim = gear_pitch_radius(g) - 2.6 * g->module;
    if (g->teeth < 3 || g->teeth > MAX_TEETH)
        return;
    const int count = gear_outline(g, outline);
    shape_plate(m, at, (const double(*)[2])outline, count, rim, -half, half);
    if (g->teeth >= 16)
        add_spokes(m, at, 1.6 * g->bore, rim + 0.2 * g->module, 0.10 * rim, g->phase_rad);
    else
        add_ring(m, at, 1.7 * g->bore, rim, 0.4 * half);
    add_ring(m, at, g->bore, 1.7 * g->bore, 1.15 * half);
}
