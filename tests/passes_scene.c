/* SPDX-License-Identifier: MIT */
#include "passes_scene.h"

double eye[3], axes[3][3];
double depth[PIXELS], world[3][PIXELS], view[3][PIXELS];
float planes[4][PIXELS];

void look(const double from[3], const double at[3])
{
    const double up[3] = {0, 1, 0};
    double *r = axes[0], *u = axes[1], *b = axes[2], length = 0.0;
    for (int c = 0; c < 3; c++) {
        eye[c] = from[c];
        b[c] = from[c] - at[c];
        length += b[c] * b[c];
    }
    for (int c = 0; c < 3; c++)
        b[c] /= sqrt(length);
    for (int c = 0; c < 3; c++)
        r[c] = up[(c + 1) % 3] * b[(c + 2) % 3] - up[(c + 2) % 3] * b[(c + 1) % 3];
    length = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    for (int c = 0; c < 3; c++)
        r[c] /= length;
    for (int c = 0; c < 3; c++)
        u[c] = b[(c + 1) % 3] * r[(c + 2) % 3] - b[(c + 2) % 3] * r[(c + 1) % 3];
}

static void put(int i, double t, double nx, double ny, double nz)
{
    if (!(t > 1e-6 && t < depth[i]))
        return;
    depth[i] = t;
    world[0][i] = nx;
    world[1][i] = ny;
    world[2][i] = nz;
}

/* The ray o + t d: t is planar depth, because d has length 1 along the view. */
static void trace_ray(int i, const double o[3], const double d[3])
{
    depth[i] = INFINITY;
    for (int c = 0; c < 3; c++)
        world[c][i] = 0.0;
    const double floor = -o[1] / d[1], x = o[0] + floor * d[0], z = o[2] + floor * d[2];
    if (fabs(x) < 30 && fabs(z) < 30)
        put(i, floor, 0, 1, 0);
    const double wall = (-4 - o[2]) / d[2], wy = o[1] + wall * d[1];
    if (wy > 0 && wy < 1.5)
        put(i, wall, 0, 0, 1);
    const double side = (-1.2 - o[0]) / d[0], sy = o[1] + side * d[1],
                 sz = o[2] + side * d[2];
    if (d[0] < 0 && sy > 0 && sy < 1.4 && sz > -3 && sz < -0.5)
        put(i, side, 1, 0, 0);
    const double centre[3] = {1.2, 0.8, -0.8}, radius = 0.8;
    double a = 0, b = 0, q = 0;
    for (int c = 0; c < 3; c++) {
        a += d[c] * d[c];
        b += (o[c] - centre[c]) * d[c];
        q += (o[c] - centre[c]) * (o[c] - centre[c]);
    }
    const double root = b * b - a * (q - radius * radius);
    if (root > 0) {
        const double t = (-b - sqrt(root)) / a;
        put(i, t, (o[0] + t * d[0] - centre[0]) / radius,
            (o[1] + t * d[1] - centre[1]) / radius,
            (o[2] + t * d[2] - centre[2]) / radius);
    }
}

void trace(const window *w)
{
    for (int i = 0; i < PIXELS; i++) {
        const double x = w->left + (w->right - w->left) * (i % W + 0.5) / W;
        const double y = w->top - (w->top - w->bottom) * (i / W + 0.5) / H;
        double o[3], d[3];
        for (int c = 0; c < 3; c++) {
            const double across = x * axes[0][c] + y * axes[1][c];
            o[c] = eye[c] + (w->orthographic ? across : 0.0);
            d[c] = (w->orthographic ? 0.0 : across) - axes[2][c];
        }
        trace_ray(i, o, d);
        for (int r = 0; r < 3; r++) {
            view[r][i] = 0.0;
            for (int c = 0; c < 3; c++)
                view[r][i] += axes[r][c] * world[c][i];
        }
    }
}

window centred(double vfov_deg)
{
    const double t = tan(0.5 * vfov_deg * pi / 180.0);
    return (window){-t * W / H, t * W / H, -t, t, false};
}

const double usual_eye[3] = {2.2, 2.4, 4.2}, usual_target[3] = {0, 0.6, -1};

void make_usual(double vfov_deg)
{
    const window w = centred(vfov_deg);
    look(usual_eye, usual_target);
    trace(&w);
    for (int i = 0; i < PIXELS; i++)
        planes[0][i] = (float)(isfinite(depth[i]) ? depth[i] : 1e10);
}

void fill_metadata(const window *w, bool is_signed, io_camera_metadata *out)
{
    const double width = w->right - w->left, height = w->top - w->bottom;
    memset(out, 0, sizeof *out);
    out->has_world_to_camera = out->has_world_to_ndc = true;
    double to_camera[4][4] = {{0}};
    for (int c = 0; c < 3; c++) {
        to_camera[c][0] = axes[0][c];
        to_camera[c][1] = axes[1][c];
        to_camera[c][2] = -axes[2][c];
        for (int k = 0; k < 3; k++)
            to_camera[3][c] -= eye[k] * (c == 2 ? -axes[c][k] : axes[c][k]);
    }
    to_camera[3][3] = 1.0;
    double projection[4][4] = {{0}};
    const double sx = is_signed ? 2 / width : 1 / width;
    const double sy = is_signed ? 2 / height : -1 / height;
    const double cx = is_signed ? -(w->right + w->left) / width : -w->left / width;
    const double cy = is_signed ? -(w->top + w->bottom) / height : w->top / height;
    projection[0][0] = sx;
    projection[1][1] = sy;
    const int row = w->orthographic ? 3 : 2;
    projection[row][0] = cx;
    projection[row][1] = cy;
    projection[2][2] = 0.01; /* near 0, far 100, or so */
    projection[row == 3 ? 3 : 2][3] = 1.0;
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) {
            double sum = 0.0;
            for (int k = 0; k < 4; k++)
                sum += to_camera[r][k] * projection[k][c];
            out->world_to_ndc[4 * r + c] = (float)sum;
            out->world_to_camera[4 * r + c] = (float)to_camera[r][c];
        }
}

const char *write_frame(bool normals, const io_camera_metadata *camera)
{
    static const char *const names[] = {"Z", "N.X", "N.Y", "N.Z"};
    const char *path = support_path("evidence.exr");
    io_image image;
    assert_int_equal(io_image_init(&image, W, H, names, normals ? 4 : 1, NULL), 0);
    for (int c = 0; c < (normals ? 4 : 1); c++)
        memcpy(image.channels[c].data, planes[c], sizeof planes[c]);
    if (camera)
        image.camera = *camera;
    assert_int_equal(io_write(path, &image, NULL, support_logger()), 0);
    io_image_free(&image);
    support_forget();
    return path;
}

void set_normals(double n[3][PIXELS], const double m[9])
{
    for (int i = 0; i < PIXELS; i++)
        for (int r = 0; r < 3; r++)
            planes[1 + r][i] = (float)(m[3 * r] * n[0][i] + m[3 * r + 1] * n[1][i]
                                       + m[3 * r + 2] * n[2][i]);
}

const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

io_passes_request request_of(double vfov_deg)
{
    return (io_passes_request){.depth_format = crv_depth_format_planar(),
                               .vfov_rad = (float)(vfov_deg * pi / 180.0)};
}

void load(const char *path, const io_passes_request *request, io_frame *frame)
{
    if (io_frame_load(path, request, frame, support_logger()))
        fail_msg("%s", support_lines.error);
}

void expect_truth(const io_frame *frame)
{
    static float got[3 * PIXELS], got_depth[PIXELS];
    crv_context *context = NULL;
    crv_gbuffer *gbuffer = NULL;
    const crv_image image = crv_image_packed(got, W, H, 3);
    const crv_image depths = crv_image_packed(got_depth, W, H, 1);
    assert_true(frame->has_normals);
    assert_int_equal(crv_context_create(NULL, &context), CRV_OK);
    assert_int_equal(io_frame_to_gbuffer(frame, context, &gbuffer), CRV_OK);
    assert_int_equal(crv_gbuffer_get_normals(gbuffer, &image), CRV_OK);
    assert_int_equal(crv_gbuffer_get_depth(gbuffer, 0, &depths), CRV_OK);
    for (int i = 0; i < PIXELS; i++) {
        double dot = 0.0;
        assert_int_equal(isfinite(depth[i]), isfinite(got_depth[i]));
        if (!isfinite(depth[i]))
            continue;
        assert_true(fabs((double)got_depth[i] / depth[i] - 1.0) < 1e-4);
        for (int c = 0; c < 3; c++)
            dot += (double)got[3 * i + c] * view[c][i];
        /* The library bends normals that face away, as a sphere's do at its outline. */
        if (dot < cos(0.3 * pi / 180.0) && view[2][i] > 0.2)
            fail_msg("pixel %d: %g degrees off: %s", i, acos(dot) * 180.0 / pi,
                     support_lines.text);
    }
    crv_gbuffer_destroy(gbuffer);
    crv_context_destroy(context);
}
