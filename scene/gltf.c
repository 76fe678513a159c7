/* SPDX-License-Identifier: MIT */
#include "gltf.h"

#include <stdlib.h>
#include <string.h>

#include "internal.h"

enum { MAX_DEPTH = 512 };

/* Required extensions that are read, or that do not change a shape; "*" at the end stands
 * for anything. */
static const char *const known[] = {"KHR_mesh_quantization",
                                    "EXT_mesh_gpu_instancing",
                                    "KHR_texture_transform",
                                    "KHR_node_visibility",
                                    "KHR_lights_*",
                                    "EXT_lights_*",
                                    "KHR_materials_*",
                                    "EXT_materials_*",
                                    "KHR_texture_*",
                                    "EXT_texture_*",
                                    "MSFT_texture_*",
                                    "KHR_animation_pointer",
                                    "KHR_xmp*",
                                    "KHR_technique*"};

static bool is_known(const char *name)
{
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const size_t length = strcspn(known[i], "*");
        if (strncmp(name, known[i], length) == 0
            && (known[i][length] == '*' || name[length] == '\0'))
            return true;
    }
    return false;
}

static bool check_extensions(gltf *g)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, gltf_member(g->root, "extensionsRequired"))
    {
        const char *name = cJSON_GetStringValue(item);
        if (!name || is_known(name))
            continue;
        const bool packed = strstr(name, "compression") || strstr(name, "meshopt");
        scene_log(g->log, CRV_LOG_ERROR, g->path,
                  "requires the glTF extension %.100s, which is not read; %s", name,
                  packed ? "export it without compression"
                         : "export it without that extension");
        g->failed = true;
        return false;
    }
    return true;
}

static vec3 rotated(const double q[4], vec3 v)
{
    const vec3 axis = v3(q[0], q[1], q[2]);
    const vec3 once = v3_scale(v3_cross(axis, v), 2.0);
    return v3_add(v3_along(v, once, q[3]), v3_cross(axis, once));
}

static transform trs(const double t[3], const double rotation[4], const double s[3])
{
    const double length = sqrt(rotation[0] * rotation[0] + rotation[1] * rotation[1]
                               + rotation[2] * rotation[2] + rotation[3] * rotation[3]);
    double q[4] = {0.0, 0.0, 0.0, 1.0};
    for (int i = 0; i < 4 && length > 0.0; i++)
        q[i] = rotation[i] / length;
    const vec3 x = v3_scale(rotated(q, v3(1, 0, 0)), s[0]);
    const vec3 y = v3_scale(rotated(q, v3(0, 1, 0)), s[1]);
    const vec3 z = v3_scale(rotated(q, v3(0, 0, 1)), s[2]);
    return (transform){{v3(x.x, y.x, z.x), v3(x.y, y.y, z.y), v3(x.z, y.z, z.z)},
                       v3_from_double(t)};
}

static transform own_transform(const cJSON *node)
{
    double m[16], t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    if (gltf_numbers(node, "matrix", 16, m))
        return (transform){
            {v3(m[0], m[4], m[8]), v3(m[1], m[5], m[9]), v3(m[2], m[6], m[10])},
            v3(m[12], m[13], m[14])};
    gltf_numbers(node, "translation", 3, t);
    gltf_numbers(node, "rotation", 4, q);
    gltf_numbers(node, "scale", 3, s);
    return trs(t, q, s);
}

/* A node that is shown, or that a joint is. */
typedef struct node_state {
    int parent; /* -1: none */
    bool seen;  /* its world transform is known */
    bool shown; /* part of the scene, and visible */
} node_state;

typedef struct reader {
    gltf *g;
    import *out;
    node_state *nodes;
    transform *worlds;
    vec3 lower, upper;
    bool only_bounds;
} reader;

static bool find_parents(reader *r)
{
    for (int i = 0; i < r->g->nodes.count; i++)
        r->nodes[i].parent = -1;
    for (int i = 0; i < r->g->nodes.count; i++) {
        const cJSON *child;
        cJSON_ArrayForEach(child, gltf_member(r->g->nodes.item[i], "children"))
        {
            const double index = cJSON_IsNumber(child) ? child->valuedouble : -1.0;
            if (!(index >= 0.0 && index < r->g->nodes.count)
                || r->nodes[(int)index].parent >= 0) {
                gltf_refuse(r->g, "a node has two parents, or a child that is not there");
                return false;
            }
            r->nodes[(int)index].parent = i;
        }
    }
    return true;
}

/* From a root on; no node has two parents, so each is met once. A cycle has no root. */
static void place_node(reader *r, int index, const transform *parent, int depth)
{
    const cJSON *node = r->g->nodes.item[index];
    const cJSON *child;
    const transform own = own_transform(node);
    r->worlds[index] = transform_compose(parent, &own);
    r->nodes[index].seen = true;
    if (depth == MAX_DEPTH) {
        gltf_refuse(r->g, "its nodes are nested deeper than 512");
        return;
    }
    cJSON_ArrayForEach(child, gltf_member(node, "children"))
    {
        place_node(r, (int)child->valuedouble, &r->worlds[index], depth + 1);
    }
}

static void show_node(reader *r, int index)
{
    const cJSON *node = gltf_at(&r->g->nodes, index);
    const cJSON *child;
    const cJSON *visible =
        gltf_member(gltf_extension(node, "KHR_node_visibility"), "visible");
    if (!node || !r->nodes[index].seen || r->nodes[index].shown || cJSON_IsFalse(visible))
        return;
    r->nodes[index].shown = true;
    cJSON_ArrayForEach(child, gltf_member(node, "children"))
    {
        show_node(r, (int)child->valuedouble);
    }
}

/* The default scene, else the first, else all. */
static void show_scene(reader *r)
{
    const cJSON *scenes = gltf_member(r->g->root, "scenes");
    const int chosen = gltf_index(r->g->root, "scene");
    const cJSON *seen = cJSON_GetArrayItem(scenes, chosen >= 0 ? chosen : 0);
    const cJSON *item;
    cJSON_ArrayForEach(item, gltf_member(seen, "nodes"))
    {
        if (cJSON_IsNumber(item) && item->valuedouble >= 0.0
            && item->valuedouble < r->g->nodes.count)
            show_node(r, (int)item->valuedouble);
    }
    for (int i = 0; !seen && i < r->g->nodes.count; i++)
        if (r->nodes[i].parent < 0)
            show_node(r, i);
}

static void add_part(reader *r, gltf_part *p, const transform *t)
{
    if (r->only_bounds)
        mesh_part_bound(&p->part, t, &r->lower, &r->upper);
    else
        mesh_add_part(&r->out->mesh, &p->part, t);
}

/* One attribute of EXT_mesh_gpu_instancing; NULL: not there, or an error line. */
static float *instance_values(gltf *g, const cJSON *attributes, const char *name,
                              int components, size_t *count)
{
    size_t rows = 0;
    const int accessor = gltf_index(attributes, name);
    float *values = accessor < 0 ? NULL : gltf_floats(g, accessor, components, &rows);
    if (values && *count > 0 && rows != *count)
        gltf_refuse(g, "its instances have attributes of several lengths");
    if (values)
        *count = rows;
    return values;
}

static void add_instances(reader *r, gltf_part *p, const cJSON *attributes,
                          const transform *world)
{
    size_t count = 0;
    float *t = instance_values(r->g, attributes, "TRANSLATION", 3, &count);
    float *q = instance_values(r->g, attributes, "ROTATION", 4, &count);
    float *s = instance_values(r->g, attributes, "SCALE", 3, &count);
    for (size_t i = 0; i < count && !r->g->failed && !r->out->mesh.failed; i++) {
        double move[3] = {0, 0, 0}, turn[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
        for (size_t k = 0; k < 3; k++) {
            move[k] = t ? (double)t[3 * i + k] : 0.0;
            scale[k] = s ? (double)s[3 * i + k] : 1.0;
        }
        for (size_t k = 0; q && k < 4; k++)
            turn[k] = (double)q[4 * i + k];
        const transform own = trs(move, turn, scale);
        const transform at = transform_compose(world, &own);
        add_part(r, p, &at);
    }
    free(t);
    free(q);
    free(s);
}

static void add_primitive(reader *r, const cJSON *node, const cJSON *object,
                          const cJSON *primitive, const transform *world)
{
    const cJSON *instancing = gltf_extension(node, "EXT_mesh_gpu_instancing");
    const int skin = gltf_index(node, "skin"),
              material = gltf_index(primitive, "material");
    const double *origin = r->out->mesh.origin;
    gltf_part p;
    int uv_set = 0;
    if (!r->only_bounds && !gltf_set_material(r->g, material, &r->out->mesh, &uv_set))
        return;
    if (!gltf_read_part(r->g, object, primitive, gltf_member(node, "weights"), uv_set,
                        &p))
        return;
    if (skin >= 0) {
        transform moved = transform_identity();
        moved.offset = v3_from_double(origin);
        if (p.part.vertex_count > 0
            && gltf_skin_part(r->g, primitive, skin, r->worlds, origin, &p))
            add_part(r, &p, &moved);
    } else if (instancing) {
        add_instances(r, &p, gltf_member(instancing, "attributes"), world);
    } else {
        add_part(r, &p, world);
    }
    gltf_free_part(&p);
}

static void add_meshes(reader *r)
{
    for (int i = 0; i < r->g->nodes.count; i++) {
        const cJSON *node = r->g->nodes.item[i];
        const cJSON *object = gltf_at(&r->g->meshes, gltf_index(node, "mesh"));
        const cJSON *primitive;
        if (!r->nodes[i].shown || !object)
            continue;
        cJSON_ArrayForEach(primitive, gltf_member(object, "primitives"))
        {
            if (r->g->failed || r->out->mesh.failed)
                return;
            add_primitive(r, node, object, primitive, &r->worlds[i]);
        }
    }
}

static void add_cameras(reader *r)
{
    for (int i = 0; i < r->g->nodes.count; i++) {
        const cJSON *node = r->g->nodes.item[i];
        const cJSON *camera = gltf_at(&r->g->cameras, gltf_index(node, "camera"));
        if (!r->nodes[i].shown || !camera)
            continue;
        const cJSON *lens = gltf_member(camera, "perspective");
        const cJSON *box = gltf_member(camera, "orthographic");
        const double ymag = gltf_number(box, "ymag", 1.0);
        const double aspect = box ? fabs(gltf_number(box, "xmag", 0.0) / ymag)
                                  : gltf_number(lens, "aspectRatio", 0.0);
        const scene_camera like = {
            .view = {.projection = box ? CRV_ORTHOGRAPHIC : CRV_PERSPECTIVE,
                     .vfov_rad = (float)gltf_number(lens, "yfov", 0.0),
                     .view_height = (float)(2.0 * fabs(ymag))},
            .aspect = isfinite(aspect) ? (float)aspect : 0.0f,
        };
        const char *name = gltf_text(node, "name");
        const transform *t = &r->worlds[i];
        const vec3 back = transform_direction(t, v3(0, 0, 1));
        const vec3 up = transform_direction(t, v3(0, 1, 0));
        if (!import_add_camera(r->out, name && name[0] ? name : gltf_text(camera, "name"),
                               &like, t->offset, back, up))
            gltf_refuse(r->g, "there is no memory for it");
    }
}

static void read_scene(reader *r)
{
    const transform identity = transform_identity();
    if (!find_parents(r))
        return;
    for (int i = 0; i < r->g->nodes.count && !r->g->failed; i++)
        if (r->nodes[i].parent < 0)
            place_node(r, i, &identity, 0);
    if (r->g->failed)
        return;
    show_scene(r);
    r->only_bounds = true;
    add_meshes(r);
    mesh_choose_origin(&r->out->mesh, r->lower, r->upper);
    r->only_bounds = false;
    add_meshes(r);
    add_cameras(r);
}

int gltf_read(const char *path, import *out, const crv_logger *log)
{
    gltf g;
    reader r = {.g = &g,
                .out = out,
                .lower = v3(INFINITY, INFINITY, INFINITY),
                .upper = v3(-INFINITY, -INFINITY, -INFINITY)};
    if (gltf_open(path, log, &g) && check_extensions(&g) && gltf_read_buffers(&g)) {
        r.nodes = calloc((size_t)g.nodes.count + 1, sizeof *r.nodes);
        r.worlds = calloc((size_t)g.nodes.count + 1, sizeof *r.worlds);
        if (r.nodes && r.worlds)
            read_scene(&r);
        else
            gltf_refuse(&g, "there is no memory for it");
    }
    const int result = g.failed ? -1 : 0;
    free(r.nodes);
    free(r.worlds);
    gltf_close(&g);
    return result;
}
