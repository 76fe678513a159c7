/* SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include <math.h>
#include <string.h>

enum { MAX_SIDE = 40, MAX_INPUT = 8192 };

/* Blocks, and the call that fails; 0: none. */
typedef struct allocator {
    int taken, calls, failing;
} allocator;

static void *take(void *user, size_t size, size_t alignment)
{
    allocator *a = user;
    if (++a->calls == a->failing)
        return NULL;
    a->taken++;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void give_back(void *user, void *memory, size_t size)
{
    (void)size;
    ((allocator *)user)->taken--;
    free(memory);
}

/* Costly numbers are made small, or a run takes minutes. */
static double affordable(const crv_option *option, double value)
{
    enum { MOST = 8 };
    static const char *const costly[] = {"directions", "steps", "normal_rays", "samples"};
    for (size_t i = 0; i < sizeof costly / sizeof *costly; i++)
        if (!strcmp(option->key, costly[i]) && value > MOST && value <= option->max)
            return fmod(value, MOST) + option->min;
    return value;
}

static void set_option(fuzz_bytes *in, crv_options *o)
{
    const crv_option *option =
        crv_option_at((int32_t)(fuzz_byte(in) % (uint32_t)crv_option_count()));
    const double share = fuzz_byte(in) / 255.0;
    double value = option->min + (option->max - option->min) * share;
    char text[64];
    if (fuzz_seldom(in, 4))
        value = (double)fuzz_float(in, (float)option->default_value);
    if (option->type != CRV_OPTION_FLOAT)
        value = floor(value);
    snprintf(text, sizeof text, "%.17g", affordable(option, value));
    if (option->type != CRV_OPTION_CHOICE)
        crv_options_set(o, option->key, text, &fuzz_logger);
    else if (value >= 0.0 && value <= option->max)
        crv_options_set(o, option->key, option->choices[(int)value], &fuzz_logger);
}

/* Some by the option table, some straight into the struct. */
static crv_options make_options(fuzz_bytes *in)
{
    crv_options o;
    const int32_t method = (int32_t)(fuzz_byte(in) % (uint32_t)crv_method_count());
    crv_options_init(&o, sizeof o, crv_method_at(method)->name);
    o.directions = 2;
    o.steps = 3;
    o.samples = 4;
    const uint32_t filter = fuzz_byte(in), filters = (uint32_t)crv_filter_count();
    o.filter =
        crv_filter_at((int32_t)(filter % (filters + 1))); /* NULL beyond the last */
    o.bent_normal = filter >= 192;
    for (uint32_t changes = fuzz_byte(in) % 12; changes > 0; changes--)
        set_option(in, &o);
    if (fuzz_seldom(in, 8))
        o.radius = fuzz_float(in, 1.0f);
    if (fuzz_seldom(in, 32))
        o.noise_size = fuzz_int(in, 70);
    if (fuzz_seldom(in, 32))
        o.intensity = fuzz_float(in, 1.0f);
    if (fuzz_seldom(in, 32))
        o.falloff = (crv_falloff)(fuzz_byte(in) % 8);
    if (fuzz_seldom(in, 32))
        o.struct_size = fuzz_byte(in) * 2;
    return o;
}

static crv_gbuffer_desc make_desc(fuzz_bytes *in)
{
    crv_gbuffer_desc d;
    const int32_t width = 1 + (int32_t)(fuzz_byte(in) % MAX_SIDE);
    const int32_t height = 1 + (int32_t)(fuzz_byte(in) % MAX_SIDE);
    crv_gbuffer_desc_init(&d, sizeof d, width, height);
    const uint32_t kind = fuzz_byte(in);
    d.layers = 1 + (int32_t)(kind & 3);
    d.layer_kind = (crv_layers)(kind >> 2 & 1);
    int32_t *const guards[] = {&d.guard_left, &d.guard_top, &d.guard_right,
                               &d.guard_bottom};
    for (int i = 0; i < 4; i++)
        if (kind >> (3 + i) & 1)
            *guards[i] = fuzz_int(in, 12);
    if (kind & 128) {
        d.origin_x = (int32_t)fuzz_word(in);
        d.origin_y = (int32_t)fuzz_word(in);
    }
    if (fuzz_seldom(in, 32))
        d.layers = fuzz_int(in, 6);
    if (fuzz_seldom(in, 32))
        d.layer_kind = (crv_layers)(fuzz_byte(in) % 4);
    if (fuzz_seldom(in, 32))
        d.struct_size = fuzz_byte(in);
    if (d.struct_size < sizeof d) /* as the library takes it: an older struct's */
        memset((char *)&d + d.struct_size, 0, sizeof d - d.struct_size);
    return d;
}

static crv_camera make_camera(fuzz_bytes *in, const crv_gbuffer_desc *d)
{
    const uint32_t kind = fuzz_byte(in);
    crv_camera c = kind & 1 ? crv_camera_perspective(d->width, d->height, 1.0f)
                            : crv_camera_orthographic(d->width, d->height, 4.0f);
    if ((kind & 6) == 6) {
        c.fx_px = fuzz_float(in, 20.0f);
        c.fy_px = fuzz_float(in, 20.0f);
    }
    if ((kind & 24) == 24) {
        c.cx_px = fuzz_float(in, 8.0f);
        c.cy_px = fuzz_float(in, 8.0f);
    }
    if ((kind & 224) == 224)
        c.world_to_view[fuzz_byte(in) % 9] = fuzz_float(in, 1.0f);
    if (fuzz_seldom(in, 64))
        c.projection = (crv_projection)(fuzz_byte(in) % 4);
    return c;
}

static float sphere(void *user, const float p[3], float gradient[3])
{
    (void)user;
    for (int i = 0; i < 3; i++)
        gradient[i] = 2.0f * p[i];
    return p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - 1.0f;
}

static void set_field(fuzz_bytes *in, crv_gbuffer *g, const crv_gbuffer_desc *d)
{
    const uint32_t kind = fuzz_byte(in) % 8;
    if (kind == 0)
        crv_gbuffer_set_implicit(g, sphere, NULL);
    if (kind != 1)
        return;
    fuzz_pixels uv = fuzz_fill_pixels(in, d->width, d->height, 2, 0.5f);
    fuzz_pixels tangent = fuzz_fill_pixels(in, d->width, d->height, 3, 1.0f);
    fuzz_pixels bitangent = fuzz_fill_pixels(in, d->width, d->height, 3, 1.0f);
    fuzz_pixels height = fuzz_fill_pixels(in, 1 + (int32_t)(fuzz_byte(in) % 9),
                                          1 + (int32_t)(fuzz_byte(in) % 9), 1, 0.5f);
    crv_height_field field = {.uv = crv_image_const(uv.image),
                              .tangent = crv_image_const(tangent.image),
                              .bitangent = crv_image_const(bitangent.image),
                              .height = crv_image_const(height.image),
                              .scale = fuzz_float(in, 0.1f),
                              .wrap = (crv_wrap)(fuzz_byte(in) % 3)};
    crv_gbuffer_set_height_field(g, &field);
    free(uv.block);
    free(tangent.block);
    free(bitangent.block);
    free(height.block);
}

static void set_frame(fuzz_bytes *in, crv_gbuffer *g, const crv_gbuffer_desc *d)
{
    const crv_camera camera = make_camera(in, d);
    crv_gbuffer_set_camera(g, &camera);
    for (int32_t layer = 0; layer < d->layers; layer++) {
        fuzz_pixels depth = fuzz_fill_pixels(in, d->width, d->height, 1, 2.0f);
        crv_depth_format format = crv_depth_format_planar();
        if (fuzz_seldom(in, 4)) {
            format.encoding = (crv_depth_encoding)(fuzz_byte(in) % 10);
            format.z_near = fuzz_float(in, 0.1f);
            format.z_far = fuzz_float(in, 100.0f);
            format.background = fuzz_float(in, 100.0f);
        }
        fuzz_spoil(in, &depth.image);
        const crv_const_image image = crv_image_const(depth.image);
        crv_gbuffer_set_depth(g, fuzz_seldom(in, 32) ? fuzz_int(in, 5) : layer, &image,
                              &format);
        free(depth.block);
        if (fuzz_seldom(in, 8)) {
            fuzz_texels texels = fuzz_make_texels(in, d->width, d->height, 1);
            crv_gbuffer_set_depth_texels(g, layer, &texels.texels, &format);
            free(texels.block);
        }
    }
    if (fuzz_byte(in) & 1) {
        fuzz_pixels normals = fuzz_fill_pixels(in, d->width, d->height, 3, 0.5f);
        fuzz_spoil(in, &normals.image);
        const crv_const_image image = crv_image_const(normals.image);
        crv_gbuffer_set_normals(g, &image, (crv_normal_space)(fuzz_byte(in) % 3));
        free(normals.block);
    }
    if (fuzz_seldom(in, 8)) {
        fuzz_texels texels = fuzz_make_texels(in, d->width, d->height, 3);
        crv_gbuffer_set_normals_texels(g, &texels.texels,
                                       (crv_normal_space)(fuzz_byte(in) % 3));
        free(texels.block);
    }
    set_field(in, g, d);
}

static void check_lengths(const crv_image *image)
{
    for (int32_t y = 0; y < image->height; y++)
        for (int32_t x = 0; x < image->width; x++) {
            float square = 0.0f;
            for (int32_t c = 0; c < 3; c++) {
                const float n = *crv_image_at(image, x, y, c);
                square += n * n;
            }
            /* Rounding of three squares of floats; 0 is background. */
            FUZZ_CHECK(square == 0.0f || fabsf(square - 1.0f) < 1e-4f,
                       "squared length %g", (double)square);
        }
}

static void check_normals(fuzz_bytes *in, crv_gbuffer *g, const crv_gbuffer_desc *d)
{
    fuzz_pixels normals = fuzz_make_pixels(in, d->width, d->height, 3);
    if (crv_gbuffer_get_normals(g, &normals.image) == CRV_OK)
        check_lengths(&normals.image);
    free(normals.block);
}

/* Plans without bent normals refuse. */
static void run_bent(fuzz_bytes *in, crv_plan *plan, crv_gbuffer *g, int32_t width,
                     int32_t height)
{
    fuzz_pixels bent = fuzz_make_pixels(in, width, height, 3);
    crv_result result;
    crv_result_init(&result, sizeof result);
    result.bent_normal = bent.image;
    if (crv_plan_run_result(plan, g, &result) == CRV_OK)
        check_lengths(&bent.image);
    fuzz_spoil(in, &result.bent_normal);
    if (memcmp(&result.bent_normal, &bent.image, sizeof bent.image))
        crv_plan_run_result(plan, g, &result);
    free(bent.block);
}

static void run(fuzz_bytes *in, crv_plan *plan, crv_gbuffer *g, const crv_gbuffer_desc *d,
                const char *method)
{
    const int32_t width = d->width - d->guard_left - d->guard_right;
    const int32_t height = d->height - d->guard_top - d->guard_bottom;
    fuzz_pixels result = fuzz_make_pixels(in, width, height, 1);
    crv_image spoilt = result.image;
    fuzz_spoil(in, &spoilt);
    if (memcmp(&spoilt, &result.image, sizeof spoilt))
        crv_plan_run(plan, g, &spoilt);
    if (crv_plan_run(plan, g, &result.image) == CRV_OK) {
        fuzz_check_pixels(&result.image, 0.0f, 1.0f, method);
        fuzz_pixels given = fuzz_fill_pixels(in, width, height, 1, 0.5f);
        const crv_const_image input = crv_image_const(given.image);
        if (crv_plan_filter(plan, g, &input, &result.image) == CRV_OK)
            for (int32_t y = 0; y < height; y++)
                for (int32_t x = 0; x < width; x++)
                    FUZZ_CHECK(isfinite(*crv_image_at(&result.image, x, y, 0)),
                               "filtered: %d, %d", x, y);
        free(given.block);
        const int32_t samples = 2 + (int32_t)(fuzz_byte(in) % 7);
        fuzz_pixels depths = fuzz_fill_pixels(in, width, height, samples, 2.0f);
        fuzz_pixels gathered = fuzz_make_pixels(in, width, height, samples);
        const crv_const_image estimate = crv_image_const(result.image);
        const crv_const_image sample_depth = crv_image_const(depths.image);
        if (crv_multisample_gather(g, &estimate, &sample_depth, NULL,
                                   fuzz_float(in, 1.0f), &gathered.image)
            == CRV_OK)
            for (int32_t y = 0; y < height; y++)
                for (int32_t x = 0; x < width; x++)
                    FUZZ_CHECK(
                        isfinite(*crv_image_at(&gathered.image, x, y, samples - 1)),
                        "gathered: %d, %d", x, y);
        free(depths.block);
        free(gathered.block);
        run_bent(in, plan, g, width, height);
    }
    free(result.block);
}

static void use(fuzz_bytes *in, crv_context *context)
{
    const crv_gbuffer_desc d = make_desc(in);
    const crv_options o = make_options(in), other = make_options(in);
    crv_gbuffer *g = NULL;
    crv_plan *plan = NULL;
    if (crv_gbuffer_create(context, &d, &g) == CRV_OK
        && crv_plan_create(context, &o, &d, &plan) == CRV_OK)
        for (int frame = 0; frame < 2; frame++) {
            set_frame(in, g, &d);
            run(in, plan, g, &d, o.method->name);
            check_normals(in, g, &d);
            if (crv_plan_set_options(plan, &other) == CRV_OK)
                run(in, plan, g, &d, other.method->name);
        }
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(g);
}

void fuzz_api(const uint8_t *data, size_t size)
{
    static const uint32_t sets[] = {1u << CRV_ISA_SCALAR, 1u << CRV_ISA_SSE4,
                                    1u << CRV_ISA_AVX2, 1u << CRV_ISA_AVX512, 0};
    fuzz_bytes in = {data, size};
    allocator a = {0};
    crv_context_desc desc;
    crv_context *context = NULL;
    if (size < 16 || size > MAX_INPUT)
        return;
    crv_context_desc_init(&desc, sizeof desc);
    const uint32_t kind = fuzz_byte(&in);
    desc.logger = fuzz_logger;
    desc.allocator = (crv_allocator){take, give_back, &a};
    desc.threads = 1;
    desc.isa_mask = sets[kind % 5];
    desc.exact = (kind & 128) != 0;
    a.failing = kind & 64 ? (int)(fuzz_byte(&in) % 64) : 0;
    if (crv_context_create(&desc, &context) == CRV_OK)
        use(&in, context);
    else
        FUZZ_CHECK(a.failing > 0, "no context");
    crv_context_destroy(context);
    FUZZ_CHECK(a.taken == 0, "%d blocks are left", a.taken);
}
