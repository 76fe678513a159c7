/* SPDX-License-Identifier: MIT */
/*
 * What fails around the Vulkan backend: every call of the driver that can, and every
 * allocation of memory of the host's and of the device's, in turn. Nothing may be left,
 * and one line has to say what happened. The driver's calls fail in a table of functions
 * that this host gives instead of the loader's, so that no driver has to play along.
 */
#include "fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "vulkan_engine.h"

/* ---- calls of the driver ---- */

/* A function of Vulkan knows of no user pointer. */
static struct {
    int calls; /* so far */
    int due;   /* the call that fails, from 1; 0: none */
    VkResult result;
} driver;

static int is_due(void)
{
    driver.calls++;
    return driver.calls == driver.due;
}

#define CREATES(F)                                                                       \
    F(CreateBuffer, VkBufferCreateInfo, VkBuffer)                                        \
    F(CreateImage, VkImageCreateInfo, VkImage)                                           \
    F(CreateImageView, VkImageViewCreateInfo, VkImageView)                               \
    F(CreateSampler, VkSamplerCreateInfo, VkSampler)                                     \
    F(CreateDescriptorSetLayout, VkDescriptorSetLayoutCreateInfo, VkDescriptorSetLayout) \
    F(CreateDescriptorPool, VkDescriptorPoolCreateInfo, VkDescriptorPool)                \
    F(CreatePipelineLayout, VkPipelineLayoutCreateInfo, VkPipelineLayout)                \
    F(CreateShaderModule, VkShaderModuleCreateInfo, VkShaderModule)                      \
    F(CreateCommandPool, VkCommandPoolCreateInfo, VkCommandPool)                         \
    F(CreateFence, VkFenceCreateInfo, VkFence)                                           \
    F(CreateQueryPool, VkQueryPoolCreateInfo, VkQueryPool)                               \
    F(AllocateMemory, VkMemoryAllocateInfo, VkDeviceMemory)

#define DEFINE(name, info_type, handle_type)                                             \
    static VKAPI_ATTR VkResult VKAPI_CALL fail_##name(                                   \
        VkDevice device, const info_type *info, const VkAllocationCallbacks *callbacks,  \
        handle_type *out)                                                                \
    {                                                                                    \
        return is_due() ? driver.result : vk##name(device, info, callbacks, out);        \
    }
CREATES(DEFINE)
#undef DEFINE

/* The others: parameters, and the same as arguments. */
#define OTHERS(F)                                                                        \
    F(AllocateDescriptorSets,                                                            \
      (VkDevice d, const VkDescriptorSetAllocateInfo *i, VkDescriptorSet *out),          \
      (d, i, out))                                                                       \
    F(AllocateCommandBuffers,                                                            \
      (VkDevice d, const VkCommandBufferAllocateInfo *i, VkCommandBuffer *out),          \
      (d, i, out))                                                                       \
    F(BindBufferMemory, (VkDevice d, VkBuffer b, VkDeviceMemory m, VkDeviceSize o),      \
      (d, b, m, o))                                                                      \
    F(BindImageMemory, (VkDevice d, VkImage b, VkDeviceMemory m, VkDeviceSize o),        \
      (d, b, m, o))                                                                      \
    F(MapMemory,                                                                         \
      (VkDevice d, VkDeviceMemory m, VkDeviceSize o, VkDeviceSize s, VkMemoryMapFlags f, \
       void **out),                                                                      \
      (d, m, o, s, f, out))                                                              \
    F(ResetCommandPool, (VkDevice d, VkCommandPool p, VkCommandPoolResetFlags f),        \
      (d, p, f))                                                                         \
    F(BeginCommandBuffer, (VkCommandBuffer c, const VkCommandBufferBeginInfo *i),        \
      (c, i))                                                                            \
    F(QueueSubmit2, (VkQueue q, uint32_t n, const VkSubmitInfo2 *s, VkFence f),          \
      (q, n, s, f))

#define DEFINE(name, parameters, arguments)                                              \
    static VKAPI_ATTR VkResult VKAPI_CALL fail_##name parameters                         \
    {                                                                                    \
        return is_due() ? driver.result : vk##name arguments;                            \
    }
OTHERS(DEFINE)
#undef DEFINE

/* These do their work and then say that it failed: commands that are half recorded and
 * fences that are not waited for would be the test's own fault. */
#define AFTERWARDS(F)                                                                    \
    F(EndCommandBuffer, (VkCommandBuffer c), (c))                                        \
    F(WaitForFences, (VkDevice d, uint32_t n, const VkFence *f, VkBool32 a, uint64_t t), \
      (d, n, f, a, t))                                                                   \
    F(ResetFences, (VkDevice d, uint32_t n, const VkFence *f), (d, n, f))

#define DEFINE(name, parameters, arguments)                                              \
    static VKAPI_ATTR VkResult VKAPI_CALL fail_##name parameters                         \
    {                                                                                    \
        const VkResult result = vk##name arguments;                                      \
        return is_due() ? driver.result : result;                                        \
    }
AFTERWARDS(DEFINE)
#undef DEFINE

/* With several pipelines, those that were made are to be given back. */
static VKAPI_ATTR VkResult VKAPI_CALL
fail_CreateComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                            const VkComputePipelineCreateInfo *infos,
                            const VkAllocationCallbacks *callbacks, VkPipeline *out)
{
    if (is_due()) {
        memset(out, 0, count * sizeof *out);
        return driver.result;
    }
    return vkCreateComputePipelines(device, cache, count, infos, callbacks, out);
}

typedef struct named {
    const char *name;
    PFN_vkVoidFunction function;
} named;

#define ROW(name, a, b) {"vk" #name, (PFN_vkVoidFunction)fail_##name},
static const named FAILING[] = {CREATES(ROW) OTHERS(ROW) AFTERWARDS(ROW){
    "vkCreateComputePipelines", (PFN_vkVoidFunction)fail_CreateComputePipelines}};
#undef ROW

static PFN_vkVoidFunction failing(const char *name)
{
    for (size_t i = 0; i < sizeof FAILING / sizeof *FAILING; i++) {
        if (strcmp(FAILING[i].name, name) == 0)
            return FAILING[i].function;
    }
    return NULL;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device,
                                                                const char *name)
{
    const PFN_vkVoidFunction f = failing(name);
    return f ? f : vkGetDeviceProcAddr(device, name);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance,
                                                                  const char *name)
{
    if (strcmp(name, "vkGetDeviceProcAddr") == 0)
        return (PFN_vkVoidFunction)device_function;
    const PFN_vkVoidFunction f = failing(name);
    return f ? f : vkGetInstanceProcAddr(instance, name);
}

/* ---- memory of the host's and of the device's ---- */

typedef struct source {
    int calls, due; /* as of the driver */
    int64_t held;   /* pieces that were given and not taken back */
} source;

static int source_is_due(source *s)
{
    s->calls++;
    return s->calls == s->due;
}

static void *allocate(void *user, size_t size, size_t alignment)
{
    source *s = user;
    void *memory = NULL;
    if (source_is_due(s) || size == 0)
        return NULL;
    const size_t least = alignment < sizeof(void *) ? sizeof(void *) : alignment;
    memory = aligned_alloc(least, (size + least - 1) / least * least);
    s->held += memory != NULL;
    return memory;
}

static void release(void *user, void *memory, size_t size)
{
    source *s = user;
    (void)size;
    assert_non_null(memory);
    s->held--;
    free(memory);
}

/* Pieces of two big blocks, one mapped, as an engine gives them. */
/* Device-local, with room for the two images of 64 MiB whose copies are timed; and
 * host-visible. */
static const VkDeviceSize BLOCK_BYTES[2] = {(128 + 8) << 20, 8 << 20};

typedef struct device_source {
    source pieces;
    const engine *engine;
    VkDeviceMemory block[2];
    unsigned char *mapped;
    VkDeviceSize used[2];
} device_source;

static VkResult allocate_piece(void *user, const VkMemoryRequirements *requirements,
                               VkMemoryPropertyFlags needed, crv_vulkan_block *out)
{
    device_source *d = user;
    const int visible = (needed & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0;
    const VkDeviceSize offset = (d->used[visible] + requirements->alignment - 1)
                                / requirements->alignment * requirements->alignment;
    if (source_is_due(&d->pieces) || offset + requirements->size > BLOCK_BYTES[visible])
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    d->used[visible] = offset + requirements->size;
    d->pieces.held++;
    *out = (crv_vulkan_block){d->block[visible], offset,
                              visible ? d->mapped + offset : NULL, d};
    return VK_SUCCESS;
}

static void release_piece(void *user, const crv_vulkan_block *block)
{
    device_source *d = user;
    assert_ptr_equal(block->token, d);
    if (--d->pieces.held == 0)
        d->used[0] = d->used[1] = 0;
}

static uint32_t memory_type(const engine *e, VkMemoryPropertyFlags flags)
{
    VkPhysicalDeviceMemoryProperties heaps;
    uint32_t type = 0;
    vkGetPhysicalDeviceMemoryProperties(e->h.physical, &heaps);
    while (type + 1 < heaps.memoryTypeCount
           && (heaps.memoryTypes[type].propertyFlags & flags) != flags)
        type++;
    return type;
}

static device_source open_blocks(const engine *e)
{
    device_source d = {.engine = e};
    for (int visible = 0; visible < 2; visible++) {
        const VkMemoryAllocateInfo info = {
            .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
            .allocationSize = BLOCK_BYTES[visible],
            .memoryTypeIndex =
                memory_type(e, visible ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT
                                             | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
                                       : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)};
        host_check(vkAllocateMemory(e->h.device, &info, NULL, &d.block[visible]),
                   "block");
    }
    void *mapped = NULL;
    host_check(vkMapMemory(e->h.device, d.block[1], 0, VK_WHOLE_SIZE, 0, &mapped), "map");
    d.mapped = mapped;
    return d;
}

static void close_blocks(device_source *d)
{
    vkFreeMemory(d->engine->h.device, d->block[0], NULL);
    vkFreeMemory(d->engine->h.device, d->block[1], NULL);
}

/* ---- one life of a context ---- */

enum { WIDTH = 48, HEIGHT = 32, PIXELS = WIDTH * HEIGHT };

typedef struct life {
    engine *engine;
    crv_vulkan_host host;
    crv_context_desc desc;
    source memory;
    int errors; /* lines */
    host_image depth, result;
    float planes[2][PIXELS];
} life;

static void count_line(void *user, crv_log_level level, const char *line)
{
    life *l = user;
    l->errors += level == CRV_LOG_ERROR;
    assert_true(strlen(line) > 10);
}

static life *begin_life(engine *e)
{
    life *l = calloc(1, sizeof *l);
    assert_non_null(l);
    l->engine = e;
    l->host = engine_host(e);
    crv_context_desc_init(&l->desc, sizeof l->desc);
    l->desc.logger = (crv_logger){.fn = count_line, .user = l};
    l->desc.allocator =
        (crv_allocator){.allocate = allocate, .release = release, .user = &l->memory};
    for (int i = 0; i < PIXELS; i++)
        l->planes[0][i] = 3 + 0.01f * (float)(i % WIDTH);
    l->depth = engine_upload(e, VK_FORMAT_R32_SFLOAT, WIDTH, HEIGHT, l->planes[0],
                             sizeof l->planes[0]);
    l->result = engine_result(e, VK_FORMAT_R32_SFLOAT, WIDTH, HEIGHT);
    return l;
}

static void end_life(life *l)
{
    host_image_free(&l->engine->h, &l->depth);
    host_image_free(&l->engine->h, &l->result);
    free(l);
}

static crv_status record(life *l, crv_vulkan_pass *pass, int index)
{
    crv_vulkan_frame frame;
    crv_vulkan_frame_init(&frame, sizeof frame);
    frame.index = index;
    frame.camera = crv_camera_perspective(WIDTH, HEIGHT, 1);
    frame.depth[0].view = l->depth.view;
    frame.result = l->result.image;
    frame.result_view = l->result.view;
    frame.result_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL; /* as its usage allows */
    const crv_status status =
        crv_vulkan_pass_record(pass, engine_begin(l->engine, 0), &frame);
    engine_submit(l->engine, 0);
    engine_wait(l->engine);
    return status;
}

static crv_vulkan_pass_desc pass_desc(void)
{
    crv_vulkan_pass_desc desc;
    crv_vulkan_pass_desc_init(&desc, sizeof desc);
    desc.depth_format = VK_FORMAT_R32_SFLOAT;
    desc.result_format = VK_FORMAT_R32_SFLOAT;
    desc.timestamps = VK_TRUE;
    return desc;
}

static crv_options short_options(void)
{
    crv_options options = fixture_options("ssao"); /* the quickest to compile */
    assert_int_equal(crv_options_set(&options, "filter", "gauss5", NULL), CRV_OK);
    return options;
}

static crv_status run_plan(life *l, crv_context *context, const crv_options *options,
                           const crv_gbuffer_desc *size)
{
    const crv_camera camera = crv_camera_perspective(WIDTH, HEIGHT, 1);
    const crv_image depth = crv_image_packed(l->planes[0], WIDTH, HEIGHT, 1);
    const crv_image result = crv_image_packed(l->planes[1], WIDTH, HEIGHT, 1);
    crv_gbuffer *gbuffer = NULL;
    crv_plan *plan = NULL;
    crv_status status = crv_gbuffer_create(context, size, &gbuffer);
    if (status == CRV_OK)
        status = crv_gbuffer_set_camera(gbuffer, &camera);
    if (status == CRV_OK)
        status = crv_gbuffer_set_depth(gbuffer, 0, &depth, NULL);
    if (status == CRV_OK)
        status = crv_plan_create(context, options, size, &plan);
    if (status == CRV_OK)
        status = crv_plan_run(plan, gbuffer, &result);
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(gbuffer);
    return status;
}

/* A context, a pass of two frames in flight, a frame; a plan, a run. */
static crv_status live(life *l)
{
    const crv_vulkan_pass_desc desc = pass_desc();
    const crv_options options = short_options();
    crv_gbuffer_desc size;
    crv_gbuffer_desc_init(&size, sizeof size, WIDTH, HEIGHT);
    crv_context *context = NULL;
    crv_vulkan_pass *pass = NULL;
    double bandwidth = 0;
    crv_status status = crv_vulkan_context_create(&l->desc, &l->host, &context);
    if (status == CRV_OK)
        status = crv_vulkan_pass_create(context, &options, &size, &desc, &pass);
    if (status == CRV_OK)
        status = record(l, pass, 0);
    if (status == CRV_OK)
        status = run_plan(l, context, &options, &size);
    if (status == CRV_OK) /* last: it takes the longest */
        status = crv_context_device_bandwidth(context, &bandwidth);
    assert_true(status != CRV_OK || bandwidth > 0);
    crv_vulkan_pass_destroy(pass);
    crv_context_destroy(context);
    assert_int_equal(l->memory.held, 0);
    return status;
}

/* Lives until nothing fails any more; how often something did. */
static int live_until_done(life *l, int *due, int *calls, crv_status wanted)
{
    for (int n = 1; n < 1000; n++) {
        *calls = 0;
        *due = n;
        l->errors = 0;
        const crv_status status = live(l);
        if (status == CRV_OK) {
            assert_int_equal(l->errors, 0);
            *due = 0;
            return n - 1;
        }
        if (status != wanted)
            fail_msg("failure %d: status %d, not %d", n, (int)status, (int)wanted);
        if (l->errors != 1)
            fail_msg("failure %d: %d lines", n, l->errors);
    }
    fail_msg("it fails for ever");
    return -1;
}

static void every_call_of_the_driver_may_fail(void **state)
{
    static const struct {
        VkResult result;
        crv_status status;
    } CASES[] = {{VK_ERROR_OUT_OF_DEVICE_MEMORY, CRV_ERROR_OUT_OF_MEMORY},
                 {VK_ERROR_DEVICE_LOST, CRV_ERROR_DEVICE}};
    life *l = begin_life(*state);
    l->host.get_instance_proc_addr = instance_function;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        driver.result = CASES[i].result;
        const int failures =
            live_until_done(l, &driver.due, &driver.calls, CASES[i].status);
        /* Each of the functions above is called at least once. */
        assert_true(failures >= (int)(sizeof FAILING / sizeof *FAILING));
    }
    end_life(l);
}

static void every_allocation_may_fail(void **state)
{
    life *l = begin_life(*state);
    assert_true(
        live_until_done(l, &l->memory.due, &l->memory.calls, CRV_ERROR_OUT_OF_MEMORY)
        > 5);
    end_life(l);
}

static void every_piece_of_device_memory_may_fail(void **state)
{
    life *l = begin_life(*state);
    device_source blocks = open_blocks(*state);
    l->host.memory = (crv_vulkan_memory){allocate_piece, release_piece, &blocks};
    assert_true(live_until_done(l, &blocks.pieces.due, &blocks.pieces.calls,
                                CRV_ERROR_OUT_OF_MEMORY)
                > 8);
    assert_int_equal(blocks.pieces.held, 0);
    close_blocks(&blocks);
    end_life(l);
}

/* Calls fail in turn until a path has been measured: the others do the same again. */
static void measuring_fetches_may_fail(void **state)
{
    life *l = begin_life(*state);
    double per_s[CRV_FETCH_PATHS][CRV_FETCH_PATTERNS] = {{0}};
    l->host.get_instance_proc_addr = instance_function;
    driver.result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    for (driver.due = 1; per_s[0][0] <= 0; driver.due++) {
        crv_context *context = NULL;
        driver.calls = l->errors = 0;
        crv_status status = crv_vulkan_context_create(&l->desc, &l->host, &context);
        if (status == CRV_OK)
            status = crv_context_device_fetches(context, per_s);
        crv_context_destroy(context);
        assert_int_equal(l->memory.held, 0);
        assert_int_equal(status, CRV_ERROR_OUT_OF_MEMORY);
        assert_int_equal(l->errors, 1);
    }
    assert_true(driver.due > 20); /* buffers, images, views, sets, runs */
    driver.due = 0;
    end_life(l);
}

/* ---- what is not a failure ---- */

static void recording_allocates_nothing(void **state)
{
    life *l = begin_life(*state);
    device_source blocks = open_blocks(*state);
    const crv_vulkan_pass_desc desc = pass_desc();
    const crv_options options = short_options();
    crv_gbuffer_desc size;
    crv_gbuffer_desc_init(&size, sizeof size, WIDTH, HEIGHT);
    crv_context *context = NULL;
    crv_vulkan_pass *pass = NULL;
    l->host.memory = (crv_vulkan_memory){allocate_piece, release_piece, &blocks};
    l->host.get_instance_proc_addr = instance_function;
    assert_int_equal(crv_vulkan_context_create(&l->desc, &l->host, &context), CRV_OK);
    assert_int_equal(crv_vulkan_pass_create(context, &options, &size, &desc, &pass),
                     CRV_OK);
    const int before = l->memory.calls + blocks.pieces.calls + driver.calls;
    for (int i = 0; i < 4; i++)
        assert_int_equal(record(l, pass, i % 2), CRV_OK);
    assert_int_equal(l->memory.calls + blocks.pieces.calls + driver.calls, before);
    crv_vulkan_pass_destroy(pass);
    crv_context_destroy(context);
    assert_int_equal(blocks.pieces.held, 0);
    close_blocks(&blocks);
    end_life(l);
}

/* Vulkan's own way to ask for host memory; it may ask for a change of size, without the
 * old one. */
enum { HEADER = 64 };

static VKAPI_ATTR void *VKAPI_CALL allocate_for_driver(void *user, size_t size,
                                                       size_t alignment,
                                                       VkSystemAllocationScope scope)
{
    source *s = user;
    (void)scope;
    s->calls++;
    unsigned char *memory =
        alignment <= HEADER
            ? aligned_alloc(HEADER, (size + 2 * HEADER - 1) / HEADER * HEADER)
            : NULL;
    if (!memory)
        return NULL;
    s->held++;
    memcpy(memory, &size, sizeof size);
    return memory + HEADER;
}

static VKAPI_ATTR void VKAPI_CALL free_of_driver(void *user, void *memory)
{
    source *s = user;
    if (!memory)
        return;
    s->held--;
    free((unsigned char *)memory - HEADER);
}

static VKAPI_ATTR void *VKAPI_CALL reallocate_for_driver(void *user, void *old,
                                                         size_t size, size_t alignment,
                                                         VkSystemAllocationScope scope)
{
    size_t before = 0;
    void *memory = size ? allocate_for_driver(user, size, alignment, scope) : NULL;
    if (old)
        memcpy(&before, (unsigned char *)old - HEADER, sizeof before);
    if (memory && old)
        memcpy(memory, old, before < size ? before : size);
    if (memory || size == 0)
        free_of_driver(user, old);
    return memory;
}

static void the_callbacks_of_the_host_get_back_what_they_gave(void **state)
{
    life *l = begin_life(*state);
    source memory = {0};
    const VkAllocationCallbacks callbacks = {.pUserData = &memory,
                                             .pfnAllocation = allocate_for_driver,
                                             .pfnReallocation = reallocate_for_driver,
                                             .pfnFree = free_of_driver};
    l->host.callbacks = &callbacks;
    assert_int_equal(live(l), CRV_OK);
    assert_true(memory.calls > 0);
    assert_int_equal(memory.held, 0);
    end_life(l);
}

static void a_window_may_be_resized_for_ever(void **state)
{
    life *l = begin_life(*state);
    device_source blocks = open_blocks(*state);
    const crv_vulkan_pass_desc desc = pass_desc();
    const crv_options options = short_options();
    crv_context *context = NULL;
    l->host.memory = (crv_vulkan_memory){allocate_piece, release_piece, &blocks};
    assert_int_equal(crv_vulkan_context_create(&l->desc, &l->host, &context), CRV_OK);
    int64_t held = -1, held_here = -1;
    for (int i = 0; i < 30; i++) {
        crv_gbuffer_desc size;
        crv_vulkan_pass *pass = NULL;
        crv_gbuffer_desc_init(&size, sizeof size, 1 + i * 7, 200 - i * 6);
        assert_int_equal(crv_vulkan_pass_create(context, &options, &size, &desc, &pass),
                         CRV_OK);
        /* Depth, normals and two of accessibility, for each of two frames; 16 bits each
         * is the least. */
        assert_true(crv_vulkan_pass_bytes(pass)
                    >= (uint64_t)size.width * (uint64_t)size.height * 2 * 4 * 2);
        assert_true(crv_vulkan_pass_bytes(pass) <= blocks.used[0] + blocks.used[1]);
        crv_vulkan_pass_destroy(pass);
        /* The context may keep pipelines, but no more with every size. */
        if (i > 0) {
            assert_int_equal(blocks.pieces.held, held);
            assert_int_equal(l->memory.held, held_here);
        }
        held = blocks.pieces.held;
        held_here = l->memory.held;
    }
    crv_context_destroy(context);
    assert_int_equal(l->memory.held, 0);
    assert_int_equal(blocks.pieces.held, 0);
    close_blocks(&blocks);
    end_life(l);
}

static void a_device_of_ones_own_may_fail(void **state)
{
    source memory = {0};
    crv_context_desc desc;
    (void)state;
    crv_context_desc_init(&desc, sizeof desc);
    desc.device = CRV_DEVICE_VULKAN;
    desc.allocator =
        (crv_allocator){.allocate = allocate, .release = release, .user = &memory};
    crv_status status = CRV_ERROR_OUT_OF_MEMORY;
    for (memory.due = 1; status; memory.due++) {
        crv_context *context = NULL;
        memory.calls = 0;
        status = crv_context_create(&desc, &context);
        assert_true(status == CRV_OK || status == CRV_ERROR_OUT_OF_MEMORY);
        assert_true((status == CRV_OK) == (context != NULL));
        crv_context_destroy(context);
        assert_int_equal(memory.held, 0);
        assert_true(memory.due < 1000);
    }
    memory.due = 0;
    desc.device_index = 999;
    crv_context *context = NULL;
    assert_int_equal(crv_context_create(&desc, &context), CRV_ERROR_UNSUPPORTED);
    assert_null(context);
    crv_device_info info;
    assert_int_equal(crv_vulkan_device_info(999, &info, NULL),
                     CRV_ERROR_INVALID_ARGUMENT);
    assert_int_equal(crv_vulkan_device_info(0, NULL, NULL), CRV_ERROR_INVALID_ARGUMENT);
}

static engine the_engine;

static int open_all(void **state)
{
    *state = &the_engine;
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_call_of_the_driver_may_fail),
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(every_piece_of_device_memory_may_fail),
        cmocka_unit_test(measuring_fetches_may_fail),
        cmocka_unit_test(recording_allocates_nothing),
        cmocka_unit_test(the_callbacks_of_the_host_get_back_what_they_gave),
        cmocka_unit_test(a_window_may_be_resized_for_ever),
        cmocka_unit_test(a_device_of_ones_own_may_fail),
    };
    if (engine_open(&the_engine, 1) != 0) {
        printf("SKIPPED: no Vulkan 1.3 device, or no validation layer\n");
        return getenv("CI") ? 1 : 77;
    }
    const int failed = cmocka_run_group_tests(tests, open_all, NULL);
    engine_close(&the_engine); /* the layer tells of every object that is left */
    return failed || the_engine.h.complaints;
}
