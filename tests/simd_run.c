/* SPDX-License-Identifier: MIT */
/* Runs of the library between guard bytes. */
#include "aligned.h"
#include "simd.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { GUARD = 192, GUARD_BYTE = 0xa5 };

/* A block from the allocator: guard bytes on both sides of what was asked for. */
typedef struct guarded {
    void *block;
    size_t size;
    struct guarded *next;
} guarded;

typedef struct keeper {
    guarded *blocks;
    simd_random order;
    int faults;
} keeper;

static unsigned char *user_part(const guarded *g)
{
    return (unsigned char *)g->block + GUARD;
}

static void *allocate(void *user, size_t size, size_t alignment)
{
    keeper *k = user;
    guarded *g = malloc(sizeof *g);
    const size_t all = (size + 2 * (size_t)GUARD + alignment - 1) / alignment * alignment;
    void *block = GUARD % alignment == 0 ? take_aligned(alignment, all) : NULL;
    if (!g || !block) {
        free(g);
        give_aligned(block);
        return NULL;
    }
    memset(block, GUARD_BYTE, all);
    *g = (guarded){block, size, k->blocks};
    k->blocks = g;
    return user_part(g);
}

static void check_block(keeper *k, const guarded *g)
{
    const unsigned char *start = g->block, *end = user_part(g) + g->size;
    for (int i = 0; i < GUARD; i++) {
        if (start[i] != GUARD_BYTE || end[i] != GUARD_BYTE) {
            printf("  a byte %d before or behind a block of %zu was written\n", i,
                   g->size);
            k->faults++;
            return;
        }
    }
}

static void release(void *user, void *memory, size_t size)
{
    keeper *k = user;
    (void)size;
    for (guarded **link = &k->blocks; *link; link = &(*link)->next) {
        guarded *g = *link;
        if (user_part(g) != memory)
            continue;
        check_block(k, g);
        *link = g->next;
        give_aligned(g->block);
        free(g);
        return;
    }
    printf("  a block was released that nobody took\n");
    k->faults++;
}

/* Tiles one after the other in an order of its own: one that writes to its neighbours is
 * found out. */
static void run_shuffled(void *user, uint32_t count, void (*task)(void *, uint32_t),
                         void *data)
{
    keeper *k = user;
    uint32_t *order = malloc(count * sizeof *order);
    if (!order) {
        k->faults++;
        return;
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t j = (uint32_t)simd_int(&k->order, 0, (int32_t)i);
        order[i] = order[j];
        order[j] = i;
    }
    for (uint32_t i = 0; i < count; i++)
        task(data, order[i]);
    free(order);
}

static void run_in_order(void *user, uint32_t count, void (*task)(void *, uint32_t),
                         void *data)
{
    (void)user;
    for (uint32_t i = 0; i < count; i++)
        task(data, i);
}

static void print_errors(void *user, crv_log_level level, const char *line)
{
    (void)user;
    if (level == CRV_LOG_ERROR)
        printf("  %s\n", line);
}

/* An image with strides of its own, in a block of guard bytes. */
typedef struct canvas {
    unsigned char *block;
    size_t size;
    crv_image image;
} canvas;

static canvas canvas_make(simd_random *r, int32_t width, int32_t height, int32_t channels)
{
    canvas c = {.image = {.width = width, .height = height, .channels = channels}};
    const ptrdiff_t pixel = 4 * channels * (simd_chance(r, 2) ? 1 : simd_int(r, 2, 4));
    const ptrdiff_t row = pixel * width + 4 * simd_int(r, 0, 20);
    const int flipped = simd_chance(r, 3);
    c.size = (size_t)(row * height) + 2 * (size_t)GUARD;
    c.block = malloc(c.size);
    if (!c.block)
        return c;
    memset(c.block, GUARD_BYTE, c.size);
    c.image.pixel_stride = pixel;
    c.image.row_stride = flipped ? -row : row;
    c.image.channel_stride = 4;
    c.image.data =
        (float *)(void *)(c.block + GUARD + (flipped ? row * (height - 1) : 0));
    return c;
}

/* Takes the pixels out; what is left must be guard bytes. */
static int canvas_take(canvas *c, float *out)
{
    const crv_image *image = &c->image;
    for (int32_t y = 0; y < image->height; y++) {
        for (int32_t x = 0; x < image->width; x++) {
            const size_t size = (size_t)image->channels * sizeof(float);
            float *pixel = crv_image_at(image, x, y, 0);
            memcpy(out + (y * image->width + x) * image->channels, pixel, size);
            memset(pixel, GUARD_BYTE, size);
        }
    }
    for (size_t i = 0; i < c->size; i++) {
        if (c->block[i] != GUARD_BYTE) {
            printf("  a byte between the result's pixels was written\n");
            return 0;
        }
    }
    return 1;
}

typedef struct session {
    crv_context *context;
    crv_gbuffer *gbuffer;
    crv_plan *plan;
} session;

static void session_end(session *s)
{
    crv_plan_destroy(s->plan);
    crv_gbuffer_destroy(s->gbuffer);
    crv_context_destroy(s->context);
}

static crv_status session_begin(session *s, const simd_case *c, crv_isa isa, keeper *k)
{
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.isa_mask = 1u << isa;
    desc.exact = c->exact;
    desc.logger.fn = print_errors;
    desc.parallel.run = k ? run_shuffled : run_in_order;
    desc.parallel.user = k;
    if (k)
        desc.allocator = (crv_allocator){allocate, release, k};
    *s = (session){0};
    crv_status status = crv_context_create(&desc, &s->context);
    if (status == CRV_OK)
        status = crv_gbuffer_create(s->context, &c->desc, &s->gbuffer);
    if (status == CRV_OK)
        status = crv_plan_create(s->context, &c->options, &c->desc, &s->plan);
    if (status == CRV_OK)
        status = crv_gbuffer_set_camera(s->gbuffer, &c->camera);
    for (int32_t i = 0; status == CRV_OK && i < c->desc.layers; i++) {
        const crv_const_image depth =
            crv_const_image_packed(c->depth[i], c->desc.width, c->desc.height, 1);
        status = crv_gbuffer_set_depth(s->gbuffer, i, &depth, NULL);
    }
    if (status == CRV_OK && c->normals) {
        const crv_const_image normals =
            crv_const_image_packed(c->normals, c->desc.width, c->desc.height, 3);
        status = crv_gbuffer_set_normals(s->gbuffer, &normals, CRV_NORMAL_VIEW);
    }
    if (status == CRV_OK && crv_context_isa(s->context) != isa) {
        printf("  asked for %s, got %s\n", crv_isa_name(isa),
               crv_isa_name(crv_context_isa(s->context)));
        status = CRV_ERROR_UNSUPPORTED;
    }
    return status;
}

static crv_status session_run(const session *s, const simd_case *c,
                              const crv_image *result, const crv_image *bent)
{
    crv_result wanted;
    crv_result_init(&wanted, sizeof wanted);
    wanted.accessibility = *result;
    if (bent)
        wanted.bent_normal = *bent;
    if (!c->input)
        return crv_plan_run_result(s->plan, s->gbuffer, &wanted);
    crv_const_image input =
        crv_const_image_packed(c->input, result->width, result->height, 1);
    return crv_plan_filter(s->plan, s->gbuffer, &input, result);
}

float *simd_run(const simd_case *c, crv_isa isa)
{
    const crv_gbuffer_desc *d = &c->desc;
    const int32_t width = d->width - d->guard_left - d->guard_right;
    const int32_t height = d->height - d->guard_top - d->guard_bottom;
    keeper k = {.order = simd_random_make(c->layout, (uint64_t)isa, 0)};
    simd_random layout = simd_random_make(c->layout, 100, 0);
    const size_t count = (size_t)width * (size_t)height;
    const int with_bent = c->options.bent_normal;
    canvas to = canvas_make(&layout, width, height, 1),
           bent = canvas_make(&layout, width, height, 3);
    float *out = malloc((with_bent ? 4 : 1) * count * sizeof *out);
    session s = {0};
    int done = to.block && bent.block && out && session_begin(&s, c, isa, &k) == CRV_OK
               && session_run(&s, c, &to.image, with_bent ? &bent.image : NULL) == CRV_OK
               && canvas_take(&to, out)
               && (!with_bent || canvas_take(&bent, out + count));
    session_end(&s);
    if (k.blocks) {
        printf("  memory was not given back\n");
        done = 0;
    }
    free(to.block);
    free(bent.block);
    if (done && k.faults == 0)
        return out;
    free(out);
    return NULL;
}

/* Processor time and not wall time, since the machine may be busy; the best run, since
 * nothing but disturbance makes one longer. */
double simd_time(const simd_case *c, crv_isa isa)
{
    const crv_gbuffer_desc *d = &c->desc;
    const int32_t width = d->width - d->guard_left - d->guard_right;
    const int32_t height = d->height - d->guard_top - d->guard_bottom;
    float *pixels = malloc((size_t)width * (size_t)height * sizeof *pixels);
    const crv_image to = crv_image_packed(pixels, width, height, 1);
    session s = {0};
    double best = 0, total = 0;
    int done = pixels && session_begin(&s, c, isa, NULL) == CRV_OK;
    for (int run = 0; done && run < 20 && (run < 3 || total < 0.5); run++) {
        const clock_t start = clock();
        done = session_run(&s, c, &to, NULL) == CRV_OK;
        const double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
        best = run == 0 || seconds < best ? seconds : best;
        total += seconds;
    }
    session_end(&s);
    free(pixels);
    return done ? best * 1e9 / width / height : 0;
}
