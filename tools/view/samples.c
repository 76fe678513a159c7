/* SPDX-License-Identifier: MIT */
#include "samples.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Where occluders are put on the view ray of a texel: this share of the way from its
 * point nearest to the surface's to the one nearest to the eye within the radius. */
static const double raised_share = 0.6;
/* What changes a pixel less does not count: a quarter of a step of 255. */
static const float least_change = 1e-3f;

/* The neighbourhood of the pixel as a G-buffer whose result is that pixel alone. */
typedef struct trial {
    crv_gbuffer *gbuffer;
    crv_plan *plan;
    crv_gbuffer_desc desc;
    crv_camera camera;
    float *depth[CRV_MAX_LAYERS]; /* what is tried; of desc's size */
    float *normals;
    int32_t column, row; /* the pixel */
    double radius;
} trial;

typedef struct part {
    int32_t left, top, right, bottom; /* the last two lie outside */
} part;

typedef struct search {
    trial *empty;
    bool is_full; /* the neighbourhood is full of occluders, and parts are emptied */
    float usual;  /* the pixel's value before a part is changed */
    const float *raised;
    bool (*is_stale)(void *user);
    void *user;
    samples *out;
    bool failed;
} search;

static size_t texel_count(const trial *t)
{
    return (size_t)t->desc.width * (size_t)t->desc.height;
}

static void close_trial(trial *t)
{
    crv_plan_destroy(t->plan);
    crv_gbuffer_destroy(t->gbuffer);
    for (int i = 0; i < CRV_MAX_LAYERS; i++)
        free(t->depth[i]);
    free(t->normals);
    *t = (trial){0};
}

/* Copies the neighbourhood; the part of the buffers that lies within `reach`. */
static bool copy_planes(trial *t, const buffers *b, int32_t left, int32_t top)
{
    const size_t count = texel_count(t);
    bool done = true;
    t->normals = malloc(3 * count * sizeof *t->normals);
    for (int32_t i = 0; i < t->desc.layers; i++) {
        t->depth[i] = malloc(count * sizeof *t->depth[i]);
        done = done && t->depth[i];
    }
    if (!done || !t->normals)
        return false;
    for (int32_t y = 0; y < t->desc.height; y++) {
        const size_t from = (size_t)(top + y) * (size_t)b->g.desc.width + (size_t)left;
        const size_t to = (size_t)y * (size_t)t->desc.width;
        const size_t width = (size_t)t->desc.width;
        for (int32_t i = 0; i < t->desc.layers; i++)
            memcpy(t->depth[i] + to, b->g.depth[i] + from, width * sizeof(float));
        memcpy(t->normals + 3 * to, b->g.normals + 3 * from, 3 * width * sizeof(float));
    }
    return true;
}

static bool open_trial(trial *t, crv_context *context, const buffers *b,
                       const crv_options *options, int32_t x, int32_t y, int32_t reach)
{
    const crv_gbuffer_desc *d = &b->g.desc;
    const int32_t column = x + d->guard_left, row = y + d->guard_top;
    const int32_t left = column > reach ? column - reach : 0;
    const int32_t top = row > reach ? row - reach : 0;
    const int32_t right = column < d->width - reach ? column + reach + 1 : d->width;
    const int32_t bottom = row < d->height - reach ? row + reach + 1 : d->height;
    *t = (trial){.desc = *d,
                 .camera = b->g.camera,
                 .column = column - left,
                 .row = row - top,
                 .radius = (double)options->radius};
    t->desc.width = right - left;
    t->desc.height = bottom - top;
    t->desc.guard_left = t->column;
    t->desc.guard_top = t->row;
    t->desc.guard_right = t->desc.width - t->column - 1;
    t->desc.guard_bottom = t->desc.height - t->row - 1;
    /* The pixel keeps its noise. */
    t->desc.origin_x += x;
    t->desc.origin_y += y;
    t->camera.cx_px -= (float)left;
    t->camera.cy_px -= (float)top;
    return copy_planes(t, b, left, top)
           && crv_plan_create(context, options, &t->desc, &t->plan) == CRV_OK
           && crv_gbuffer_create(context, &t->desc, &t->gbuffer) == CRV_OK
           && crv_gbuffer_set_camera(t->gbuffer, &t->camera) == CRV_OK;
}

static bool set_layer(trial *t, int32_t layer)
{
    const crv_const_image depth =
        crv_const_image_packed(t->depth[layer], t->desc.width, t->desc.height, 1);
    return crv_gbuffer_set_depth(t->gbuffer, layer, &depth, NULL) == CRV_OK;
}

static bool set_all(trial *t)
{
    const crv_const_image normals =
        crv_const_image_packed(t->normals, t->desc.width, t->desc.height, 3);
    bool done = true;
    for (int32_t i = 0; i < t->desc.layers; i++)
        done = done && set_layer(t, i);
    return done
           && crv_gbuffer_set_normals(t->gbuffer, &normals, CRV_NORMAL_VIEW) == CRV_OK;
}

/* The pixel's value. */
static bool run_trial(trial *t, float *value)
{
    const crv_image result = crv_image_packed(value, 1, 1, 1);
    return crv_plan_run(t->plan, t->gbuffer, &result) == CRV_OK;
}

static void empty_all(trial *t)
{
    const size_t pixel = (size_t)t->row * (size_t)t->desc.width + (size_t)t->column;
    for (int32_t i = 0; i < t->desc.layers; i++) {
        const float own = t->depth[i][pixel];
        for (size_t k = 0; k < texel_count(t); k++)
            t->depth[i][k] = INFINITY;
        t->depth[i][pixel] = own;
    }
}

/* A view ray: from `from`, `to` at planar depth 1 (perspective) or along -z. */
static void ray_of(const trial *t, int32_t column, int32_t row, double from[3],
                   double along[3])
{
    const crv_camera *c = &t->camera;
    const double x = (column + 0.5 - (double)c->cx_px) / (double)c->fx_px;
    const double y = -(row + 0.5 - (double)c->cy_px) / (double)c->fy_px;
    const bool spreads = c->projection == CRV_PERSPECTIVE;
    from[0] = spreads ? 0.0 : x;
    from[1] = spreads ? 0.0 : y;
    from[2] = 0.0;
    along[0] = spreads ? x : 0.0;
    along[1] = spreads ? y : 0.0;
    along[2] = -1.0;
}

/* The depth at which something on the texel's view ray stands high over the pixel's point
 * p and within the radius; infinite if the ray passes it by. */
static float raised_depth(const trial *t, const double p[3], int32_t column, int32_t row)
{
    double from[3], along[3], square = 0.0, nearest = 0.0, distance2 = 0.0;
    ray_of(t, column, row, from, along);
    for (int i = 0; i < 3; i++) {
        square += along[i] * along[i];
        nearest += (p[i] - from[i]) * along[i];
    }
    nearest /= square;
    for (int i = 0; i < 3; i++) {
        const double d = from[i] + nearest * along[i] - p[i];
        distance2 += d * d;
    }
    const double rest = t->radius * t->radius - distance2;
    if (!(rest > 0.0))
        return INFINITY;
    return (float)fmax(nearest - raised_share * sqrt(rest / square), 1e-3 * nearest);
}

static float *make_raised(const trial *t, float own_depth)
{
    float *raised = malloc(texel_count(t) * sizeof *raised);
    double from[3], along[3], p[3];
    if (!raised)
        return NULL;
    ray_of(t, t->column, t->row, from, along);
    for (int i = 0; i < 3; i++)
        p[i] = from[i] + (double)own_depth * along[i];
    for (int32_t y = 0; y < t->desc.height; y++)
        for (int32_t x = 0; x < t->desc.width; x++)
            raised[(size_t)y * (size_t)t->desc.width + (size_t)x] =
                x == t->column && y == t->row ? INFINITY : raised_depth(t, p, x, y);
    return raised;
}

/* Puts occluders into a part, or takes them away; false if the part has room for none. */
static bool fill(const search *s, const part *p, bool raise)
{
    trial *t = s->empty;
    bool any = false;
    for (int32_t y = p->top; y < p->bottom; y++)
        for (int32_t x = p->left; x < p->right; x++) {
            const size_t i = (size_t)y * (size_t)t->desc.width + (size_t)x;
            if (x == t->column && y == t->row)
                continue;
            t->depth[0][i] = raise ? s->raised[i] : INFINITY;
            any = any || isfinite(s->raised[i]);
        }
    return any;
}

static bool is_read(search *s, const part *p)
{
    float value = s->usual;
    const bool any = fill(s, p, !s->is_full);
    if (any && (!set_layer(s->empty, 0) || !run_trial(s->empty, &value)))
        s->failed = true;
    fill(s, p, s->is_full);
    return value < s->usual || value > s->usual;
}

static void add(search *s, const part *p)
{
    samples *out = s->out;
    if (out->count == SAMPLES_MAX) {
        out->is_whole = false;
        return;
    }
    out->list[out->count++] = (sample){.x = out->x + p->left - s->empty->column,
                                       .y = out->y + p->top - s->empty->row};
}

/* Halves the part along its longer side until it is a texel. */
static void look_into(search *s, const part *p)
{
    const int32_t width = p->right - p->left, height = p->bottom - p->top;
    if (s->failed || s->is_stale(s->user) || !is_read(s, p))
        return;
    if (width == 1 && height == 1) {
        add(s, p);
        return;
    }
    part first = *p, second = *p;
    if (width >= height)
        first.right = second.left = p->left + width / 2;
    else
        first.bottom = second.top = p->top + height / 2;
    look_into(s, &first);
    look_into(s, &second);
}

/* Which of the texels change the pixel as it is, if what they show is taken away. */
static bool weigh(trial *t, samples *out)
{
    float usual, value;
    if (!set_all(t) || !run_trial(t, &usual))
        return false;
    for (int32_t k = 0; k < out->count; k++) {
        sample *s = &out->list[k];
        const size_t i = (size_t)(s->y - out->y + t->row) * (size_t)t->desc.width
                         + (size_t)(s->x - out->x + t->column);
        float before[CRV_MAX_LAYERS];
        bool done = true;
        for (int32_t layer = 0; layer < t->desc.layers; layer++) {
            before[layer] = t->depth[layer][i];
            t->depth[layer][i] = INFINITY;
            done = done && set_layer(t, layer);
        }
        if (!done || !run_trial(t, &value))
            return false;
        s->counts = fabsf(value - usual) > least_change;
        for (int32_t layer = 0; layer < t->desc.layers; layer++)
            t->depth[layer][i] = before[layer];
    }
    return true;
}

/* How far the pixel's samples may lie, px. */
static double reach_of(const buffers *b, const crv_options *o, double depth)
{
    const crv_camera *c = &b->g.camera;
    const double spread = c->projection == CRV_PERSPECTIVE ? depth : 1.0;
    const double px =
        (double)o->radius * fmax((double)c->fx_px, (double)c->fy_px) / spread;
    const bool is_limited =
        o->max_radius_px > 0.0f
        && crv_option_applies(crv_option_find("max_radius_px"), o->method, NULL);
    return (is_limited ? fmin(px, (double)o->max_radius_px) : px) + 2.0;
}

bool samples_find(crv_context *context, const buffers *b, const crv_options *options,
                  int32_t x, int32_t y, bool (*is_stale)(void *user), void *user,
                  samples *out)
{
    if (x < 0 || y < 0 || x >= b->width || y >= b->height
        || !b->surface[(size_t)y * (size_t)b->width + (size_t)x])
        return false;
    const float depth = b->g.depth[0][buffers_index(b, x, y)];
    const double wanted = reach_of(b, options, (double)depth);
    const int32_t reach = (int32_t)ceil(fmin(wanted, SAMPLES_REACH_PX));
    crv_options own = *options;
    own.filter = NULL;
    own.intensity = own.contrast = 1.0f;
    *out = (samples){.x = x, .y = y, .is_whole = wanted <= SAMPLES_REACH_PX};
    trial empty, real = {0};
    search s = {.empty = &empty, .is_stale = is_stale, .user = user, .out = out};
    bool done = open_trial(&empty, context, b, &own, x, y, reach);
    float *raised = done ? make_raised(&empty, depth) : NULL;
    s.raised = raised;
    if (done)
        empty_all(&empty);
    done = done && raised && set_all(&empty) && run_trial(&empty, &s.usual);
    const part all = {0, 0, empty.desc.width, empty.desc.height};
    if (done)
        look_into(&s, &all);
    /* Methods that are more than open in the empty: vo. */
    s.is_full = done && !s.failed && out->count == 0 && fill(&s, &all, true);
    if (s.is_full && set_layer(&empty, 0) && run_trial(&empty, &s.usual))
        look_into(&s, &all);
    done = done && !s.failed && !is_stale(user)
           && open_trial(&real, context, b, &own, x, y, reach) && weigh(&real, out);
    free(raised);
    close_trial(&empty);
    close_trial(&real);
    return done;
}
