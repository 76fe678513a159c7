/* SPDX-License-Identifier: MIT */
#include "shapes.h"

place place_at(double x, double y, double z)
{
    return (place){v3(x, y, z), v3(1, 0, 0), v3(0, 1, 0), v3(0, 0, 1)};
}

vec3 place_direction(const place *at, vec3 local)
{
    return v3_along(v3_along(v3_scale(at->x, local.x), at->y, local.y), at->z, local.z);
}

vec3 place_point(const place *at, vec3 local)
{
    return v3_add(at->origin, place_direction(at, local));
}

place place_moved(const place *base, vec3 at)
{
    return (place){place_point(base, at), base->x, base->y, base->z};
}

place place_turned(const place *base, vec3 at, double yaw_rad)
{
    double c = cos(yaw_rad), s = sin(yaw_rad);
    return (place){place_point(base, at), place_direction(base, v3(c, 0, -s)), base->y,
                   place_direction(base, v3(s, 0, c))};
}

static uint32_t add_vertex(mesh *m, const place *at, vec3 p, vec3 normal)
{
    return mesh_add_vertex(m, place_point(at, p), place_direction(at, normal));
}

/* The plane is that of the two axes which the normal is least along. */
static uint32_t add_flat_vertex(mesh *m, const place *at, vec3 p, vec3 normal)
{
    uint32_t vertex = add_vertex(m, at, p, normal);
    double x = fabs(normal.x), y = fabs(normal.y), z = fabs(normal.z);
    double u = normal.z >= 0.0 ? p.x : -p.x, v = -p.y;
    if (y >= x && y >= z) {
        u = p.x;
        v = normal.y >= 0.0 ? p.z : -p.z;
    } else if (x >= z) {
        u = normal.x >= 0.0 ? -p.z : p.z;
    }
    mesh_set_uv(m, vertex, u / SHAPE_TILE, v / SHAPE_TILE);
    return vertex;
}

void shape_triangle(mesh *m, const place *at, vec3 a, vec3 b, vec3 c)
{
    vec3 normal = v3_cross(v3_sub(b, a), v3_sub(c, a));
    uint32_t first = add_flat_vertex(m, at, a, normal);
    add_flat_vertex(m, at, b, normal);
    add_flat_vertex(m, at, c, normal);
    mesh_add_triangle(m, first, first + 1, first + 2);
}

void shape_quad(mesh *m, const place *at, vec3 a, vec3 b, vec3 c, vec3 d)
{
    vec3 normal = v3_cross(v3_sub(c, a), v3_sub(d, b));
    uint32_t first = add_flat_vertex(m, at, a, normal);
    add_flat_vertex(m, at, b, normal);
    add_flat_vertex(m, at, c, normal);
    add_flat_vertex(m, at, d, normal);
    mesh_add_triangle(m, first, first + 1, first + 2);
    mesh_add_triangle(m, first, first + 2, first + 3);
}

/* A quad of a convex solid, wound so that it faces away from the solid's centre. */
static void add_outward_quad(mesh *m, const place *at, vec3 centre, const vec3 p[4])
{
    vec3 normal = v3_cross(v3_sub(p[2], p[0]), v3_sub(p[3], p[1]));
    vec3 outward = v3_sub(v3_scale(v3_add(p[0], p[2]), 0.5), centre);
    if (v3_dot(normal, outward) >= 0.0)
        shape_quad(m, at, p[0], p[1], p[2], p[3]);
    else
        shape_quad(m, at, p[3], p[2], p[1], p[0]);
}

/* The corner of the face along `face` of a box of half size h about the origin: pulled in
 * by the bevel along the other two axes. signs: one bit an axis. */
static vec3 box_corner(vec3 h, double bevel, int face, int signs)
{
    double p[3] = {h.x, h.y, h.z};
    for (int axis = 0; axis < 3; axis++) {
        p[axis] -= axis == face ? 0.0 : bevel;
        if (!(signs >> axis & 1))
            p[axis] = -p[axis];
    }
    return v3(p[0], p[1], p[2]);
}

static void add_box_faces(mesh *m, const place *at, vec3 h, double bevel)
{
    for (int face = 0; face < 3; face++) {
        int a = 1 << (face + 1) % 3, b = 1 << (face + 2) % 3;
        for (int side = 0; side <= 1; side++) {
            int s = side << face;
            const vec3 p[4] = {
                box_corner(h, bevel, face, s), box_corner(h, bevel, face, s | a),
                box_corner(h, bevel, face, s | a | b), box_corner(h, bevel, face, s | b)};
            add_outward_quad(m, at, v3(0, 0, 0), p);
        }
    }
}

static void add_box_bevels(mesh *m, const place *at, vec3 h, double bevel)
{
    for (int along = 0; along < 3; along++) {
        int f = (along + 1) % 3, g = (along + 2) % 3;
        for (int edge = 0; edge < 4; edge++) {
            int s = (edge & 1) << f | (edge >> 1) << g, t = s | 1 << along;
            const vec3 p[4] = {box_corner(h, bevel, f, s), box_corner(h, bevel, f, t),
                               box_corner(h, bevel, g, t), box_corner(h, bevel, g, s)};
            add_outward_quad(m, at, v3(0, 0, 0), p);
        }
    }
    for (int s = 0; s < 8; s++) {
        /* An odd number of minus signs mirrors the corner. */
        bool mirrored = ((s & 1) + (s >> 1 & 1) + (s >> 2 & 1)) % 2 == 0;
        shape_triangle(m, at, box_corner(h, bevel, 0, s),
                       box_corner(h, bevel, mirrored ? 2 : 1, s),
                       box_corner(h, bevel, mirrored ? 1 : 2, s));
    }
}

void shape_box(mesh *m, const place *at, vec3 lower, vec3 upper, double bevel)
{
    vec3 half = v3_scale(v3_sub(upper, lower), 0.5);
    place centred = place_moved(at, v3_add(lower, half));
    add_box_faces(m, &centred, half, bevel);
    if (bevel > 0.0)
        add_box_bevels(m, &centred, half, bevel);
}

/* Two triangles between rows of vertices; `next` is counter-clockwise of `here`. */
static void add_cell(mesh *m, uint32_t here, uint32_t next, uint32_t here_above,
                     uint32_t next_above)
{
    mesh_add_triangle(m, here, next, next_above);
    mesh_add_triangle(m, here, next_above, here_above);
}

void shape_sphere(mesh *m, const place *at, vec3 centre, double radius, int segments)
{
    int rows = segments / 2;
    uint32_t first = (uint32_t)m->vertex_count;
    for (int row = 0; row <= rows; row++) {
        double latitude = SCENE_PI * (row / (double)rows - 0.5);
        /* The first column once more at the end, where the map does. */
        for (int i = 0; i <= segments; i++) {
            double angle = 2.0 * SCENE_PI * (i % segments) / segments;
            vec3 n = v3(cos(latitude) * cos(angle), sin(latitude),
                        -cos(latitude) * sin(angle));
            /* cos(pi / 2) is not quite 0: the poles would be tiny holes. */
            if (row == 0 || row == rows)
                n = v3(0.0, row ? 1.0 : -1.0, 0.0);
            mesh_set_uv(m, add_vertex(m, at, v3_along(centre, n, radius), n),
                        i / (double)segments, 1.0 - row / (double)rows);
        }
    }
    for (int row = 0; row < rows; row++) {
        for (int i = 0; i < segments; i++) {
            uint32_t step = (uint32_t)segments + 1;
            uint32_t here = first + (uint32_t)row * step + (uint32_t)i;
            uint32_t next = here + 1;
            /* The rows at the poles are points: one triangle of the two is left. */
            if (row > 0)
                mesh_add_triangle(m, here, next, next + step);
            if (row + 1 < rows)
                mesh_add_triangle(m, here, next + step, here + step);
            else
                continue;
        }
    }
}

/* The outward normal (along the radius, along y) of a profile's segment. */
static void segment_normal(const profile_point *p, double normal[2])
{
    double dr = p[1].radius - p[0].radius, dy = p[1].y - p[0].y;
    double length = sqrt(dr * dr + dy * dy);
    normal[0] = dy / length;
    normal[1] = -dr / length;
}

static uint32_t add_lathe_ring(mesh *m, const place *at, const profile_point *p,
                               const double normal[2], int segments)
{
    uint32_t first = (uint32_t)m->vertex_count;
    for (int i = 0; i < segments; i++) {
        double c = cos(2.0 * SCENE_PI * i / segments);
        double s = sin(2.0 * SCENE_PI * i / segments);
        add_vertex(m, at, v3(p->radius * c, p->y, -p->radius * s),
                   v3(normal[0] * c, normal[1], -normal[0] * s));
    }
    return first;
}

/* The normal at an end of a segment: shared with the neighbouring one where smooth. */
static void end_normal(const double own[2], const profile_point *neighbour, bool shared,
                       double out[2])
{
    double other[2] = {0.0, 0.0};
    if (shared)
        segment_normal(neighbour, other);
    out[0] = own[0] + other[0];
    out[1] = own[1] + other[1];
}

void shape_lathe(mesh *m, const place *at, const profile_point *profile, int count,
                 int segments)
{
    for (int k = 0; k + 1 < count; k++) {
        const profile_point *p = profile + k;
        double own[2], low[2], high[2];
        segment_normal(p, own);
        end_normal(own, p - 1, k > 0 && !p[0].sharp, low);
        end_normal(own, p + 1, k + 2 < count && !p[1].sharp, high);
        const uint32_t below = add_lathe_ring(m, at, p, low, segments);
        const uint32_t above = add_lathe_ring(m, at, p + 1, high, segments);
        for (uint32_t i = 0; i < (uint32_t)segments; i++) {
            uint32_t next = (i + 1) % (uint32_t)segments;
            if (p[0].radius > 0.0)
                mesh_add_triangle(m, below + i, below + next, above + next);
            if (p[1].radius > 0.0)
                mesh_add_triangle(m, below + i, above + next, above + i);
        }
    }
}

/* The cross-section of a fluted shaft of radius 1: flutes are arcs, `steps` chords each,
 * between narrow fillets. t in [0, 1) along one flute with its fillet. */
static void flute_point(int flute, int flutes, double t, double point[2],
                        double normal[2])
{
    const double fillet = 0.16, depth = 0.42; /* shares of a flute's width */
    double pitch = 2.0 * SCENE_PI / flutes;
    double across = (t - 0.5) * 2.0; /* -1 to 1 over the hollow */
    double angle = pitch * (flute + fillet + (1.0 - fillet) * t);
    double hollow = depth * pitch * (1.0 - across * across);
    double slope = 2.0 * depth * across * 2.0 / (1.0 - fillet);
    double c = cos(angle), s = sin(angle), r = 1.0 - hollow;
    point[0] = r * c;
    point[1] = r * s;
    /* The gradient of (radius - r(angle)) in polar coordinates. */
    normal[0] = c + slope / r * s;
    normal[1] = s - slope / r * c;
}

static void add_shaft_strip(mesh *m, const place *at, const double a[2],
                            const double na[2], const double b[2], const double nb[2],
                            const double radius[2], double height)
{
    double lean = (radius[0] - radius[1]) / height;
    uint32_t first = (uint32_t)m->vertex_count;
    for (int end = 0; end < 2; end++) {
        double r = radius[end], y = end * height;
        add_vertex(m, at, v3(r * a[0], y, -r * a[1]), v3(na[0], lean, -na[1]));
        add_vertex(m, at, v3(r * b[0], y, -r * b[1]), v3(nb[0], lean, -nb[1]));
    }
    add_cell(m, first, first + 1, first + 2, first + 3);
    shape_triangle(m, at, v3(0, 0, 0), v3(radius[0] * b[0], 0, -radius[0] * b[1]),
                   v3(radius[0] * a[0], 0, -radius[0] * a[1]));
    shape_triangle(m, at, v3(0, height, 0),
                   v3(radius[1] * a[0], height, -radius[1] * a[1]),
                   v3(radius[1] * b[0], height, -radius[1] * b[1]));
}

void shape_fluted_shaft(mesh *m, const place *at, double bottom_radius, double top_radius,
                        double height, int flutes)
{
    enum { STEPS = 8 };
    const double radius[2] = {bottom_radius, top_radius};
    for (int flute = 0; flute < flutes; flute++) {
        double a[2], na[2], b[2], nb[2], last[2];
        flute_point(flute, flutes, 0.0, a, na);
        for (int step = 1; step <= STEPS; step++) {
            flute_point(flute, flutes, step / (double)STEPS, b, nb);
            add_shaft_strip(m, at, a, na, b, nb, radius, height);
            for (int i = 0; i < 2; i++) {
                a[i] = b[i];
                na[i] = nb[i];
            }
        }
        flute_point(flute + 1, flutes, 0.0, last, nb);
        add_shaft_strip(m, at, a, a, last, last, radius, height);
    }
}

/* A direction that is not along v, made perpendicular to it. */
static vec3 any_perpendicular(vec3 v)
{
    vec3 other = fabs(v.y) < 0.9 ? v3(0, 1, 0) : v3(1, 0, 0);
    return v3_normalise(v3_cross(v, other));
}

void shape_tube(mesh *m, const place *at, const vec3 *points, int count, double radius,
                int segments)
{
    vec3 side = v3(0, 0, 0), along = v3(0, 0, 0);
    uint32_t step = (uint32_t)segments, ring = 0;
    for (int k = 0; k < count; k++) {
        along = v3_normalise(
            v3_sub(points[k + 1 < count ? k + 1 : k], points[k > 0 ? k - 1 : 0]));
        /* Carried on from ring to ring, so that the tube does not twist. */
        side = k == 0 ? any_perpendicular(along)
                      : v3_normalise(v3_along(side, along, -v3_dot(side, along)));
        vec3 other = v3_cross(along, side);
        ring = (uint32_t)m->vertex_count;
        for (int i = 0; i < segments; i++) {
            double angle = 2.0 * SCENE_PI * i / segments;
            vec3 n = v3_along(v3_scale(side, cos(angle)), other, sin(angle));
            add_vertex(m, at, v3_along(points[k], n, radius), n);
        }
        for (uint32_t i = 0; k > 0 && i < step; i++)
            add_cell(m, ring - step + i, ring - step + (i + 1) % step, ring + i,
                     ring + (i + 1) % step);
    }
    for (int end = 0; end < 2; end++) {
        uint32_t rim = end ? ring : ring - step * (uint32_t)(count - 1);
        uint32_t centre = add_vertex(m, at, points[end ? count - 1 : 0], v3(0, 0, 0));
        for (uint32_t i = 0; i < step; i++) {
            uint32_t a = rim + i, b = rim + (i + 1) % step;
            vec3 zero = v3(0, 0, 0);
            if (m->failed)
                return;
            /* Vertices of their own, without a normal: the cap's is taken. */
            mesh_add_triangle(m, centre,
                              mesh_add_vertex(m, mesh_position(m, end ? a : b), zero),
                              mesh_add_vertex(m, mesh_position(m, end ? b : a), zero));
        }
    }
}
