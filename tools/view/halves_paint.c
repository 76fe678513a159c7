/* SPDX-License-Identifier: MIT */
/* The pixels of a half, painted anew only if what they show has changed. */
#include <stdlib.h>
#include <string.h>

#include "halves.h"
#include "paint.h"

static void forget_light(engine *e)
{
    free(e->dark);
    free(e->light);
    e->dark = e->light = NULL;
}

static void forget_painted(painted *p)
{
    pool_release(p->pixels);
    for (int i = 0; i < HALVES; i++)
        pool_release(p->plane[i]);
    *p = (painted){0};
}

void halves_forget_paint(engine *e)
{
    forget_light(e);
    for (int i = 0; i < HALVES; i++)
        forget_painted(&e->painted[i]);
}

/* Lit pictures without sky and with all of it; what lies between is in proportion. */
static bool make_light(engine *e)
{
    const int32_t width = e->buffers->width, height = e->buffers->height;
    const size_t count = (size_t)width * (size_t)height;
    const int32_t threads = e->source->settings->common.threads.value;
    if (e->dark || !e->source->model)
        return true;
    float *closed = calloc(count, sizeof *closed);
    e->dark = malloc(3 * count * sizeof *e->dark);
    e->light = malloc(3 * count * sizeof *e->light);
    bool done = closed && e->dark && e->light;
    if (done) {
        const scene_occlusion none = {
            .accessibility = crv_const_image_packed(closed, width, height, 1)};
        const crv_image dark = crv_image_packed(e->dark, width, height, 3);
        const crv_image light = crv_image_packed(e->light, width, height, 3);
        done = scene_shade(e->source->model, &e->buffers->g, NULL, &none, &dark, threads,
                           &e->quiet.logger)
                   == 0
               && scene_shade(e->source->model, &e->buffers->g, NULL, NULL, &light,
                              threads, &e->quiet.logger)
                      == 0;
    }
    free(closed);
    if (!done)
        forget_light(e);
    return done;
}

/* Pixels of a half from this one on are not known yet: the truth is being traced. */
static size_t known_of(const engine *e, const wish *w, const shown *s, int half)
{
    if (w->half[half].content != HALF_TRUTH || !halves_are_settled(e, w))
        return halves_plane_count(e);
    return s->half[half].has_truth ? (size_t)s->half[half].truth.known : 0;
}

static painted ground_of(const engine *e, const wish *w, const shown *s, int half)
{
    const half_look look = w->half[half].look;
    const bool has_light = e->source->model || e->buffers->beauty;
    painted p = {.look = look == LOOK_LIT && !has_light ? LOOK_ACCESSIBILITY : look,
                 .plane = {s->half[half].accessibility},
                 .known = known_of(e, w, s, half)};
    if (look == LOOK_DIFFERENCE) {
        const size_t other = known_of(e, w, s, 1 - half);
        for (int i = 0; i < HALVES; i++)
            p.plane[i] = s->half[i].accessibility;
        p.heat_scale = w->heat_scale;
        p.known = other < p.known ? other : p.known;
    } else if (p.known < halves_plane_count(e)
               && w->half[1 - half].content == HALF_METHOD) {
        p.plane[1] = s->half[1 - half].accessibility;
    }
    return p;
}

static bool same_ground(const painted *a, const painted *b)
{
    return a->pixels && a->look == b->look && a->plane[0] == b->plane[0]
           && a->plane[1] == b->plane[1] && a->known == b->known
           && memcmp(&a->heat_scale, &b->heat_scale, sizeof a->heat_scale) == 0;
}

static bool paint_anew(engine *e, painted *p)
{
    p->pixels = pool_take(e->planes, halves_plane_count(e) * sizeof *p->pixels);
    if (!p->pixels || (p->look == LOOK_LIT && !make_light(e)))
        return false;
    if (p->look == LOOK_DIFFERENCE)
        paint_difference(p->plane[0], p->plane[1], e->buffers->surface, p->heat_scale,
                         p->known, p->pixels);
    else if (p->look == LOOK_LIT)
        paint_lit(e->dark, e->source->model ? e->light : e->buffers->beauty, p->plane[0],
                  p->known, p->pixels);
    else
        paint_grey(p->plane[0], p->known, p->pixels);
    paint_unknown(p->look == LOOK_DIFFERENCE ? NULL : p->plane[1], p->known,
                  halves_plane_count(e), e->buffers->width, p->pixels);
    return true;
}

bool halves_paint(engine *e, const wish *w, int half, shown *out)
{
    painted now = ground_of(e, w, out, half);
    if (!same_ground(&e->painted[half], &now)) {
        const bool done = paint_anew(e, &now);
        for (int i = 0; i < HALVES; i++)
            pool_hold(now.plane[i]);
        forget_painted(&e->painted[half]);
        e->painted[half] = now;
        if (!done) {
            forget_painted(&e->painted[half]);
            return false;
        }
    }
    out->half[half].pixels = pool_hold(e->painted[half].pixels);
    return true;
}
