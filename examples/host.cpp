/* SPDX-License-Identifier: MIT */
/* The library in an engine in C++17: the engine's memory and threads, the matrix of its
 * camera and its depth buffer, frames with one plan. Usage: host [THREADS] */
#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <mutex>
#include <new>
#include <vector>
#include "crevice/crevice.h"

constexpr int WIDTH = 640, HEIGHT = 360;

// Threads that wait for loops. The thread that calls run() works, too.
struct Pool {
    using Task = void (*)(void *data, uint32_t index);
    std::mutex mutex; // of what follows
    std::condition_variable changed;
    uint32_t next = 0, count = 0, busy = 0;
    Task task = nullptr;
    void *data = nullptr;
    bool stopping = false;
    std::vector<std::future<void>> threads; // destroyed first, which waits for them

    explicit Pool(int size)
    {
        while (--size > 0)
            threads.push_back(std::async(std::launch::async, [this] {
                for (std::unique_lock<std::mutex> lock(mutex); !stopping; work(lock))
                    changed.wait(lock, [this] { return stopping || next < count; });
            }));
    }
    ~Pool()
    {
        mutex.lock(), stopping = true, mutex.unlock();
        changed.notify_all();
    }
    void work(std::unique_lock<std::mutex> &lock)
    {
        while (next < count) {
            const uint32_t index = next++;
            busy++, lock.unlock();
            task(data, index);
            lock.lock(), busy--;
        }
        changed.notify_all();
    }
    static void run(void *user, uint32_t count, Task task, void *data)
    {
        Pool &pool = *static_cast<Pool *>(user);
        std::unique_lock<std::mutex> lock(pool.mutex);
        pool.task = task, pool.data = data, pool.next = 0, pool.count = count;
        pool.changed.notify_all();
        pool.work(lock);
        pool.changed.wait(lock, [&pool] { return pool.busy == 0; });
    }
};

static void check(crv_status status)
{
    if (status != CRV_OK)
        std::printf("%s\n", crv_status_string(status)), std::exit(EXIT_FAILURE);
}

int main(int argc, char **argv)
{
    long blocks = 0; // of memory in use; none needs a larger alignment than 64
    Pool pool(argc > 1 ? std::atoi(argv[1]) : 4);
    crv_context_desc hooks;
    check(crv_context_desc_init(&hooks, sizeof hooks));
    hooks.parallel = {Pool::run, &pool}, hooks.allocator.user = &blocks;
    hooks.allocator.allocate = [](void *user, size_t size, size_t) {
        ++*static_cast<long *>(user);
        return ::operator new(size, std::align_val_t{64}, std::nothrow);
    };
    hooks.allocator.release = [](void *user, void *block, size_t) {
        --*static_cast<long *>(user);
        ::operator delete(block, std::align_val_t{64});
    };
    // {}: column after column, z from 0 to 1. Reversed depth without a far plane, y down.
    const float m[] = {1, 0, 0, 0, 0, -16 / 9.f, 0, 0, 0, 0, 0, -1, 0, 0, 0.1f, 0};
    crv_camera camera;
    crv_depth_format format;
    crv_options options;
    crv_gbuffer_desc desc;
    check(crv_camera_from_projection(&camera, m, {}, WIDTH, HEIGHT, nullptr));
    check(crv_depth_format_from_projection(&format, m, {}, {}, nullptr));
    check(crv_options_init(&options, sizeof options, nullptr));
    check(crv_gbuffer_desc_init(&desc, sizeof desc, WIDTH, HEIGHT));
    crv_context *context;
    crv_gbuffer *gbuffer;
    crv_plan *plan;
    check(crv_context_create(&hooks, &context));
    check(crv_gbuffer_create(context, &desc, &gbuffer));
    check(crv_plan_create(context, &options, &desc, &plan));
    std::vector<float> depth(WIDTH * HEIGHT), result(WIDTH * HEIGHT);
    const crv_const_image from = crv_const_image_packed(depth.data(), WIDTH, HEIGHT, 1);
    const crv_image to = crv_image_packed(result.data(), WIDTH, HEIGHT, 1);
    for (int wall = 6; wall > 2; wall--) {
        const int corner = HEIGHT / 2 + int(camera.fy_px) / wall; // wall meets y = -1
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            depth[i] =
                m[14]
                * std::max(1.f / wall, (i / WIDTH + .5f - camera.cy_px) / camera.fy_px);
        options.noise_index = wall; // another draw for each frame
        check(crv_plan_set_options(plan, &options));
        check(crv_gbuffer_set_camera(gbuffer, &camera));
        check(crv_gbuffer_set_depth(gbuffer, 0, &from, &format));
        check(crv_plan_run(plan, gbuffer, &to));
        std::printf("wall at %d: %.4f on it, %.4f in the corner\n", wall,
                    result[WIDTH / 2], result[corner * WIDTH + WIDTH / 2]);
    }
    crv_plan_destroy(plan);
    crv_gbuffer_destroy(gbuffer);
    crv_context_destroy(context);
    std::printf("%ld blocks of memory left\n", blocks);
}
