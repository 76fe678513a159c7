/* SPDX-License-Identifier: MIT */
/*
 * normals.c: finds the space of given normals by comparing them with the normals
 * that depth implies, which are in view space.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"
#include "normals.h"
#include "pairs.h"

enum { FEWEST_PAIRS = 50 }; /* fewer say nothing */

static const double degree = 3.14159265358979323846 / 180.0;
static const double worst_deviation = 15.0; /* degrees; beyond it the normals are noise */

/* Whether nearly all normals look like n / 2 + 1/2. A scene whose unit normals are all in
 * the positive octant does not: their length is 1 already. */
static bool looks_encoded(const io_frame *frame)
{
    const int32_t step = io__sampling_step(frame);
    size_t seen = 0, encoded = 0;
    for (int32_t y = step / 2; y < frame->desc.height; y += step)
        for (int32_t x = step / 2; x < frame->desc.width; x += step) {
            float n[3];
            io__load_normal(&frame->normals, x, y, n);
            const double plain = io__length(n);
            if (!isfinite(plain) || plain < 1e-3)
                continue;
            const float centred[3] = {2.0f * n[0] - 1.0f, 2.0f * n[1] - 1.0f,
                                      2.0f * n[2] - 1.0f};
            const bool inside = fminf(n[0], fminf(n[1], n[2])) >= -1e-3f
                                && fmaxf(n[0], fmaxf(n[1], n[2])) <= 1.001f;
            const double error = fabs(io__length(centred) - 1.0);
            seen++;
            encoded += inside && error < 0.05 && error < fabs(plain - 1.0);
        }
    return seen >= 8 && (double)encoded > 0.9 * (double)seen;
}

static void decode(io_frame *frame)
{
    for (int32_t y = 0; y < frame->desc.height; y++)
        for (int32_t x = 0; x < frame->desc.width; x++) {
            float n[3];
            io__load_normal(&frame->normals, x, y, n);
            const double length = io__length(n);
            const bool nothing = !isfinite(length) || length < 1e-3;
            for (int32_t c = 0; c < 3; c++)
                *crv_image_at(&frame->normals, x, y, c) =
                    nothing ? 0.0f : 2.0f * n[c] - 1.0f;
        }
}

static void negate_z(io_frame *frame)
{
    for (int32_t y = 0; y < frame->desc.height; y++)
        for (int32_t x = 0; x < frame->desc.width; x++) {
            float *z = crv_image_at(&frame->normals, x, y, 2);
            *z = -*z;
        }
}

/* One reading of the given normals. */
typedef struct candidate {
    const char *text;
    crv_normal_space space;
    bool possible, mirrored;
    double rotation[9];
    double deviation; /* degrees, median */
} candidate;

enum { AS_VIEW, FROM_METADATA, FITTED, MIRRORED, CANDIDATES };

/* In degrees: what a reading may lack of 9/10 of the best, and still be taken. */
static const double allowed[CANDIDATES] = {0.2, 2.0, 0.0, 0.0};

static bool is_near(const candidate *c, int i, double best)
{
    return c[i].possible && c[i].deviation <= 1.1 * best + allowed[i];
}

/*
 * Whether choose() takes one of the readings before the fits, whatever those would find:
 * a better fit can only lower the bar, which the first of them then must clear by its
 * allowance alone. Fitting takes longer than reading the file.
 */
static bool is_settled(const candidate c[CANDIDATES])
{
    const double bar = fmin(c[AS_VIEW].possible ? c[AS_VIEW].deviation : DBL_MAX,
                            c[FROM_METADATA].deviation);
    if (c[AS_VIEW].possible && c[AS_VIEW].deviation <= allowed[AS_VIEW])
        return true;
    return c[FROM_METADATA].possible
           && c[FROM_METADATA].deviation <= allowed[FROM_METADATA]
           && !is_near(c, AS_VIEW, bar);
}

static void try_all(const io_frame *frame, const io__normal_pairs *pairs, bool try_view,
                    bool has_rotation, candidate c[CANDIDATES])
{
    const candidate all[CANDIDATES] = {
        {"view space", CRV_NORMAL_VIEW, try_view, false, {1, 0, 0, 0, 1, 0, 0, 0, 1}, 0},
        {"world space, rotation from the camera's metadata",
         CRV_NORMAL_WORLD,
         has_rotation,
         false,
         {0},
         0},
        {"world space, rotation found from depth", CRV_NORMAL_WORLD, true, false, {0}, 0},
        {"left-handed space, mirrored, rotation found from depth",
         CRV_NORMAL_WORLD,
         true,
         true,
         {0},
         0}};
    memcpy(c, all, sizeof all);
    for (int i = 0; i < 9; i++)
        c[FROM_METADATA].rotation[i] = (double)frame->camera.world_to_view[i];
    for (int i = 0; i < CANDIDATES; i++) {
        if (i >= FITTED && c[i].possible)
            c[i].possible =
                !is_settled(c) && !io__normal_fit(pairs, c[i].mirrored, c[i].rotation);
        if (!c[i].possible)
            continue;
        const double angle = io__normal_deviation(pairs, c[i].mirrored, c[i].rotation);
        c[i].deviation = angle / degree;
        c[i].possible = angle >= 0.0;
    }
    /* Where all normals lie in a plane a mirror image fits as well; it must be far better
     * to be believed. */
    for (int i = 0; i < MIRRORED; i++)
        if (c[i].possible
            && c[MIRRORED].deviation > fmin(0.5 * c[i].deviation, c[i].deviation - 2.0))
            c[MIRRORED].possible = false;
}

/* The first reading that is about as good as the best: a fit is always a little better
 * than the truth. */
static const candidate *choose(const candidate c[CANDIDATES])
{
    double best = DBL_MAX;
    for (int i = 0; i < CANDIDATES; i++)
        if (c[i].possible)
            best = fmin(best, c[i].deviation);
    for (int i = 0; i < CANDIDATES; i++)
        if (is_near(c, i, best))
            return &c[i];
    return NULL;
}

static void apply(const candidate *chosen, io_frame *frame)
{
    if (chosen->mirrored)
        negate_z(frame);
    frame->has_normals = true;
    frame->normal_space = chosen->space;
    if (chosen->space == CRV_NORMAL_WORLD)
        for (int i = 0; i < 9; i++)
            frame->camera.world_to_view[i] = (float)chosen->rotation[i];
}

/* What to do if depth cannot tell. */
static void settle_without_pairs(const char *path, bool has_rotation, io_frame *frame,
                                 const crv_logger *log)
{
    frame->has_normals = has_rotation;
    frame->normal_space = CRV_NORMAL_WORLD;
    if (has_rotation)
        io__info(log, path,
                 "normals: taken as world space, rotation from the camera's "
                 "metadata (too few pixels to check)");
    else
        io__warn(log, path,
                 "normals are ignored: too few smooth pixels to find the space that they "
                 "are in; say --normal-space view if that is what they are");
}

void io__settle_normals(const char *path, io_normal_space space, bool has_rotation,
                        io_frame *frame, const crv_logger *log)
{
    io__pair_list pairs;
    if (looks_encoded(frame)) {
        decode(frame);
        io__info(log, path, "normals: stored as n / 2 + 1/2, decoded");
    }
    if (space == IO_NORMALS_VIEW) {
        frame->has_normals = true;
        frame->normal_space = CRV_NORMAL_VIEW;
        return;
    }
    io__find_pairs(frame, &pairs);
    if (pairs.count < FEWEST_PAIRS) {
        settle_without_pairs(path, has_rotation, frame, log);
        io__free_pairs(&pairs);
        return;
    }
    const io__normal_pairs view = {(const float(*)[3])pairs.from,
                                   (const float(*)[3])pairs.to, pairs.count};
    candidate candidates[CANDIDATES];
    try_all(frame, &view, space == IO_NORMALS_FIND, has_rotation, candidates);
    const candidate *chosen = choose(candidates);
    io__free_pairs(&pairs);
    if (!chosen || chosen->deviation > worst_deviation) {
        io__warn(log, path,
                 "normals are ignored: whatever space they are taken in, they do not "
                 "agree with depth (median deviation %.0f degrees); check the field of "
                 "view and the depth's encoding",
                 chosen ? chosen->deviation : 180.0);
        return;
    }
    apply(chosen, frame);
    io__info(log, path, "normals: %s (median deviation %.1f degrees)", chosen->text,
             chosen->deviation);
}
