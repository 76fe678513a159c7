/* SPDX-License-Identifier: MIT */
/* normals.c: given normals are decoded, and brought to the space that they were found in.
 */
#include <math.h>
#include <string.h>

#include "internal.h"
#include "normals.h"
#include "pairs.h"

/* n of n / 2 + 1/2. Grey stands for no normal: it is what 0 becomes, up to a step of 8
 * bits. */
static void centre(const float n[3], float out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = 2.0f * n[c] - 1.0f;
}

static bool is_grey(const float centred[3])
{
    return io__length(centred) < 0.02;
}

/* Whether the normals look like n / 2 + 1/2: nearly all of them, or many and none beyond
 * 0 and 1, if the background has a colour. A scene whose unit normals are all in the
 * positive octant does not: their length is 1 already. */
static bool looks_encoded(const io_frame *frame)
{
    const int32_t step = io__sampling_step(&frame->normals);
    size_t seen = 0, encoded = 0, within = 0;
    for (int32_t y = step / 2; y < frame->desc.height; y += step)
        for (int32_t x = step / 2; x < frame->desc.width; x += step) {
            float n[3];
            io__load_normal(&frame->normals, x, y, n);
            const double plain = io__length(n);
            if (!isfinite(plain) || plain < 1e-3)
                continue;
            float centred[3];
            centre(n, centred);
            if (is_grey(centred))
                continue;
            const bool inside = fminf(n[0], fminf(n[1], n[2])) >= -1e-3f
                                && fmaxf(n[0], fmaxf(n[1], n[2])) <= 1.001f;
            const double error = fabs(io__length(centred) - 1.0);
            seen++;
            within += inside;
            encoded += inside && error < 0.05 && error < fabs(plain - 1.0);
        }
    return seen >= 8
           && ((double)encoded > 0.9 * (double)seen
               || (within == seen && (double)encoded > 0.3 * (double)seen));
}

static void decode(io_frame *frame)
{
    for (int32_t y = 0; y < frame->desc.height; y++)
        for (int32_t x = 0; x < frame->desc.width; x++) {
            float n[3];
            io__load_normal(&frame->normals, x, y, n);
            const double length = io__length(n);
            float centred[3];
            centre(n, centred);
            const bool nothing = !isfinite(length) || length < 1e-3 || is_grey(centred);
            for (int32_t c = 0; c < 3; c++)
                *crv_image_at(&frame->normals, x, y, c) = nothing ? 0.0f : centred[c];
        }
}

/* Averages over a silhouette are short; nothing makes all of them longer than 1 but a
 * factor. */
static bool are_too_long(const io_frame *frame)
{
    const int32_t step = io__sampling_step(&frame->normals);
    size_t seen = 0, too_long = 0;
    for (int32_t y = step / 2; y < frame->desc.height; y += step)
        for (int32_t x = step / 2; x < frame->desc.width; x += step) {
            float n[3];
            io__load_normal(&frame->normals, x, y, n);
            const double length = io__length(n);
            seen += isfinite(length) && length > 1e-3;
            too_long += isfinite(length) && length > 1.1;
        }
    return seen >= 8 && 2 * too_long > seen;
}

static void shorten(io_frame *frame)
{
    for (int32_t y = 0; y < frame->desc.height; y++)
        for (int32_t x = 0; x < frame->desc.width; x++) {
            float n[3];
            io__load_normal(&frame->normals, x, y, n);
            const double length = io__length(n);
            for (int32_t c = 0; c < 3 && length > 0.0; c++)
                *crv_image_at(&frame->normals, x, y, c) = (float)((double)n[c] / length);
        }
}

void io__decode_normals(const char *path, const io_passes_request *request,
                        io_frame *frame, const crv_logger *log)
{
    if (looks_encoded(frame)) {
        decode(frame);
        io__info(log, path, "normals: stored as n / 2 + 1/2, decoded");
    }
    if (are_too_long(frame)) {
        shorten(frame);
        io__info(log, path, "normals: longer than 1, shortened to that");
    }
    if (!request->flip_normals[0] && !request->flip_normals[1]
        && !request->flip_normals[2])
        return;
    for (int32_t y = 0; y < frame->desc.height; y++)
        for (int32_t x = 0; x < frame->desc.width; x++)
            for (int32_t c = 0; c < 3; c++)
                if (request->flip_normals[c]) {
                    float *component = crv_image_at(&frame->normals, x, y, c);
                    *component = -*component;
                }
}

static void turn_all(io_frame *frame, const double m[9])
{
    for (int32_t y = 0; y < frame->desc.height; y++)
        for (int32_t x = 0; x < frame->desc.width; x++) {
            float n[3];
            io__load_normal(&frame->normals, x, y, n);
            for (int32_t c = 0; c < 3; c++)
                *crv_image_at(&frame->normals, x, y, c) =
                    (float)(m[3 * c] * (double)n[0] + m[3 * c + 1] * (double)n[1]
                            + m[3 * c + 2] * (double)n[2]);
        }
}

bool io__is_rotation(const double m[9])
{
    const double determinant = m[0] * (m[4] * m[8] - m[5] * m[7])
                               - m[1] * (m[3] * m[8] - m[5] * m[6])
                               + m[2] * (m[3] * m[7] - m[4] * m[6]);
    return determinant > 0.0;
}

void io__apply_reading(const io__reading *reading, io_frame *frame)
{
    static const double mirror[9] = {1, 0, 0, 0, 1, 0, 0, 0, -1};
    double turn[9];
    memcpy(turn, reading->turn, sizeof turn);
    frame->has_normals = true;
    frame->reading = reading->id;
    frame->reading_decided = reading->decided;
    frame->normal_space = CRV_NORMAL_VIEW;
    if (reading->id == IO__READ_VIEW)
        return;
    if (reading->id == IO__READ_MIRRORED || !io__is_rotation(turn)) {
        if (reading->id != IO__READ_MIRRORED) {
            turn_all(frame, turn);
            return;
        }
        turn_all(frame, mirror);
        for (int k = 2; k < 9; k += 3)
            turn[k] = -turn[k];
    }
    frame->normal_space = CRV_NORMAL_WORLD;
    for (int i = 0; i < 9; i++)
        frame->camera.world_to_view[i] = (float)turn[i];
}
