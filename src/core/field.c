/* SPDX-License-Identifier: MIT */
#include "core/field.h"

/* The index of a texel, repeated or clamped. */
static int32_t wrapped(int64_t i, int32_t size, crv_wrap wrap)
{
    if (wrap == CRV_WRAP_REPEAT)
        return (int32_t)((i % size + size) % size);
    return i < 0 ? 0 : i >= size ? size - 1 : (int32_t)i;
}

float crv__height_at(const crv__field *field, float u, float v, float *by_u, float *by_v)
{
    const crv__plane *map = &field->height;
    const double x = (double)u * map->width - 0.5, y = (double)v * map->height - 0.5;
    *by_u = *by_v = 0;
    if (!(fabs(x) < 1e15 && fabs(y) < 1e15))
        return 0;
    const int64_t column = (int64_t)floor(x), row = (int64_t)floor(y);
    const float s = (float)(x - (double)column), t = (float)(y - (double)row);
    const int32_t x0 = wrapped(column, map->width, field->wrap);
    const int32_t x1 = wrapped(column + 1, map->width, field->wrap);
    const int32_t y0 = wrapped(row, map->height, field->wrap);
    const int32_t y1 = wrapped(row + 1, map->height, field->wrap);
    const float a = *crv__plane_at(map, x0, y0), b = *crv__plane_at(map, x1, y0);
    const float c = *crv__plane_at(map, x0, y1), d = *crv__plane_at(map, x1, y1);
    const float top = a + s * (b - a), bottom = c + s * (d - c);
    *by_u = ((b - a) + t * ((d - c) - (b - a))) * (float)map->width * field->scale;
    *by_v = (bottom - top) * (float)map->height * field->scale;
    return (top + t * (bottom - top)) * field->scale;
}

crv__local_frame crv__local_frame_at(const crv__field *field, crv__vec3 facing, int32_t x,
                                     int32_t y)
{
    crv__local_frame local = {.u = *crv__plane_at(&field->uv[0], x, y),
                              .v = *crv__plane_at(&field->uv[1], x, y)};
    const crv__vec3 a = crv__vec3_at(field->tangent, x, y);
    const crv__vec3 b = crv__vec3_at(field->bitangent, x, y);
    const float aa = crv__dot(a, a), ab = crv__dot(a, b), bb = crv__dot(b, b);
    const float determinant = aa * bb - ab * ab;
    /* NaN fails too. A frame whose axes are parallel spans nothing. */
    if (!(determinant > 1e-6f * aa * bb) || !isfinite(local.u) || !isfinite(local.v))
        return local;
    crv__vec3 n = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    float scale = 1 / sqrtf(crv__dot(n, n));
    if (crv__dot(n, facing) < 0)
        scale = -scale;
    local.normal = (crv__vec3){n.x * scale, n.y * scale, n.z * scale};
    local.dual_u = (crv__vec3){(bb * a.x - ab * b.x) / determinant,
                               (bb * a.y - ab * b.y) / determinant,
                               (bb * a.z - ab * b.z) / determinant};
    local.dual_v = (crv__vec3){(aa * b.x - ab * a.x) / determinant,
                               (aa * b.y - ab * a.y) / determinant,
                               (aa * b.z - ab * a.z) / determinant};
    float by_u, by_v;
    local.height = crv__height_at(field, local.u, local.v, &by_u, &by_v);
    local.valid = 1;
    return local;
}

float crv__field_value(const crv__field *field, const crv__local_frame *local,
                       crv__vec3 P, crv__vec3 p, crv__vec3 *gradient)
{
    *gradient = (crv__vec3){0, 0, 0};
    if (field->implicit) {
        float out[3] = {0, 0, 0};
        const float value =
            field->implicit(field->user, (const float[3]){p.x, p.y, p.z}, out);
        *gradient = (crv__vec3){out[0], out[1], out[2]};
        return value;
    }
    if (!local->valid)
        return 1;
    const crv__vec3 offset = crv__sub(p, P);
    float by_u, by_v;
    const float height =
        crv__height_at(field, local->u + crv__dot(offset, local->dual_u),
                       local->v + crv__dot(offset, local->dual_v), &by_u, &by_v);
    const crv__vec3 n = local->normal;
    *gradient = (crv__vec3){n.x - by_u * local->dual_u.x - by_v * local->dual_v.x,
                            n.y - by_u * local->dual_u.y - by_v * local->dual_v.y,
                            n.z - by_u * local->dual_u.z - by_v * local->dual_v.z};
    return local->height + crv__dot(offset, n) - height;
}
