/* SPDX-License-Identifier: MIT */
/*
 * A small gearbox: a train of four gears on the front of a bolted housing, with pipes.
 */
#include "builtin.h"

#define MODULE     0.046
#define GEAR_WIDTH 0.16
#define GEAR_Z     0.17 /* middle of the gears, before the housing's front */
#define FRONT_Z    0.42
#define ROOF_Y     1.76 /* of the housing; its front plate stands up a little */
#define PLATE_Y    1.84

static void add_bolt(mesh *m, const place *at, double x, double y, double radius)
{
    place here = place_moved(at, v3(x, y, FRONT_Z));
    shape_prism(m, &here, 24, 1.5 * radius, 0.0, 0.25 * radius);
    shape_prism(m, &here, 6, radius, 0.25 * radius, 1.1 * radius);
}

static void add_axle(mesh *m, const place *gear_place, double bore)
{
    shape_prism(m, gear_place, 32, bore, -GEAR_Z, 0.75 * GEAR_WIDTH);
    shape_prism(m, gear_place, 6, 1.35 * bore, 0.62 * GEAR_WIDTH, 0.95 * GEAR_WIDTH);
    /* A collar keeps the gear off the housing. */
    shape_prism(m, gear_place, 32, 1.6 * bore, -GEAR_Z, -0.62 * GEAR_WIDTH);
}

static void add_gear(mesh *m, const place *at, vec3 centre, const gear *g)
{
    place here = place_moved(at, centre);
    mesh_set_colour(m, 0.62, 0.60, 0.56);
    shape_gear(m, &here, g);
    mesh_set_colour(m, 0.42, 0.43, 0.46);
    add_axle(m, &here, g->bore);
}

/* A gear that meshes with `driver`, in this direction from it. Sets its centre. */
static gear driven(const gear *driver, vec3 driver_centre, int teeth,
                   double direction_rad, vec3 *centre)
{
    gear g = {teeth, driver->module, driver->width, driver->bore, 0.0};
    double distance = gear_pitch_radius(driver) + gear_pitch_radius(&g);
    /* A gap of the one faces a tooth of the other, whatever the driver's phase. */
    g.phase_rad = direction_rad + SCENE_PI + SCENE_PI / teeth
                  - (driver->phase_rad - direction_rad) * driver->teeth / teeth;
    *centre = v3_add(driver_centre, v3(distance * cos(direction_rad),
                                       distance * sin(direction_rad), 0.0));
    return g;
}

static void add_gear_train(mesh *m, const place *at)
{
    gear large = {28, MODULE, GEAR_WIDTH, 0.075, 0.1};
    vec3 centre = v3(-0.42, 0.92, FRONT_Z + GEAR_Z), second, third, fourth;
    gear middle = driven(&large, centre, 16, -0.10, &second);
    gear small = driven(&middle, second, 12, 1.15, &third);
    gear top = driven(&large, centre, 12, 0.95, &fourth);
    add_gear(m, at, centre, &large);
    middle.bore = 0.06;
    small.bore = top.bore = 0.045;
    add_gear(m, at, second, &middle);
    add_gear(m, at, third, &small);
    add_gear(m, at, fourth, &top);
}

static void add_housing(mesh *m, const place *at)
{
    mesh_set_colour(m, 0.50, 0.48, 0.44);
    shape_box(m, at, v3(-1.3, 0.0, -0.62), v3(1.3, 0.16, 1.0), 0.02);
    mesh_set_colour(m, 0.26, 0.38, 0.37);
    shape_box(m, at, v3(-1.12, 0.16, -0.45), v3(1.12, ROOF_Y, 0.32), 0.05);
    mesh_set_colour(m, 0.32, 0.46, 0.44);
    shape_box(m, at, v3(-1.2, 0.16, 0.32), v3(1.2, PLATE_Y, FRONT_Z), 0.02);
    /* Cooling fins along the top. */
    for (int i = 0; i < 9; i++) {
        double x = -0.98 + 0.13 * i;
        shape_box(m, at, v3(x, ROOF_Y, -0.40), v3(x + 0.045, ROOF_Y + 0.24, 0.26), 0.008);
    }
}

static void add_bolts(mesh *m, const place *at)
{
    mesh_set_colour(m, 0.55, 0.55, 0.56);
    for (int i = 0; i < 8; i++) {
        double x = -1.1 + 2.2 * i / 7.0;
        add_bolt(m, at, x, PLATE_Y - 0.09, 0.028);
        add_bolt(m, at, x, 0.25, 0.028);
    }
    for (int i = 1; i < 5; i++) {
        add_bolt(m, at, -1.1, 0.25 + (PLATE_Y - 0.34) * i / 5.0, 0.028);
        add_bolt(m, at, 1.1, 0.25 + (PLATE_Y - 0.34) * i / 5.0, 0.028);
    }
}

/* Up from the housing's top, over its side and down to the base, with a round bend. */
static void add_pipe(mesh *m, const place *at, double z, double reach, double radius)
{
    enum { BEND = 12 };
    vec3 points[2 * BEND + 4];
    double bend = 0.16, top = ROOF_Y + 2.2 * bend, x0 = 0.72, x1 = 1.12 + reach;
    int count = 0;
    points[count++] = v3(x0, ROOF_Y - 0.02, z);
    for (int i = 0; i <= BEND; i++) {
        double a = SCENE_PI * 0.5 * i / BEND;
        points[count++] = v3(x0 + bend * (1.0 - cos(a)), top - bend + bend * sin(a), z);
    }
    for (int i = 0; i <= BEND; i++) {
        double a = SCENE_PI * 0.5 * i / BEND;
        points[count++] = v3(x1 - bend + bend * sin(a), top - bend + bend * cos(a), z);
    }
    points[count++] = v3(x1, 0.02, z);
    mesh_set_colour(m, 0.58, 0.38, 0.24);
    shape_tube(m, at, points, count, radius, 24);
}

static void add_flanges(mesh *m, const place *at, double z, double reach, double radius)
{
    const profile_point ring[4] = {{0.0, 0.0, true},
                                   {1.7 * radius, 0.0, true},
                                   {1.7 * radius, 0.05, true},
                                   {0.0, 0.05, true}};
    place top = place_moved(at, v3(0.72, ROOF_Y, z));
    place low = place_moved(at, v3(1.12 + reach, 0.0, z));
    place joint = place_moved(at, v3(1.12 + reach, 0.9, z));
    shape_lathe(m, &top, ring, 4, 32);
    shape_lathe(m, &low, ring, 4, 32);
    shape_lathe(m, &joint, ring, 4, 32);
}

void builtin_machine(mesh *m, const place *at)
{
    add_housing(m, at);
    add_bolts(m, at);
    add_gear_train(m, at);
    add_pipe(m, at, 0.08, 0.36, 0.07);
    add_flanges(m, at, 0.08, 0.36, 0.07);
    add_pipe(m, at, -0.24, 0.36, 0.07);
    add_flanges(m, at, -0.24, 0.36, 0.07);
}
