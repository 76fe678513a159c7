/* SPDX-License-Identifier: MIT */
/*
 * The demo scene: a corner of a courtyard, in metres, +Z towards the viewer. It has what
 * ambient occlusion is about: contacts, joints, hollows, thin things before far ones, and
 * open sky behind part of it.
 */
#include "builtin.h"

static void stone(mesh *m)
{
    mesh_set_colour(m, 0.70, 0.66, 0.59);
}

static void pale_stone(mesh *m)
{
    mesh_set_colour(m, 0.80, 0.77, 0.71);
}

/* Slabs with open joints over a bed. */
static void add_floor(mesh *m, const place *world)
{
    const double size = 0.9, joint = 0.02;
    uint64_t random = 7;
    mesh_set_colour(m, 0.42, 0.39, 0.35);
    shape_quad(m, world, v3(-13, -0.05, 8), v3(13, -0.05, 8), v3(13, -0.05, -12),
               v3(-13, -0.05, -12));
    for (int row = -13; row < 8; row++) {
        double shift = row & 1 ? 0.5 * size : 0.0;
        for (int column = -14; column < 14; column++) {
            double x = column * size + shift, z = row * size;
            double tone = 0.58 + 0.10 * builtin_random(&random);
            mesh_set_colour(m, tone, 0.96 * tone, 0.89 * tone);
            shape_box(m, world, v3(x + joint, -0.12, z + joint),
                      v3(x + size, 0.0, z + size), 0.008);
        }
    }
}

typedef struct arch {
    double centre, half_width, spring, depth; /* of the opening: x, x, y, z */
    double sill;                              /* y of its floor */
} arch;

/* The height of the arch's intrados at this x. */
static double arch_height(const arch *a, double x)
{
    double r = (x - a->centre) / a->half_width;
    return a->spring + a->half_width * sqrt(fmax(0.0, 1.0 - r * r));
}

/* The wall's front about the niche, and the niche's vault; front in the plane z = 0. */
static void add_arched_front(mesh *m, const place *at, const arch *a, double top)
{
    enum { PIECES = 48 };
    double left = a->centre - a->half_width, right = a->centre + a->half_width;
    for (int i = 0; i < PIECES; i++) {
        /* Even in angle, so that the flanks are as round as the crown. */
        double x0 = a->centre - a->half_width * cos(SCENE_PI * i / PIECES);
        double x1 = a->centre - a->half_width * cos(SCENE_PI * (i + 1) / PIECES);
        double y0 = arch_height(a, x0), y1 = arch_height(a, x1);
        shape_quad(m, at, v3(x0, y0, 0), v3(x1, y1, 0), v3(x1, top, 0), v3(x0, top, 0));
        shape_quad(m, at, v3(x0, y0, -a->depth), v3(x1, y1, -a->depth), v3(x1, y1, 0),
                   v3(x0, y0, 0));
        shape_quad(m, at, v3(x0, a->sill, -a->depth), v3(x1, a->sill, -a->depth),
                   v3(x1, y1, -a->depth), v3(x0, y0, -a->depth));
    }
    shape_quad(m, at, v3(left, a->sill, 0), v3(left, a->sill, -a->depth),
               v3(left, a->spring, -a->depth), v3(left, a->spring, 0));
    shape_quad(m, at, v3(right, a->sill, -a->depth), v3(right, a->sill, 0),
               v3(right, a->spring, 0), v3(right, a->spring, -a->depth));
    shape_quad(m, at, v3(left, a->sill, 0), v3(right, a->sill, 0),
               v3(right, a->sill, -a->depth), v3(left, a->sill, -a->depth));
    shape_quad(m, at, v3(left, 0, 0), v3(right, 0, 0), v3(right, a->sill, 0),
               v3(left, a->sill, 0));
}

/* Wedge-shaped stones around the arch, standing out from the wall. */
static void add_voussoirs(mesh *m, const place *at, const arch *a)
{
    enum { STONES = 15 };
    const double inner = a->half_width, outer = inner + 0.26, gap = 0.012;
    for (int i = 0; i < STONES; i++) {
        double a0 = SCENE_PI * i / STONES + gap / inner;
        double a1 = SCENE_PI * (i + 1) / STONES;
        double rim = i == STONES / 2 ? outer + 0.12 : outer; /* the keystone */
        double front = i == STONES / 2 ? 0.11 : 0.06;
        vec3 p[4] = {
            v3(inner * cos(a0), inner * sin(a0), 0), v3(rim * cos(a0), rim * sin(a0), 0),
            v3(rim * cos(a1), rim * sin(a1), 0), v3(inner * cos(a1), inner * sin(a1), 0)};
        place here = place_moved(at, v3(a->centre, a->spring, 0));
        for (int k = 0; k < 4; k++) {
            vec3 b = p[k], c = p[(k + 1) % 4], out = v3(0, 0, front);
            shape_quad(m, &here, b, c, v3_add(c, out), v3_add(b, out));
        }
        shape_quad(m, &here, v3_add(p[0], v3(0, 0, front)), v3_add(p[1], v3(0, 0, front)),
                   v3_add(p[2], v3(0, 0, front)), v3_add(p[3], v3(0, 0, front)));
    }
}

/* Half the width of what is left free around the arch between two heights. */
static double free_half_width(const arch *a, double low, double high)
{
    const double ring = a->half_width + 0.29;
    double above = fmax(0.0, low - a->spring);
    if (high <= a->spring)
        return a->half_width + 0.02;
    return above < ring ? sqrt(ring * ring - above * above) : 0.0;
}

/* Courses of blocks with open joints, from the niche outwards. */
static void add_blocks(mesh *m, const place *at, const arch *a, double left, double right,
                       double low, double top)
{
    enum { COURSES = 9 };
    const double rise = (top - low) / COURSES, joint = 0.022;
    uint64_t random = 23;
    for (int course = 0; course < COURSES; course++) {
        double y = low + rise * course, free = free_half_width(a, y, y + rise);
        for (int side = -1; side <= 1; side += 2) {
            double x = a->centre + side * free, end = side < 0 ? left : right;
            double length = course & 1 ? 0.45 : 0.85;
            while (side * (end - x) > 0.1) {
                double next = fmin(length, fabs(end - x));
                double x0 = side < 0 ? x - next : x, x1 = x0 + next;
                const double tone = 0.62 + 0.10 * builtin_random(&random);
                mesh_set_colour(m, tone, 0.94 * tone, 0.84 * tone);
                shape_box(m, at, v3(x0 + joint, y + joint, -0.02),
                          v3(x1, y + rise, 0.045), 0.012);
                x += side * next;
                length = 0.75 + 0.25 * builtin_random(&random);
            }
        }
    }
}

static void add_urn(mesh *m, const place *at)
{
    static const profile_point pedestal[] = {
        {0.0, 0.0, true},   {0.34, 0.0, true},  {0.34, 0.10, true}, {0.27, 0.14, true},
        {0.27, 0.52, true}, {0.33, 0.58, true}, {0.33, 0.64, true}, {0.0, 0.64, true}};
    static const profile_point urn[] = {
        {0.0, 0.64, true},   {0.17, 0.64, true},   {0.17, 0.68, true},
        {0.09, 0.73, false}, {0.065, 0.80, false}, {0.12, 0.88, false},
        {0.22, 0.98, false}, {0.275, 1.10, false}, {0.28, 1.20, false},
        {0.24, 1.30, false}, {0.18, 1.37, false},  {0.165, 1.42, false},
        {0.20, 1.47, false}, {0.25, 1.50, true},   {0.25, 1.53, true},
        {0.20, 1.53, true},  {0.13, 1.42, false},  {0.0, 1.38, true}};
    pale_stone(m);
    shape_lathe(m, at, pedestal, sizeof pedestal / sizeof *pedestal, 48);
    mesh_set_colour(m, 0.62, 0.36, 0.24);
    shape_lathe(m, at, urn, sizeof urn / sizeof *urn, 64);
}

static void add_wall(mesh *m, const place *world)
{
    const double top = 4.3, left = -12.0, right = 1.25, thick = 1.1;
    const arch niche = {-2.1, 0.95, 2.35, 0.8, 0.72};
    place at = place_moved(world, v3(0, 0, -4.2));
    place urn = place_moved(&at, v3(niche.centre, niche.sill, -0.4));
    double edge_left = niche.centre - niche.half_width;
    double edge_right = niche.centre + niche.half_width;
    stone(m);
    add_arched_front(m, &at, &niche, top);
    shape_quad(m, &at, v3(left, 0, 0), v3(edge_left, 0, 0), v3(edge_left, top, 0),
               v3(left, top, 0));
    shape_quad(m, &at, v3(edge_right, 0, 0), v3(right, 0, 0), v3(right, top, 0),
               v3(edge_right, top, 0));
    shape_quad(m, &at, v3(right, 0, 0), v3(right, 0, -thick), v3(right, top, -thick),
               v3(right, top, 0));
    shape_quad(m, &at, v3(right, 0, -thick), v3(left, 0, -thick), v3(left, top, -thick),
               v3(right, top, -thick));
    shape_quad(m, &at, v3(left, top, 0), v3(right, top, 0), v3(right, top, -thick),
               v3(left, top, -thick));
    add_blocks(m, &at, &niche, left, right, 0.42, top);
    pale_stone(m);
    add_voussoirs(m, &at, &niche);
    /* Plinth to both sides of the steps, cornice in two courses. */
    shape_box(m, &at, v3(left, 0, -0.02), v3(-3.72, 0.42, 0.1), 0.02);
    shape_box(m, &at, v3(-0.48, 0, -0.02), v3(right + 0.08, 0.42, 0.1), 0.02);
    shape_box(m, &at, v3(left, top, -thick - 0.1), v3(right + 0.1, top + 0.14, 0.1),
              0.015);
    shape_box(m, &at, v3(left, top + 0.14, -thick - 0.2),
              v3(right + 0.2, top + 0.30, 0.2), 0.015);
    add_urn(m, &urn);
}

/* Steps up to the niche, between two low walls. */
static void add_steps(mesh *m, const place *world)
{
    enum { STEPS = 4 };
    const double rise = 0.18, tread = 0.36, half = 1.35;
    place at = place_moved(world, v3(-2.1, 0, -4.2));
    pale_stone(m);
    for (int i = 0; i < STEPS; i++)
        shape_box(m, &at, v3(-half, i * rise, 0.0),
                  v3(half, (i + 1) * rise, tread * (STEPS - i) + 0.1), 0.015);
    stone(m);
    for (int side = -1; side <= 1; side += 2) {
        double x = side * (half + 0.135);
        shape_box(m, &at, v3(x - 0.13, 0, 0), v3(x + 0.13, 0.86, 1.7), 0.02);
        shape_box(m, &at, v3(x - 0.16, 0.86, -0.0), v3(x + 0.16, 0.96, 1.74), 0.02);
        shape_sphere(m, &at, v3(x, 0.96 + 0.17, 1.5), 0.17, 48);
    }
}

/* Base, fluted shaft and, if asked for, capital. */
static void add_column(mesh *m, const place *at, double height, bool capital)
{
    static const profile_point base[] = {
        {0.0, 0.14, true},    {0.40, 0.14, true},   {0.43, 0.16, false},
        {0.445, 0.20, false}, {0.43, 0.24, false},  {0.40, 0.26, true},
        {0.36, 0.27, true},   {0.345, 0.30, false}, {0.355, 0.33, true},
        {0.37, 0.34, false},  {0.385, 0.37, false}, {0.37, 0.40, false},
        {0.35, 0.41, true},   {0.0, 0.41, true}};
    static const profile_point echinus[] = {
        {0.0, 0.0, true},   {0.27, 0.0, true},   {0.29, 0.02, false}, {0.27, 0.05, true},
        {0.26, 0.09, true}, {0.30, 0.13, false}, {0.36, 0.18, false}, {0.39, 0.23, false},
        {0.39, 0.26, true}, {0.0, 0.26, true}};
    const double top = height - 0.40;
    place shaft = place_moved(at, v3(0, 0.41, 0)), head = place_moved(at, v3(0, top, 0));
    pale_stone(m);
    shape_box(m, at, v3(-0.46, 0, -0.46), v3(0.46, 0.14, 0.46), 0.015);
    shape_lathe(m, at, base, sizeof base / sizeof *base, 64);
    if (!capital) {
        shape_fluted_shaft(m, &shaft, 0.33, 0.30, height - 0.41, 20);
        return;
    }
    shape_fluted_shaft(m, &shaft, 0.33, 0.265, top - 0.41, 20);
    shape_lathe(m, &head, echinus, sizeof echinus / sizeof *echinus, 64);
    shape_box(m, &head, v3(-0.44, 0.26, -0.44), v3(0.44, 0.40, 0.44), 0.012);
}

/* A beam over columns, with a row of dentils under its cornice. */
static void add_beam(mesh *m, const place *at, double x0, double x1, double y)
{
    int dentils = (int)((x1 - x0 - 0.1) / 0.2);
    double first = 0.5 * (x0 + x1) - 0.1 * dentils;
    stone(m);
    shape_box(m, at, v3(x0, y, -0.34), v3(x1, y + 0.34, 0.34), 0.012);
    shape_box(m, at, v3(x0 - 0.16, y + 0.46, -0.5), v3(x1 + 0.16, y + 0.62, 0.5), 0.015);
    pale_stone(m);
    shape_box(m, at, v3(x0 + 0.02, y + 0.34, -0.32), v3(x1 - 0.02, y + 0.46, 0.32), 0.0);
    for (int i = 0; i < dentils; i++) {
        double x = first + 0.2 * i + 0.045;
        shape_box(m, at, v3(x, y + 0.35, 0.32), v3(x + 0.11, y + 0.46, 0.43), 0.0);
        shape_box(m, at, v3(x, y + 0.35, -0.43), v3(x + 0.11, y + 0.46, -0.32), 0.0);
    }
}

static void add_colonnade(mesh *m, const place *world)
{
    static const double x[3] = {2.35, 4.35, 6.35};
    place row = place_moved(world, v3(0, 0, -3.4));
    place broken = place_moved(world, v3(6.35, 0, -3.4));
    for (int i = 0; i < 2; i++) {
        place at = place_moved(&row, v3(x[i], 0, 0));
        add_column(m, &at, 3.5, true);
    }
    add_column(m, &broken, 1.9, false);
    add_beam(m, &row, x[0] - 0.45, x[1] + 0.45, 3.5);
}

/* A drum of a fallen column, on its side; its flutes touch the floor. */
static void add_fallen_drum(mesh *m, const place *world)
{
    place turned = place_turned(world, v3(0.75, 0.33, -1.75), 0.55);
    place lying = {turned.origin, turned.y, turned.x, v3_scale(turned.z, -1.0)};
    pale_stone(m);
    shape_fluted_shaft(m, &lying, 0.33, 0.32, 1.15, 20);
}

/* Four spheres of one size stacked as close as they go, and others beside them. */
static void add_spheres(mesh *m, const place *world)
{
    const double r = 0.40;
    place pile = place_turned(world, v3(-0.55, 0, 1.15), 0.35);
    const double side = 2.0 * r / sqrt(3.0); /* from the middle of three to each */
    mesh_set_colour(m, 0.78, 0.74, 0.68);
    for (int i = 0; i < 3; i++) {
        double a = 2.0 * SCENE_PI * i / 3.0;
        shape_sphere(m, &pile, v3(side * cos(a), r, side * sin(a)), r, 128);
    }
    mesh_set_colour(m, 0.64, 0.30, 0.22);
    shape_sphere(m, &pile, v3(0, r + r * sqrt(8.0 / 3.0), 0), r, 128);
    mesh_set_colour(m, 0.30, 0.40, 0.52);
    shape_sphere(m, world, v3(0.62, 0.17, 2.05), 0.17, 96);
    shape_sphere(m, world, v3(0.9245, 0.14, 2.0), 0.14, 96);
    mesh_set_colour(m, 0.78, 0.74, 0.68);
    shape_sphere(m, world, v3(-1.55, 0.2, 2.3), 0.2, 96);
}

/* A bed of soil behind kerbstones, full of grass. */
static void add_grass_bed(mesh *m, const place *world)
{
    const double left = -6.4, right = -2.3, back = -1.2, front = 2.1;
    uint64_t random = 11;
    mesh_set_colour(m, 0.24, 0.18, 0.13);
    shape_quad(m, world, v3(left, 0.07, front), v3(right, 0.07, front),
               v3(right, 0.07, back), v3(left, 0.07, back));
    stone(m);
    for (int i = 0; i < 6; i++) {
        double x = left + (right - left) * i / 6.0,
               next = left + (right - left) * (i + 1) / 6.0;
        shape_box(m, world, v3(x + 0.01, 0, front), v3(next, 0.17, front + 0.16), 0.02);
        shape_box(m, world, v3(x + 0.01, 0, back - 0.16), v3(next, 0.17, back), 0.02);
    }
    for (int i = 0; i < 5; i++) {
        double z = back + (front - back) * i / 5.0,
               next = back + (front - back) * (i + 1) / 5.0;
        shape_box(m, world, v3(right, 0, z + 0.01), v3(right + 0.16, 0.17, next), 0.02);
    }
    for (int i = 0; i < 170; i++) {
        double x = left + 0.1 + (right - left - 0.25) * builtin_random(&random);
        double z = back + 0.12 + (front - back - 0.24) * builtin_random(&random);
        double green = builtin_random(&random);
        place at = place_at(x, 0.07, z);
        mesh_set_colour(m, 0.24 + 0.12 * green, 0.36 + 0.10 * green, 0.13);
        builtin_tuft(m, &at, 0.13, 0.34 + 0.24 * builtin_random(&random), 26,
                     1000u + (uint64_t)i);
    }
}

/* Weeds along the foot of walls and columns. */
static void add_weeds(mesh *m)
{
    static const double spots[][2] = {{-0.2, -3.98}, {0.7, -4.0},   {1.5, -3.75},
                                      {2.95, -3.3},  {5.0, -3.0},   {5.75, -3.1},
                                      {-5.2, -3.95}, {-6.6, -3.98}, {1.05, 0.01},
                                      {3.3, -1.79},  {-4.2, -3.9}};
    mesh_set_colour(m, 0.30, 0.40, 0.16);
    for (size_t i = 0; i < sizeof spots / sizeof *spots; i++) {
        place at = place_at(spots[i][0], -0.04, spots[i][1]);
        builtin_tuft(m, &at, 0.06, 0.34, 16, 5000u + i);
    }
}

void builtin_courtyard(mesh *m, scene_view *view, const double *p)
{
    place world = place_at(0, 0, 0);
    place machine = place_turned(&world, v3(2.75, 0, 0.7), -0.22);
    (void)p;
    mesh_reserve(m, 500000, 400000);
    add_floor(m, &world);
    add_wall(m, &world);
    add_steps(m, &world);
    add_colonnade(m, &world);
    add_fallen_drum(m, &world);
    add_spheres(m, &world);
    builtin_machine(m, &machine);
    add_grass_bed(m, &world);
    add_weeds(m);
    *view = (scene_view){.projection = CRV_PERSPECTIVE,
                         .eye = {1.0f, 2.55f, 8.3f},
                         .target = {0.32f, 1.52f, 0.0f},
                         .up = {0.0f, 1.0f, 0.0f},
                         .vfov_rad = (float)(40.0 * SCENE_PI / 180.0),
                         .view_height = 6.0f};
}
