/* SPDX-License-Identifier: MIT */
#include "truth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/report.h"
#include "common/target.h"
#include "system/monitor.h"

/* Pixels between two looks at the wishes: a few milliseconds. */
enum { CHUNK = 1024 };
/* Between two calls of changed(), but for the first passes. */
#define TOLD_S 0.1
enum { FIRST_PASSES = 3 };

typedef struct truth_slot {
    buffers *b; /* held; NULL: nothing is wanted */
    reference_options options;
    float *mean, *spread; /* of the passes; spread: sum of squared deviations */
    truth_state state;
    bool failed;
    int generation; /* counts wishes */
} truth_slot;

struct truth {
    const scene *model;
    int32_t threads;
    void (*changed)(void *user);
    void *user;
    monitor *monitor;
    bool quit, hold;
    double rest_until; /* as hold, until then; report_seconds() */
    double told;       /* when changed() was called last */
    truth_slot slot[TRUTH_SLOTS];
    int64_t versions; /* of means so far */
    bool shared;      /* slot 1 wants what slot 0 does */
};

static void clear(truth_slot *s)
{
    buffers_release(s->b);
    free(s->mean);
    free(s->spread);
    *s = (truth_slot){.generation = s->generation + 1};
}

static void begin(truth_slot *s, buffers *b, const reference_options *o)
{
    const size_t count = (size_t)b->width * (size_t)b->height;
    clear(s);
    s->mean = calloc(count, sizeof *s->mean);
    s->spread = calloc(count, sizeof *s->spread);
    s->b = buffers_hold(b);
    s->options = *o;
    s->failed = !s->mean || !s->spread;
}

/* The slot that is behind; -1 if all is done. */
static int next_slot(const truth *t)
{
    int best = -1;
    for (int i = 0; i < TRUTH_SLOTS && !t->hold; i++) {
        const truth_slot *s = &t->slot[i];
        if (s->b && !s->failed && s->state.passes < TRUTH_PASSES
            && (best < 0 || s->state.passes < t->slot[best].state.passes))
            best = i;
    }
    return best;
}

/* Root mean square of the standard errors over the surfaces. */
static double error_of(const truth_slot *s, const float *own)
{
    const size_t count = (size_t)s->b->width * (size_t)s->b->height;
    const double n = s->state.passes;
    double sum = 0.0;
    size_t surfaces = 0;
    for (size_t i = 0; i < count; i++) {
        if (!s->b->surface[i])
            continue;
        surfaces++;
        sum += n > 1.0 ? (double)s->spread[i] / (n * (n - 1.0))
                       : (double)own[i] * (double)own[i];
    }
    return surfaces > 0 ? sqrt(sum / (double)surfaces) : 0.0;
}

/* Takes a whole pass into the mean (Welford 1962). */
static void add_pass(truth_slot *s, const reference *r)
{
    const float *value = reference_accessibility(r);
    const size_t count = (size_t)s->b->width * (size_t)s->b->height;
    const float n = (float)++s->state.passes;
    for (size_t i = 0; i < count; i++) {
        const float before = value[i] - s->mean[i];
        s->mean[i] += before / n;
        s->spread[i] += before * (value[i] - s->mean[i]);
    }
    s->state.known = (int64_t)count;
    s->state.error = error_of(s, reference_error(r));
}

/* Shows what there is of the first pass. */
static void show_part(truth_slot *s, const reference *r)
{
    s->state.known = reference_done(r);
    memcpy(s->mean, reference_accessibility(r), (size_t)s->state.known * sizeof *s->mean);
}

/* What the thread keeps of one slot between its chunks. */
typedef struct job {
    reference *work;
    buffers *b; /* held as long as `work` reads it */
    int generation;
} job;

static void drop_job(job *j)
{
    reference_free(j->work);
    buffers_release(j->b);
    *j = (job){.generation = -1};
}

/* Makes the reference of a slot; called and left with the lock held. */
static void start_job(truth *t, truth_slot *s, job *j)
{
    reference_options options = s->options;
    drop_job(j);
    j->generation = s->generation;
    j->b = buffers_hold(s->b);
    options.rays = TRUTH_PASS_RAYS;
    options.seed = 1;
    monitor_leave(t->monitor);
    if (reference_create(t->model, &j->b->g, &options, &j->work, NULL) != 0)
        j->work = NULL;
    monitor_enter(t->monitor);
    if (!j->work && j->generation == s->generation)
        s->failed = true;
}

/* One chunk of a slot; called and left with the lock held. True if there is something new
 * to see. */
static bool work_on(truth *t, int index, job *j)
{
    truth_slot *s = &t->slot[index];
    if (j->generation != s->generation)
        start_job(t, s, j);
    if (!j->work)
        return false;
    reference *work = j->work;
    monitor_leave(t->monitor);
    reference_advance(work, CHUNK, t->threads);
    monitor_enter(t->monitor);
    if (j->generation != s->generation)
        return false;
    const bool whole = reference_done(work) == reference_total(work);
    if (whole) {
        add_pass(s, work);
        s->state.version = ++t->versions;
        reference_restart(work, (uint32_t)s->state.passes + 1);
    }
    const bool is_news = whole || s->state.passes == 0;
    const bool is_urgent =
        whole && (s->state.passes <= FIRST_PASSES || s->state.passes == TRUTH_PASSES);
    if (!is_news || (!is_urgent && report_seconds() < t->told + TOLD_S))
        return false;
    if (!whole) {
        show_part(s, work);
        s->state.version = ++t->versions;
    }
    t->told = report_seconds();
    return true;
}

/* Waits out the rest; false if there is none. */
static bool rest(truth *t)
{
    const double left = t->rest_until - report_seconds();
    if (!(left > 0.0))
        return false;
    monitor_wait_for(t->monitor, left);
    return true;
}

static void run(void *data)
{
    truth *t = data;
    job jobs[TRUTH_SLOTS] = {{.generation = -1}, {.generation = -1}};
    monitor_enter(t->monitor);
    while (!t->quit) {
        const int index = next_slot(t);
        for (int i = 0; i < TRUTH_SLOTS; i++)
            if (jobs[i].work && jobs[i].generation != t->slot[i].generation)
                drop_job(&jobs[i]);
        if (index < 0) {
            monitor_wait(t->monitor);
            continue;
        }
        if (rest(t))
            continue;
        if (work_on(t, index, &jobs[index])) {
            monitor_leave(t->monitor);
            t->changed(t->user);
            monitor_enter(t->monitor);
        }
    }
    monitor_leave(t->monitor);
    for (int i = 0; i < TRUTH_SLOTS; i++)
        drop_job(&jobs[i]);
}

truth *truth_start(const scene *model, int32_t threads, void (*changed)(void *user),
                   void *user)
{
    truth *t = calloc(1, sizeof *t);
    if (!t)
        return NULL;
    t->model = model;
    t->threads = threads;
    t->changed = changed;
    t->user = user;
    t->monitor = monitor_create();
    if (t->monitor && monitor_start(t->monitor, run, t))
        return t;
    monitor_free(t->monitor);
    free(t);
    return NULL;
}

void truth_stop(truth *t)
{
    if (!t)
        return;
    monitor_enter(t->monitor);
    t->quit = true;
    monitor_wake(t->monitor);
    monitor_leave(t->monitor);
    monitor_join(t->monitor);
}

void truth_free(truth *t)
{
    if (!t)
        return;
    for (int i = 0; i < TRUTH_SLOTS; i++)
        clear(&t->slot[i]);
    monitor_free(t->monitor);
    free(t);
}

void truth_want(truth *t, int slot, buffers *b, const reference_options *o)
{
    monitor_enter(t->monitor);
    truth_slot *s = &t->slot[slot], *first = &t->slot[0];
    if (slot == 1)
        t->shared = b && first->b == b && target_equal(&first->options, o);
    if (!b || (slot == 1 && t->shared)) {
        if (s->b)
            clear(s);
    } else if (s->b != b || !target_equal(&s->options, o)) {
        begin(s, b, o);
        s->state.version = ++t->versions;
    }
    monitor_wake(t->monitor);
    monitor_leave(t->monitor);
}

void truth_hold(truth *t, bool hold)
{
    monitor_enter(t->monitor);
    t->hold = hold;
    monitor_wake(t->monitor);
    monitor_leave(t->monitor);
}

void truth_rest(truth *t, double seconds)
{
    monitor_enter(t->monitor);
    t->rest_until = report_seconds() + seconds;
    monitor_leave(t->monitor);
}

static const truth_slot *slot_of(const truth *t, int slot)
{
    return &t->slot[slot == 1 && t->shared ? 0 : slot];
}

bool truth_read(truth *t, int slot, const buffers *b, float *out, truth_state *state)
{
    monitor_enter(t->monitor);
    const truth_slot *s = slot_of(t, slot);
    const bool fits = s->b && s->b == b && !s->failed;
    if (fits) {
        memcpy(out, s->mean, (size_t)b->width * (size_t)b->height * sizeof *out);
        *state = s->state;
    }
    monitor_leave(t->monitor);
    return fits;
}

bool truth_progress(truth *t, int slot, truth_state *state)
{
    monitor_enter(t->monitor);
    const truth_slot *s = slot_of(t, slot);
    const bool wanted = s->b && !s->failed;
    if (wanted)
        *state = s->state;
    monitor_leave(t->monitor);
    return wanted;
}
