/* SPDX-License-Identifier: MIT */
/*
 * A depth buffer holds points and says nothing of thickness. What is made of it here:
 *
 * - Four pixels around a corner that belong to one surface become two triangles.
 *   Neighbours do if their depths differ by a few pixel footprints at most, or lie on the
 *   line that either's other neighbour begins.
 * - Elsewhere every pixel fills its own quarter of the four, continued along its surface,
 *   so that nothing vanishes: neither blades a pixel wide nor the rim of a silhouette.
 * - A curtain closes a silhouette backwards, along the viewing rays: to the surface that
 *   is seen beside it, to the next layer in the same pixel, and by the thickness
 *   at most.
 *   Estimators, too, take what is behind a surface to be filled; without the curtain
 *   light would enter between a box and the floor on which it stands. Only fronts have
 *   curtains: layer 0, and with solids every other layer.
 *
 * Planes are linear over the picture in 1/depth (in -depth where orthographic), called
 * `slope value` below; extrapolation is done there.
 */
#include "reference_sheets.h"

#include <stdlib.h>

/* Steps of fewer pixel footprints are slopes: up to 76 degrees. */
#define SLOPE_FOOTPRINTS 4.0

typedef struct sheet {
    const scene_gbuffer *g;
    const float *depth, *next; /* of this layer and the one behind it, or NULL */
    const scene_axes *axes;
    mesh *mesh;
    uint32_t *vertex;         /* of each pixel */
    unsigned char *joins;     /* of each pixel: bit 0 to the right, bit 1 downwards */
    double radius, thickness; /* scene units */
    bool ortho, has_curtains;
} sheet;

static bool inside(const sheet *s, int32_t x, int32_t y)
{
    return x >= 0 && y >= 0 && x < s->g->desc.width && y < s->g->desc.height;
}

static size_t index_of(const sheet *s, int32_t x, int32_t y)
{
    return (size_t)y * (size_t)s->g->desc.width + (size_t)x;
}

/* 0 if there is none. */
static double depth_at(const sheet *s, int32_t x, int32_t y)
{
    double d = inside(s, x, y) ? (double)s->depth[index_of(s, x, y)] : 0.0;
    return d > 0.0 && isfinite(d) ? d : 0.0;
}

static double to_slope_value(const sheet *s, double depth)
{
    return s->ortho ? -depth : 1.0 / depth;
}

/* 0 if the plane has passed behind the viewer. */
static double from_slope_value(const sheet *s, double value)
{
    if (s->ortho)
        return fmax(-value, 0.0);
    return value > 0.0 ? 1.0 / value : 0.0;
}

/* Depth of the line through two depths, `ahead` of their distance beyond the first. */
static double extended(const sheet *s, double first, double second, double ahead)
{
    double a = to_slope_value(s, first), b = to_slope_value(s, second);
    return from_slope_value(s, a + ahead * (a - b));
}

static bool on_line(const sheet *s, double before, double here, double there,
                    double tolerance)
{
    return before > 0.0
           && fabs(extended(s, here, before, 1.0) - there)
                  <= tolerance + 0.25 * fabs(here - before);
}

static bool belong_together(const sheet *s, int32_t x, int32_t y, int32_t dx, int32_t dy)
{
    const crv_camera *c = &s->g->camera;
    double a = depth_at(s, x, y), b = depth_at(s, x + dx, y + dy);
    if (!(a > 0.0) || !(b > 0.0))
        return false;
    const double tolerance = SLOPE_FOOTPRINTS * (s->ortho ? 1.0 : fmin(a, b))
                             / (double)(dx ? c->fx_px : c->fy_px);
    return fabs(a - b) <= tolerance
           || on_line(s, depth_at(s, x - dx, y - dy), a, b, tolerance)
           || on_line(s, depth_at(s, x + 2 * dx, y + 2 * dy), b, a, tolerance);
}

/* dx, dy: one step in any of four directions. */
static bool joined(const sheet *s, int32_t x, int32_t y, int32_t dx, int32_t dy)
{
    if (!inside(s, x, y) || !inside(s, x + dx, y + dy))
        return false;
    x += dx < 0 ? dx : 0;
    y += dy < 0 ? dy : 0;
    return (s->joins[index_of(s, x, y)] & (dx ? 1 : 2)) != 0;
}

/* The point at this depth before a place of the picture, in pixels from the centre of
 * pixel (0, 0). */
static vec3 point_at(const sheet *s, double x, double y, double depth)
{
    const crv_camera *c = &s->g->camera;
    double scale = s->ortho ? 1.0 : depth;
    double u = (x + 0.5 - (double)c->cx_px) / (double)c->fx_px * scale;
    double v = -(y + 0.5 - (double)c->cy_px) / (double)c->fy_px * scale;
    vec3 p = v3_along(s->axes->eye, s->axes->back, -depth);
    return v3_along(v3_along(p, s->axes->right, u), s->axes->up, v);
}

static uint32_t add_vertex(sheet *s, vec3 p)
{
    return mesh_add_vertex(s->mesh, p, s->axes->back);
}

static void add_quad(sheet *s, vec3 a, vec3 b, vec3 c, vec3 d)
{
    uint32_t i = add_vertex(s, a), j = add_vertex(s, b);
    uint32_t k = add_vertex(s, c), l = add_vertex(s, d);
    mesh_add_triangle(s->mesh, i, j, k);
    mesh_add_triangle(s->mesh, i, k, l);
}

/* A pixel's quarter of a block: depth on the edges towards its two neighbours there, and
 * in the block's middle. depth 0: nothing is there. */
typedef struct quarter {
    int32_t x, y;
    double depth, beside, along, middle; /* beside: to the left or right */
} quarter;

/* Half-way to the neighbour in this direction. */
static double edge_depth(const sheet *s, int32_t x, int32_t y, int32_t dx, int32_t dy)
{
    double here = depth_at(s, x, y), depth = here;
    if (joined(s, x, y, dx, dy))
        return extended(s, here, depth_at(s, x + dx, y + dy), -0.5);
    if (joined(s, x, y, -dx, -dy))
        depth = extended(s, here, depth_at(s, x - dx, y - dy), 0.5);
    return fmin(fmax(depth, fmax(0.5 * here, here - s->radius)),
                fmin(2.0 * here, here + s->radius));
}

static quarter quarter_of(const sheet *s, int32_t x, int32_t y, int32_t dx, int32_t dy)
{
    quarter q = {.x = x, .y = y, .depth = depth_at(s, x, y)};
    if (!(q.depth > 0.0))
        return q;
    q.beside = edge_depth(s, x, y, dx, 0);
    q.along = edge_depth(s, x, y, 0, dy);
    const double middle =
        from_slope_value(s, to_slope_value(s, q.beside) + to_slope_value(s, q.along)
                                - to_slope_value(s, q.depth));
    q.middle = fmin(fmax(middle, 0.5 * q.depth), 2.0 * q.depth);
    return q;
}

/* How far back a curtain reaches from `front` if the neighbour's surface is at
 * `other`, 0: nothing. */
static double curtain_depth(const sheet *s, const quarter *q, double front, double other)
{
    double back = front + s->thickness;
    double next = s->next ? (double)s->next[index_of(s, q->x, q->y)] : 0.0;
    if (next > 0.0 && isfinite(next))
        back = fmin(back, next);
    if (other > 0.0)
        back = fmin(back, other);
    return fmax(back, front);
}

/* Closes the gap between two quarters along the half edge that they share, from the edge
 * (ex, ey) to the middle (mx, my). */
static void close_gap(sheet *s, const quarter *a, const quarter *b, bool beside,
                      const double edge[2], const double middle[2])
{
    const quarter *front =
        b->depth > 0.0 && (!(a->depth > 0.0) || b->depth < a->depth) ? b : a;
    const quarter *other = front == a ? b : a;
    double front_edge = beside ? front->beside : front->along;
    double other_edge = beside ? other->beside : other->along;
    double back_edge = other_edge, back_middle = other->middle;
    int32_t dx = b->x - a->x, dy = b->y - a->y;
    if (!(front->depth > 0.0))
        return;
    if (!joined(s, a->x, a->y, dx, dy)) {
        if (!s->has_curtains)
            return;
        back_edge = curtain_depth(s, front, front_edge, other_edge);
        back_middle = curtain_depth(s, front, front->middle, other->middle);
    }
    add_quad(s, point_at(s, edge[0], edge[1], front_edge),
             point_at(s, middle[0], middle[1], front->middle),
             point_at(s, middle[0], middle[1], back_middle),
             point_at(s, edge[0], edge[1], back_edge));
}

/* The four pixels from (x, y) on, of more than one surface. */
static void add_broken_block(sheet *s, int32_t x, int32_t y)
{
    const double left = x, top = y, middle[2] = {left + 0.5, top + 0.5};
    const double edges[4][2] = {{left + 0.5, top},
                                {left + 0.5, top + 1.0},
                                {left, top + 0.5},
                                {left + 1.0, top + 0.5}};
    quarter q[4]; /* row by row */
    for (int i = 0; i < 4; i++) {
        int32_t column = i & 1, row = i >> 1;
        q[i] = quarter_of(s, x + column, y + row, 1 - 2 * column, 1 - 2 * row);
        if (q[i].depth > 0.0)
            add_quad(s, point_at(s, q[i].x, q[i].y, q[i].depth),
                     point_at(s, middle[0], q[i].y, q[i].beside),
                     point_at(s, middle[0], middle[1], q[i].middle),
                     point_at(s, q[i].x, middle[1], q[i].along));
    }
    close_gap(s, &q[0], &q[1], true, edges[0], middle);
    close_gap(s, &q[2], &q[3], true, edges[1], middle);
    close_gap(s, &q[0], &q[2], false, edges[2], middle);
    close_gap(s, &q[1], &q[3], false, edges[3], middle);
}

static void add_block(sheet *s, int32_t x, int32_t y)
{
    size_t i = index_of(s, x, y), below = index_of(s, x, y + 1);
    if ((s->joins[i] & 3) == 3 && (s->joins[i + 1] & 2) && (s->joins[below] & 1)) {
        mesh_add_triangle(s->mesh, s->vertex[i], s->vertex[below], s->vertex[below + 1]);
        mesh_add_triangle(s->mesh, s->vertex[i], s->vertex[below + 1], s->vertex[i + 1]);
    } else {
        add_broken_block(s, x, y);
    }
}

static void add_sheet(sheet *s)
{
    int32_t width = s->g->desc.width, height = s->g->desc.height;
    mesh_reserve(s->mesh, (size_t)width * (size_t)height,
                 2 * (size_t)width * (size_t)height);
    for (int32_t y = 0; y < height; y++) {
        for (int32_t x = 0; x < width; x++) {
            double depth = depth_at(s, x, y);
            s->joins[index_of(s, x, y)] =
                (unsigned char)((belong_together(s, x, y, 1, 0) ? 1 : 0)
                                | (belong_together(s, x, y, 0, 1) ? 2 : 0));
            if (depth > 0.0)
                s->vertex[index_of(s, x, y)] = add_vertex(s, point_at(s, x, y, depth));
        }
    }
    for (int32_t y = 0; y + 1 < height && !s->mesh->failed; y++)
        for (int32_t x = 0; x + 1 < width; x++)
            add_block(s, x, y);
}

int reference_make_sheets(const scene_gbuffer *g, double radius, double thickness,
                          scene **out, const crv_logger *log)
{
    size_t pixels = (size_t)g->desc.width * (size_t)g->desc.height;
    bool solids = g->desc.layer_kind == CRV_LAYERS_SOLID;
    mesh m = {0};
    scene_axes axes;
    sheet s = {.g = g,
               .axes = &axes,
               .mesh = &m,
               .radius = radius,
               .thickness = thickness * radius,
               .ortho = g->camera.projection == CRV_ORTHOGRAPHIC};
    s.vertex = malloc(pixels * sizeof *s.vertex);
    s.joins = malloc(pixels);
    m.failed = !s.vertex || !s.joins || !scene_axes_of_view(&g->view, g->origin, &axes);
    for (int32_t layer = 0; layer < g->desc.layers && !m.failed; layer++) {
        s.depth = g->depth[layer];
        s.next = layer + 1 < g->desc.layers ? g->depth[layer + 1] : NULL;
        s.has_curtains = layer == 0 || (solids && layer % 2 == 0);
        add_sheet(&s);
    }
    free(s.vertex);
    free(s.joins);
    *out = NULL;
    if (!m.failed && m.triangle_count == 0) {
        mesh_free(&m);
        return 0;
    }
    return scene_from_mesh(&m, "depth layers", out, log);
}
