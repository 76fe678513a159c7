/* SPDX-License-Identifier: MIT */
/* passes_scene.h: one analytic scene (floor, wall, box corner, sphere), to be written as
 * renderers write such frames. */
#ifndef TESTS_PASSES_SCENE_H
#define TESTS_PASSES_SCENE_H

#include <math.h>

#include "passes/passes.h"
#include "test_io_support.h"

enum { W = 160, H = 100, PIXELS = W * H };

static const double pi = 3.14159265358979323846;

/* The frame at distance 1 (perspective) or in scene units (orthographic). */
typedef struct window {
    double left, right, bottom, top;
    bool orthographic;
} window;

extern double eye[3], axes[3][3]; /* rows: right, up, back; in a right-handed world */
extern double depth[PIXELS], world[3][PIXELS], view[3][PIXELS]; /* depth INFINITY: sky */
extern float planes[4][PIXELS]; /* what is written: depth, then normals */
extern const double usual_eye[3], usual_target[3], identity[9];

void look(const double from[3], const double at[3]);
void trace(const window *w);
window centred(double vfov_deg);

/* Traces the usual view, its depth in planes[0] with the sky at 1e10. */
void make_usual(double vfov_deg);

/* worldToNDC of OpenEXR's definition (0 to 1, y down) or as clip coordinates (-1 to 1, y
 * up), row vectors; worldToCamera with z along the view. */
void fill_metadata(const window *w, bool is_signed, io_camera_metadata *out);

/* planes[0] is depth, planes[1..3] are normals. */
const char *write_frame(bool normals, const io_camera_metadata *camera);

void set_normals(double n[3][PIXELS], const double m[9]);
io_passes_request request_of(double vfov_deg);
void load(const char *path, const io_passes_request *request, io_frame *frame);

/* Depth and normals as the library has them must be the true ones, within 0.3 degrees (a
 * fit's error) and a part in 10^4 (single precision, through a hardware depth). */
void expect_truth(const io_frame *frame);

#endif
