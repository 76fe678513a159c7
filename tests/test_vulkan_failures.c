/* SPDX-License-Identifier: MIT */
/*
 * What fails around the Vulkan backend: every call of the driver that can, and every
 * allocation of memory of the host's and of the device's, in turn. Nothing may be left,
 * and one line has to say what happened. The driver's calls fail in a table of functions
 * that this host gives instead of the loader's, so that no driver has to play along.
 */
#define _GNU_SOURCE /* dladdr() */
#include "fixture.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "vulkan_driver.h"
#include "vulkan_engine.h"

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
    s->held += memory ? 1 : 0;
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
/* Device-local, host-visible. */
static const VkDeviceSize BLOCK_BYTES[2] = {8 << 20, 8 << 20};

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
    l->host.get_instance_proc_addr = vulkan_driver_get; /* it counts objects */
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
    const crv_const_image depth = crv_const_image_packed(l->planes[0], WIDTH, HEIGHT, 1);
    const crv_image result = crv_image_packed(l->planes[1], WIDTH, HEIGHT, 1);
    crv_device_time times[CRV_MAX_DEVICE_TIMES];
    int32_t count = 0;
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
    if (status == CRV_OK)
        status = crv_plan_device_times(plan, times, &count);
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
    crv_device_time times[CRV_MAX_DEVICE_TIMES];
    int32_t count = 0;
    crv_status status = crv_vulkan_context_create(&l->desc, &l->host, &context);
    if (status == CRV_OK)
        status = crv_vulkan_pass_create(context, &options, &size, &desc, &pass);
    if (status == CRV_OK)
        status = record(l, pass, 0);
    if (status == CRV_OK)
        status = crv_vulkan_pass_times(pass, 0, times, &count);
    if (status == CRV_OK)
        status = run_plan(l, context, &options, &size);
    crv_vulkan_pass_destroy(pass);
    crv_context_destroy(context);
    assert_int_equal(l->memory.held, 0);
    assert_int_equal(driver.objects, 0);
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

static void calls_fail_with(engine *e, VkResult result, crv_status status)
{
    life *l = begin_life(e);
    driver.result = result;
    /* Each of the functions is called at least once. */
    assert_true(live_until_done(l, &driver.due, &driver.calls, status)
                >= vulkan_driver_functions());
    end_life(l);
}

static void every_call_of_the_driver_may_fail(void **state)
{
    calls_fail_with(*state, VK_ERROR_OUT_OF_DEVICE_MEMORY, CRV_ERROR_OUT_OF_MEMORY);
}

/* The ways out are those of memory, which the layer has watched: here they are quick. */
static void the_device_may_be_lost_at_every_call(void **state)
{
    engine plain;
    (void)state;
    assert_int_equal(engine_open(&plain, 0), 0);
    calls_fail_with(&plain, VK_ERROR_DEVICE_LOST, CRV_ERROR_DEVICE);
    engine_close(&plain);
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

static const char *failed_call; /* for which the last allocation that failed was */

static VKAPI_ATTR void *VKAPI_CALL allocate_for_driver(void *user, size_t size,
                                                       size_t alignment,
                                                       VkSystemAllocationScope scope)
{
    source *s = user;
    const int fails = source_is_due(s);
    (void)scope;
    if (fails)
        failed_call = driver.call;
    unsigned char *memory =
        !fails && alignment <= HEADER
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

static VkAllocationCallbacks callbacks_of(source *memory)
{
    return (VkAllocationCallbacks){.pUserData = memory,
                                   .pfnAllocation = allocate_for_driver,
                                   .pfnReallocation = reallocate_for_driver,
                                   .pfnFree = free_of_driver};
}

static void the_callbacks_of_the_host_get_back_what_they_gave(void **state)
{
    life *l = begin_life(*state);
    source memory = {0};
    const VkAllocationCallbacks callbacks = callbacks_of(&memory);
    l->host.callbacks = &callbacks;
    assert_int_equal(live(l), CRV_OK);
    assert_true(memory.calls > 0);
    assert_int_equal(memory.held, 0);
    end_life(l);
}

/*
 * ---- callbacks that give nothing ----
 *
 * What the driver makes of it is its own: it may crash, and it may keep what it had taken
 * for an object that it then did not make. Hence another process lives, and says before
 * each life which allocation will fail; if it crashes inside the driver the next one
 * goes on behind that. Everything else that goes wrong is Crevice's.
 */

static const char *this_program;
static int first_due; /* of this process, if it is the other one */

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SANITIZED 1
#endif
#endif

/* Tells of the innermost object that is neither the C library nor this program, and of
 * the call for which it had been refused memory and in which it still is. */
static void tell_of_crash(int number)
{
    void *frames[64];
    const int count = backtrace(frames, 64);
    Dl_info here, info;
    dladdr((void *)(uintptr_t)tell_of_crash, &here);
    for (int i = 1; i < count; i++) {
        if (!dladdr(frames[i], &info) || !info.dli_fname
            || strcmp(info.dli_fname, here.dli_fname) == 0
            || strstr(info.dli_fname, "/libc.so"))
            continue;
        printf("crash %s in %s\n", info.dli_fname,
               driver.call && driver.call == failed_call ? driver.call : "another call");
        break;
    }
    fflush(stdout);
    _exit(128 + number);
}

static void lives_of_the_other_process(void **state)
{
    life *l = begin_life(*state);
    source memory = {0};
    const VkAllocationCallbacks callbacks = callbacks_of(&memory);
    const int signals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGABRT};
    crv_status status = CRV_ERROR_DEVICE;
    l->host.callbacks = &callbacks;
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
        signal(signals[i], tell_of_crash);
    for (int n = first_due; memory.calls >= memory.due; n++) {
        printf("life %d\n", n);
        fflush(stdout);
        memory = (source){.due = n};
        l->errors = 0;
        status = live(l); /* it asserts that objects and our own memory are given back */
        if (status == CRV_OK && memory.calls >= n) {
            printf("unimpressed\n"); /* it did without */
        } else if (status != CRV_OK && status != CRV_ERROR_OUT_OF_MEMORY
                   && status != CRV_ERROR_DEVICE) {
            fail_msg("allocation %d: status %d", n, (int)status);
        }
        if (l->errors != (status != CRV_OK))
            fail_msg("allocation %d: %d lines", n, l->errors);
        if (memory.held)
            printf("kept\n"); /* by the driver: no object is left */
    }
    assert_int_equal(status, CRV_OK);
    assert_int_equal(memory.held, 0);
    printf("done\n");
    end_life(l);
}

typedef struct verdict {
    int life, crashes, kept, unimpressed, done, ours;
    char told[4096]; /* lines about crashes of the driver, each once */
} verdict;

static void read_line(verdict *v, const char *line)
{
    if (sscanf(line, "life %d", &v->life) == 1)
        return;
    v->done += strcmp(line, "done\n") == 0;
    v->kept += strcmp(line, "kept\n") == 0;
    v->unimpressed += strcmp(line, "unimpressed\n") == 0;
    if (strncmp(line, "crash ", 6) == 0) {
        const int drivers = strstr(line, "vulkan_") && !strstr(line, "crevice")
                            && !strstr(line, "another call");
        v->crashes += drivers;
        v->ours += !drivers;
        if (!drivers || !strstr(v->told, line))
            print_message("allocation %d: %s", v->life, line);
        if (!strstr(v->told, line) && strlen(v->told) + strlen(line) < sizeof v->told)
            strcat(v->told, line);
    } else if (strncmp(line, "ERROR: ", 7) == 0) {
        print_message("%s", line);
    }
}

static void every_allocation_of_the_callbacks_may_fail(void **state)
{
    char command[512], line[512];
    verdict v = {0};
    (void)state;
#ifdef SANITIZED
    skip(); /* they catch signals themselves; other tests take the same ways out */
#endif
    for (int from = 1; !v.done; from = v.life + 1) {
        const int crashes = v.crashes;
        snprintf(command, sizeof command, "\"%s\" --lives-from %d 2>&1", this_program,
                 from);
        FILE *other = popen(command, "r");
        assert_non_null(other);
        while (fgets(line, sizeof line, other))
            read_line(&v, line);
        const int failed = pclose(other) != 0;
        if (v.ours || failed != (v.crashes > crashes) || v.life < from)
            fail_msg("allocation %d: it did not end well", v.life);
    }
    print_message("%d allocations: the driver crashed at %d, did without %d, and kept "
                  "memory after %d\n",
                  v.life - 1, v.crashes, v.unimpressed, v.kept);
    assert_true(v.life > 10);
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
        assert_true((status == CRV_OK) == !!context);
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

/* test_vulkan_failures --lives-from N */
static int live_here(const char *from)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lives_of_the_other_process)};
    first_due = (int)strtol(from, NULL, 10);
    if (engine_open(&the_engine, 0) != 0)
        return 1;
    const int failed = cmocka_run_group_tests(tests, engine_tests_setup, NULL);
    engine_close(&the_engine);
    return failed;
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_call_of_the_driver_may_fail),
        cmocka_unit_test(the_device_may_be_lost_at_every_call),
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(every_piece_of_device_memory_may_fail),
        cmocka_unit_test(recording_allocates_nothing),
        cmocka_unit_test(the_callbacks_of_the_host_get_back_what_they_gave),
        cmocka_unit_test(every_allocation_of_the_callbacks_may_fail),
        cmocka_unit_test(a_window_may_be_resized_for_ever),
        cmocka_unit_test(a_device_of_ones_own_may_fail),
    };
    if (argc == 3 && strcmp(argv[1], "--lives-from") == 0)
        return live_here(argv[2]);
    this_program = argv[0];
    const int refused = engine_tests_begin();
    if (refused)
        return refused;
    return engine_tests_end(cmocka_run_group_tests(tests, engine_tests_setup, NULL));
}
