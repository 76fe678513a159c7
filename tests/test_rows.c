/* SPDX-License-Identifier: MIT */
/*
 * What every pixel passes on its way in and out, by all instruction sets against the
 * scalar code, on random and pathological data in any layout: to the bit, since the
 * kernels do the same operations in the same order. CREVICE_SEED repeats a run.
 */
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LARGEST = 75, CASES = 60, GUARD = 64 };

static uint64_t random_state;

static uint32_t draw(void)
{
    /* splitmix64: Steele, Lea, Flood 2014 */
    uint64_t z = random_state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (uint32_t)((z ^ (z >> 31)) >> 16);
}

static int32_t between(int32_t low, int32_t high)
{
    return low + (int32_t)(draw() % (uint32_t)(high - low + 1));
}

static float unit(void)
{
    return (float)(draw() >> 8) / 16777216.0f;
}

static float nonsense(void)
{
    static const float VALUES[] = {NAN,    INFINITY, -INFINITY, 0,      -0.0f,
                                   1e-42f, 3e38f,    -1,        1e-30f, 1};
    return VALUES[draw() % (sizeof VALUES / sizeof VALUES[0])];
}

/* An image of any layout in a block with guard bytes before, after and in the gaps. */
typedef struct canvas {
    unsigned char *block;
    size_t size;
    crv_image image;
} canvas;

static canvas canvas_make(int32_t width, int32_t height, int32_t channels)
{
    canvas c;
    const ptrdiff_t unit_size = (ptrdiff_t)sizeof(float);
    const int planar = between(0, 1), flipped = between(0, 1),
              mirrored = between(0, 3) == 0;
    const ptrdiff_t gap = between(0, 2) * unit_size;
    ptrdiff_t channel, pixel, row;
    if (planar) {
        pixel = unit_size + gap;
        channel = pixel * width + gap;
        row = channel * channels + gap;
    } else {
        channel = unit_size;
        pixel = unit_size * channels + gap;
        row = pixel * width + gap;
    }
    c.size = (size_t)(row * height) + (size_t)2 * GUARD;
    c.block = malloc(c.size);
    assert_non_null(c.block);
    memset(c.block, 0xa5, c.size);
    unsigned char *first = c.block + GUARD;
    if (flipped)
        first += row * (height - 1);
    if (mirrored)
        first += pixel * (width - 1);
    c.image = (crv_image){
        (float *)(void *)first,    width,  height, channels, flipped ? -row : row,
        mirrored ? -pixel : pixel, channel};
    return c;
}

/* Takes the pixels out, packed, and asserts that nothing else has been written. */
static float *canvas_take(canvas *c)
{
    const crv_image *image = &c->image;
    const size_t count =
        (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    float *pixels = malloc(count * sizeof *pixels), *to = pixels;
    assert_non_null(pixels);
    for (int32_t y = 0; y < image->height; y++) {
        for (int32_t x = 0; x < image->width; x++) {
            for (int32_t i = 0; i < image->channels; i++) {
                float *from = crv_image_at(image, x, y, i);
                *to++ = *from;
                memset(from, 0xa5, sizeof *from);
            }
        }
    }
    for (size_t i = 0; i < c->size; i++)
        assert_int_equal(c->block[i], 0xa5);
    free(c->block);
    return pixels;
}

/* Pixels of any type, layout and bits. */
typedef struct heap {
    unsigned char *block;
    crv_texels texels;
} heap;

static heap heap_make(crv_texel type, int32_t width, int32_t height, int32_t channels)
{
    static const double SCALES[][2] = {{1, 0}, {1 / 65535.0, 0}, {2 / 65535.0, -1}};
    heap h = {.texels = crv_texels_packed(NULL, type, width, height, channels)};
    crv_texels *t = &h.texels;
    const ptrdiff_t unit_size = t->channel_stride;
    const int planar = between(0, 1), flipped = between(0, 1);
    t->pixel_stride = (planar ? unit_size : unit_size * channels) + between(0, 2);
    if (between(0, 1)) /* a channel more */
        t->pixel_stride += unit_size;
    t->channel_stride = planar ? t->pixel_stride * width : unit_size;
    t->row_stride = t->pixel_stride * width * (planar ? channels : 1) + between(0, 3);
    const ptrdiff_t size = t->row_stride * height, first = t->row_stride * (height - 1);
    h.block = malloc((size_t)size);
    assert_non_null(h.block);
    for (ptrdiff_t i = 0; i < size; i++)
        h.block[i] = (unsigned char)draw();
    t->data = h.block + (flipped ? first : 0);
    t->row_stride *= flipped ? -1 : 1;
    const double *scale = SCALES[between(0, 2)];
    t->scale = scale[0];
    t->offset = scale[1];
    return h;
}

typedef struct rows_case {
    crv_gbuffer_desc desc;
    crv_camera camera;
    crv_depth_format format;
    canvas depth, normals, input;
    int is_typed; /* depth and normals come from these */
    heap typed_depth, typed_normals;
    int has_normals;
    crv_normal_space space;
    uint64_t layout;
} rows_case;

static void fill(const crv_image *image, float low, float high, int pathological)
{
    for (int32_t y = 0; y < image->height; y++) {
        for (int32_t x = 0; x < image->width; x++) {
            for (int32_t i = 0; i < image->channels; i++)
                *crv_image_at(image, x, y, i) = pathological && between(0, 9) == 0
                                                    ? nonsense()
                                                    : low + (high - low) * unit();
        }
    }
}

static rows_case case_make(int32_t index)
{
    rows_case c = {.has_normals = between(0, 1)};
    const int32_t width = between(1, LARGEST), height = between(1, LARGEST);
    crv_gbuffer_desc_init(&c.desc, sizeof c.desc, width, height);
    if (between(0, 1)) {
        c.desc.guard_left = between(0, width / 3);
        c.desc.guard_top = between(0, height / 3);
        c.desc.guard_right = between(0, width / 3);
    }
    c.camera = crv_camera_perspective(width, height, 0.3f + unit());
    c.camera.cx_px += 5 * unit();
    if (between(0, 2) == 0)
        c.camera.projection = CRV_ORTHOGRAPHIC;
    c.format = crv_depth_format_planar();
    c.format.encoding = (crv_depth_encoding)(index % (CRV_DEPTH_LOGARITHMIC + 1));
    if (between(0, 1))
        c.format.background = 4;
    c.format.z_near = 0.25f;
    c.format.z_far = 40;
    c.space = between(0, 1) ? CRV_NORMAL_VIEW : CRV_NORMAL_WORLD;
    c.depth = canvas_make(width, height, 1);
    c.normals = canvas_make(width, height, 3);
    c.input = canvas_make(width - c.desc.guard_left - c.desc.guard_right,
                          height - c.desc.guard_top, 1);
    const int hardware = c.format.encoding == CRV_DEPTH_HARDWARE
                         || c.format.encoding == CRV_DEPTH_REVERSED
                         || c.format.encoding > CRV_DEPTH_DISPARITY;
    fill(&c.depth.image, hardware ? -0.01f : 0.5f, hardware ? 1.01f : 5, index % 2);
    fill(&c.normals.image, -1, 1, index % 3 == 0);
    fill(&c.input.image, 0, 1, index % 2);
    c.is_typed = between(0, 1);
    c.typed_depth = heap_make((crv_texel)between(0, CRV_TEXEL_INT16), width, height, 1);
    c.typed_normals = heap_make((crv_texel)between(0, CRV_TEXEL_INT16), width, height, 3);
    c.layout = draw();
    return c;
}

typedef struct outcome {
    float *depth, *normals, *filtered;
} outcome;

static outcome run(const rows_case *c, crv_isa isa)
{
    random_state = c->layout; /* the same layouts of the results for every set */
    crv_context_desc desc;
    crv_context_desc_init(&desc, sizeof desc);
    desc.logger = fixture_strict_logger();
    desc.isa_mask = 1u << isa;
    crv_options options = fixture_options(NULL);
    assert_int_equal(crv_options_set(&options, "filter", "none", NULL), CRV_OK);
    crv_context *context = NULL;
    crv_gbuffer *g = NULL;
    crv_plan *plan = NULL;
    assert_int_equal(crv_context_create(&desc, &context), CRV_OK);
    assert_int_equal(crv_context_isa(context), isa);
    assert_int_equal(crv_gbuffer_create(context, &c->desc, &g), CRV_OK);
    assert_int_equal(crv_plan_create(context, &options, &c->desc, &plan), CRV_OK);
    assert_int_equal(crv_gbuffer_set_camera(g, &c->camera), CRV_OK);
    const crv_const_image depth_in = crv_image_const(c->depth.image);
    const crv_const_image normals_in = crv_image_const(c->normals.image);
    const crv_const_image input = crv_image_const(c->input.image);
    assert_int_equal(c->is_typed ? crv_gbuffer_set_depth_texels(
                         g, 0, &c->typed_depth.texels, &c->format)
                                 : crv_gbuffer_set_depth(g, 0, &depth_in, &c->format),
                     CRV_OK);
    if (c->has_normals)
        assert_int_equal(c->is_typed ? crv_gbuffer_set_normals_texels(
                             g, &c->typed_normals.texels, c->space)
                                     : crv_gbuffer_set_normals(g, &normals_in, c->space),
                         CRV_OK);
    canvas depth = canvas_make(c->desc.width, c->desc.height, 1);
    canvas normals = canvas_make(c->desc.width, c->desc.height, 3);
    canvas filtered = canvas_make(c->input.image.width, c->input.image.height, 1);
    assert_int_equal(crv_gbuffer_get_depth(g, 0, &depth.image), CRV_OK);
    assert_int_equal(crv_gbuffer_get_normals(g, &normals.image), CRV_OK);
    assert_int_equal(crv_plan_filter(plan, g, &input, &filtered.image), CRV_OK);
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(g);
    crv_context_destroy(context);
    return (outcome){canvas_take(&depth), canvas_take(&normals), canvas_take(&filtered)};
}

static void assert_same(const char *what, crv_isa isa, int32_t index, const float *a,
                        const float *b, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (memcmp(&a[i], &b[i], sizeof a[i]) != 0)
            fail_msg("%s, %s, case %d: number %d is %.9g, should be %.9g", what,
                     crv_isa_name(isa), index, (int)i, (double)b[i], (double)a[i]);
    }
}

static void outcome_free(outcome *o)
{
    free(o->depth);
    free(o->normals);
    free(o->filtered);
}

static void all_sets_give_the_same_bits(void **state)
{
    (void)state;
    const char *text = getenv("CREVICE_SEED");
    const uint64_t seed = text ? strtoull(text, NULL, 0) : 1;
    printf("CREVICE_SEED=%llu\n", (unsigned long long)seed);
    for (int32_t index = 0; index < CASES; index++) {
        random_state = seed * 1000003 + (uint64_t)index;
        rows_case c = case_make(index);
        outcome expected = run(&c, CRV_ISA_SCALAR);
        const size_t count = (size_t)c.desc.width * (size_t)c.desc.height;
        const size_t inner = (size_t)c.input.image.width * (size_t)c.input.image.height;
        for (int isa = 1; crv_isa_name((crv_isa)isa); isa++) {
            if (!(crv_isa_available() >> isa & 1))
                continue;
            outcome got = run(&c, (crv_isa)isa);
            assert_same("depth", (crv_isa)isa, index, expected.depth, got.depth, count);
            assert_same("normals", (crv_isa)isa, index, expected.normals, got.normals,
                        3 * count);
            assert_same("filter none", (crv_isa)isa, index, expected.filtered,
                        got.filtered, inner);
            outcome_free(&got);
        }
        outcome_free(&expected);
        free(c.depth.block);
        free(c.normals.block);
        free(c.input.block);
        free(c.typed_depth.block);
        free(c.typed_normals.block);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_sets_give_the_same_bits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
