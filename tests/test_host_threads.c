/* SPDX-License-Identifier: MIT */
/* The host's own threads: its pool runs the loops of two contexts that two of its threads
 * use at once. Bits are those of one thread; ThreadSanitizer sees the kernels of every
 * method and filter without OpenMP. */
#include "fixture.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>

enum { WIDTH = 90, HEIGHT = 40, WORKERS = 2, PIXELS = WIDTH * HEIGHT };

/* One loop, and the threads that take tasks of it. */
typedef struct loop {
    atomic_uint next;
    uint32_t count;
    void (*task)(void *data, uint32_t index);
    void *data;
} loop;

static void *work(void *user)
{
    loop *l = user;
    for (uint32_t i = atomic_fetch_add(&l->next, 1); i < l->count;
         i = atomic_fetch_add(&l->next, 1))
        l->task(l->data, i);
    return NULL;
}

static void run_loop(void *user, uint32_t count, void (*task)(void *data, uint32_t index),
                     void *data)
{
    (void)user;
    loop l = {.count = count, .task = task, .data = data};
    pthread_t threads[WORKERS];
    int started = 0;
    while (started < WORKERS && !pthread_create(&threads[started], NULL, work, &l))
        started++;
    if (!started)
        work(&l);
    for (int i = 0; i < started; i++)
        pthread_join(threads[i], NULL);
}

/* What a thread of the host computes: every method with one filter. */
typedef struct job {
    const fixture *frame;
    const crv_filter *filter;
    crv_parallel parallel; /* run NULL: one thread of the library's own */
    int32_t exact;
    float *results; /* PIXELS for each method */
    bool done;
} job;

static bool compute(const job *j, crv_context *context, const crv_method *method,
                    float *result)
{
    crv_gbuffer_desc desc;
    crv_options options;
    crv_gbuffer *gbuffer = NULL;
    crv_plan *plan = NULL;
    const crv_const_image depth =
        crv_const_image_packed(j->frame->depth, WIDTH, HEIGHT, 1);
    const crv_image image = crv_image_packed(result, WIDTH, HEIGHT, 1);
    crv_gbuffer_desc_init(&desc, sizeof desc, WIDTH, HEIGHT);
    crv_options_init(&options, sizeof options, method->name);
    options.filter = j->filter;
    options.radius = 0.5f;
    const bool done = crv_gbuffer_create(context, &desc, &gbuffer) == CRV_OK
                      && crv_plan_create(context, &options, &desc, &plan) == CRV_OK
                      && crv_gbuffer_set_camera(gbuffer, &j->frame->camera) == CRV_OK
                      && crv_gbuffer_set_depth(gbuffer, 0, &depth, NULL) == CRV_OK
                      && crv_plan_run(plan, gbuffer, &image) == CRV_OK;
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(gbuffer);
    return done;
}

/* No assertion of cmocka's in here: it is not its thread. */
static void *compute_all(void *user)
{
    job *j = user;
    crv_context_desc desc;
    crv_context *context = NULL;
    crv_context_desc_init(&desc, sizeof desc);
    desc.parallel = j->parallel;
    desc.threads = 1;
    desc.exact = j->exact;
    j->done = crv_context_create(&desc, &context) == CRV_OK;
    for (int32_t m = 0; j->done && m < crv_method_count(); m++)
        j->done = compute(j, context, crv_method_at(m), j->results + m * PIXELS);
    crv_context_destroy(context);
    return NULL;
}

static fixture make_frame(void)
{
    const double parameters[] = {1.0};
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 1.0f);
    return fixture_make(fixture_spheres, parameters, &camera, WIDTH, HEIGHT);
}

static void two_contexts_in_two_threads(void **state)
{
    (void)state;
    const size_t count = (size_t)crv_method_count() * PIXELS;
    fixture frame = make_frame();
    for (int32_t f = 0; f <= crv_filter_count(); f++) { /* the last: none */
        job jobs[3];
        pthread_t threads[2];
        for (int i = 0; i < 3; i++) {
            jobs[i] = (job){.frame = &frame,
                            .filter = crv_filter_at(f),
                            .exact = f & 1,
                            .results = calloc(count, sizeof(float))};
            jobs[i].parallel.run = i < 2 ? run_loop : NULL;
            assert_non_null(jobs[i].results);
        }
        for (int i = 0; i < 2; i++)
            assert_int_equal(pthread_create(&threads[i], NULL, compute_all, &jobs[i]), 0);
        for (int i = 0; i < 2; i++)
            assert_int_equal(pthread_join(threads[i], NULL), 0);
        compute_all(&jobs[2]);
        for (int i = 0; i < 3; i++) {
            assert_true(jobs[i].done);
            assert_memory_equal(jobs[i].results, jobs[2].results, count * sizeof(float));
        }
        for (int i = 0; i < 3; i++)
            free(jobs[i].results);
    }
    fixture_free(&frame);
}

/* A context that a task of its own plan, or its host meanwhile, destroys. */
typedef struct impatient {
    crv_context *context;
    int loops, errors;
} impatient;

static void run_and_destroy(void *user, uint32_t count,
                            void (*task)(void *data, uint32_t index), void *data)
{
    impatient *host = user;
    host->loops++;
    crv_context_destroy(host->context);
    run_loop(NULL, count, task, data);
}

static void count_errors(void *user, crv_log_level level, const char *line)
{
    impatient *host = user;
    if (level == CRV_LOG_ERROR && strstr(line, "not destroyed"))
        host->errors++;
}

static void a_context_whose_plan_runs_stays(void **state)
{
    (void)state;
    fixture frame = make_frame();
    impatient host = {0};
    float *result = calloc(PIXELS, sizeof *result);
    const job j = {.frame = &frame};
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.parallel = (crv_parallel){run_and_destroy, &host};
    desc.logger = (crv_logger){count_errors, &host};
    assert_int_equal(crv_context_create(&desc, &host.context), CRV_OK);
    assert_non_null(result);
    assert_true(compute(&j, host.context, crv_method_at(0), result));
    assert_true(host.loops > 0);
    assert_int_equal(host.errors, host.loops);
    crv_context_destroy(host.context);
    assert_int_equal(host.errors, host.loops); /* this one went */
    free(result);
    fixture_free(&frame);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_contexts_in_two_threads),
        cmocka_unit_test(a_context_whose_plan_runs_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
