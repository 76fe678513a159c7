/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>

#include "depth.h"
#include "trial.h"

/* The encodings that are tried. Only the ratio of far to near matters to directions. */
typedef struct encoding_row {
    crv_depth_encoding encoding;
    float low, high;     /* the range of numbers that it can hold */
    float far_values[6]; /* near is 1, for logarithmic 0; 0 ends the list */
    const char *text;
} encoding_row;

static const encoding_row encoding_rows[] = {
    {.encoding = CRV_DEPTH_PLANAR,
     .low = 0.0f,
     .high = INFINITY,
     .far_values = {1.0f},
     .text = "depth were planar (along the viewing axis)"},
    {.encoding = CRV_DEPTH_RADIAL,
     .low = 0.0f,
     .high = INFINITY,
     .far_values = {1.0f},
     .text = "depth were radial (distance from the eye)"},
    {.encoding = CRV_DEPTH_DISPARITY,
     .low = 0.0f,
     .high = INFINITY,
     .far_values = {1.0f},
     .text = "depth were disparity (1/distance), or reversed with an infinite far plane"},
    {.encoding = CRV_DEPTH_HARDWARE,
     .low = 0.0f,
     .high = 1.0f,
     .far_values = {10.0f, 100.0f, 1000.0f, 10000.0f, 100000.0f},
     .text = "depth were hardware, far about %g times near"},
    {.encoding = CRV_DEPTH_REVERSED,
     .low = 0.0f,
     .high = 1.0f,
     .far_values = {10.0f, 100.0f, 1000.0f, 10000.0f, 100000.0f},
     .text = "depth were reversed, far about %g times near"},
    {.encoding = CRV_DEPTH_GL,
     .low = -1.0f,
     .high = 1.0f,
     .far_values = {10.0f, 100.0f, 1000.0f, 10000.0f, 100000.0f},
     .text = "depth were gl (-1 to 1), far about %g times near"},
    {.encoding = CRV_DEPTH_NORMALISED,
     .low = 0.0f,
     .high = 1.0f,
     .far_values = {3.0f, 10.0f, 30.0f},
     .text = "depth were normalised (0 at near, 1 at far), far about %g times near"},
    {.encoding = CRV_DEPTH_NORMALISED_REVERSED,
     .low = 0.0f,
     .high = 1.0f,
     .far_values = {10.0f, 1000.0f},
     .text = "depth were normalised-reversed (1 at near, 0 at far), far about %g times "
             "near"},
    {.encoding = CRV_DEPTH_LOGARITHMIC,
     .low = 0.0f,
     .high = 1.0f,
     .far_values = {10.0f, 100.0f, 1000.0f, 10000.0f, 100000.0f},
     .text = "depth were logarithmic with its far plane at about %g"},
};

static bool is_projective(crv_depth_encoding encoding)
{
    return encoding == CRV_DEPTH_DISPARITY || encoding == CRV_DEPTH_HARDWARE
           || encoding == CRV_DEPTH_REVERSED || encoding == CRV_DEPTH_GL;
}

/* Planes are flat in each of the projective ones, so that only the numbers tell them
 * apart: where the sky is, and that depth buffers crowd towards their far plane. */
static bool is_plausible(const io__depth_facts *facts, crv_depth_encoding encoding)
{
    const size_t many = facts->count / 200 > 16 ? facts->count / 200 : 16;
    const bool sky_is_0 = facts->at_smallest >= many && !(fabsf(facts->smallest) > 0.0f);
    const bool sky_is_1 = facts->at_largest >= many && !(facts->largest < 1.0f);
    switch (encoding) {
    case CRV_DEPTH_HARDWARE:
    case CRV_DEPTH_GL:
    case CRV_DEPTH_LOGARITHMIC:
    case CRV_DEPTH_NORMALISED:
        return !sky_is_0 && facts->largest > 0.5f;
    case CRV_DEPTH_DISPARITY:
        return !sky_is_1 && !(facts->smallest > 0.5f && facts->largest <= 1.0f);
    case CRV_DEPTH_REVERSED:
        return !sky_is_1;
    case CRV_DEPTH_NORMALISED_REVERSED:
        return !sky_is_1 && facts->largest > 0.3f;
    default:
        return true;
    }
}

int io__try_encodings(const io__court *c, const io__trial *first, io__trial *better,
                      bool *found)
{
    const io__depth_facts facts = io__depth_facts_of(&c->frame->depth[0], NULL, INFINITY);
    const float background =
        first->format.background > 0.0f ? first->format.background : INFINITY;
    int result = 0;
    for (size_t i = 0; i < sizeof encoding_rows / sizeof encoding_rows[0]; i++) {
        const encoding_row *row = &encoding_rows[i];
        if (row->encoding == first->format.encoding || facts.smallest < row->low
            || facts.largest > row->high)
            continue;
        if (!c->has_normals
            && (!is_plausible(&facts, row->encoding)
                || (*found && is_projective(row->encoding)
                    && is_projective(better->format.encoding))))
            continue;
        for (int k = 0; !result && k < 6 && row->far_values[k] > 0.0f; k++) {
            io__trial t = *first;
            t.format = (crv_depth_format){.encoding = row->encoding,
                                          .z_near = 1.0f,
                                          .z_far = row->far_values[k],
                                          .background = background};
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
            snprintf(t.text, sizeof t.text, row->text, (double)row->far_values[k]);
#pragma GCC diagnostic pop
            result = io__compare_trials(c, first, &t, better, found);
        }
    }
    return result;
}
