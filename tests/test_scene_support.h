/* SPDX-License-Identifier: MIT */
/*
 * test_scene_support.h: files that tests write, messages that they catch, and rays
 * computed a second time, straight from the camera's definition.
 */
#ifndef CREVICE_TEST_SCENE_SUPPORT_H
#define CREVICE_TEST_SCENE_SUPPORT_H

#include <stdarg.h>
#include <setjmp.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>

#include "scene.h"

#define PI 3.14159265358979323846

/* The last line of each level, and how many there were. */
typedef struct messages {
    int errors, warnings;
    char error[1024], warning[1024];
} messages;

/* A logger that fills `m`, which is cleared. */
crv_logger catch_messages(messages *m);

/* The error is one line that begins with the name and has a cure after a semicolon. */
void assert_error_line(const messages *m, const char *name);

/* Writes a file into a folder of this process's own and returns its path (static,
 * until the next call). remove_files(), a group's teardown, removes the folder. */
const char *write_file(const char *name, const void *data, size_t size);
const char *write_text(const char *name, const char *text);
const char *test_folder(void);
int remove_files(void **state);

/* Loads a text file that must load without a message. */
scene *load_text(const char *name, const char *text);

/* A view of 45 degrees, or of this height where orthographic. */
scene_view look(crv_projection projection, const double eye[3], const double target[3],
                double view_height);

/* One layer, no guard band, OpenMP's choice of threads. */
scene_gbuffer_request request_of(const scene_view *view, int32_t width, int32_t height);

/* Renders; must succeed without a message. */
scene_gbuffer render(const scene *s, const scene_gbuffer_request *request);

/* Origin and direction (1 along the axis, so that its parameter is planar depth) of the
 * ray through a pixel's centre, in world space. */
typedef struct ray {
    double origin[3], direction[3];
} ray;
ray ray_of_pixel(const scene_gbuffer *g, int32_t x, int32_t y);

/* A view-space vector in world space. */
void to_world(const scene_gbuffer *g, const float view[3], double world[3]);

double dot(const double a[3], const double b[3]);

#endif
