/* SPDX-License-Identifier: MIT */
#include "depth.h"

#include <math.h>
#include <string.h>

#include "pairs.h"

static bool has_half_bits(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return (bits & 0x1fffu) == 0;
}

static void count_largest(float value, bool bare, io__depth_facts *facts, size_t *bares)
{
    if (value > facts->largest || facts->count == 0) {
        facts->largest = value;
        facts->at_largest = 0;
        *bares = 0;
    }
    if (value == facts->largest) {
        facts->at_largest++;
        *bares += bare;
    }
}

static void count_others(const crv_image *depth, float background, io__depth_facts *facts)
{
    for (int32_t y = 0; y < depth->height; y++)
        for (int32_t x = 0; x < depth->width; x++) {
            const float value = *crv_image_at(depth, x, y, 0);
            if (!isfinite(value) || value >= background || value >= facts->largest)
                continue;
            facts->near_by += 1.5f * value >= facts->largest;
            facts->behind += 8.0f * value >= facts->largest;
        }
}

io__depth_facts io__depth_facts_of(const crv_image *depth, const crv_image *normals,
                                   float background)
{
    io__depth_facts facts = {.smallest = INFINITY};
    size_t bares = 0, odd = 0;
    for (int32_t y = 0; y < depth->height; y++)
        for (int32_t x = 0; x < depth->width; x++) {
            const float value = *crv_image_at(depth, x, y, 0);
            float n[3] = {1.0f, 0.0f, 0.0f};
            if (!isfinite(value) || value >= background)
                continue;
            if (normals && value >= facts.largest)
                io__load_normal(normals, x, y, n);
            const double length = io__length(n);
            count_largest(value, !isfinite(length) || length < 1e-3, &facts, &bares);
            if (value < facts.smallest)
                facts.at_smallest = 0;
            facts.smallest = fminf(facts.smallest, value);
            facts.at_smallest += !(value > facts.smallest);
            odd += !has_half_bits(value);
            facts.count++;
        }
    facts.bare_at_largest = normals && bares > 0 && 10 * bares >= 9 * facts.at_largest;
    count_others(depth, background, &facts);
    /* A few whole numbers are halves by chance. */
    facts.is_half = facts.count >= 64 && odd == 0 && facts.smallest < facts.largest;
    return facts;
}

bool io__largest_is_sky(const io__depth_facts *facts)
{
    /* Beyond which only numbers lie that stand for nothing: the largest half float. */
    static const float largest_half = 65504.0f;
    const size_t enough = facts->count / 200 > 16 ? facts->count / 200 : 16;
    const bool many = facts->at_largest >= enough;
    if (!many || !(facts->largest > 0.0f))
        return false;
    if (facts->bare_at_largest)
        return true;
    if (facts->at_largest == facts->count)
        return facts->largest >= largest_half;
    /* Without normals a wall that is seen from in front may hold one depth, too: sky is
     * far behind everything but what a filter mixed with it. */
    const double tens = log10((double)facts->largest);
    const bool is_usual =
        facts->largest >= largest_half || fabs(tens - round(tens)) < 1e-6;
    return 20 * (is_usual ? facts->near_by : facts->behind) < facts->at_largest;
}
