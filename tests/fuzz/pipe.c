/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L
#include "fuzz.h"

#include <unistd.h>

#include "import.h"
#include "scene/internal.h"
#include "system/clock.h"

/* A pipe holds 64 KiB, so that nobody waits. */
enum { MAX_BYTES = 65536 };

void fuzz_pipe(const uint8_t *data, size_t size)
{
    int ends[2], errors = 0;
import found = {0 };
    if (size > MAX_BYTES)
        return;
    FUZZ_CHECK(!pipe(ends), "no pipe");
    FUZZ_CHECK(write(ends[1], data, size) == (ssize_t)size, "a short write");
    close(ends[1]);
    const import_wait wait = {clock_seconds(), 5.0, NULL};
    const import_end end =
        import_pipe_receive(ends[0], &wait, &found, &errors, &fuzz_logger);
    close(ends[0]);
    FUZZ_CHECK(end != IMPORT_TIMEOUT, "it waits");
    scene *s = NULL;
    if (end == IMPORT_DONE && found.mesh.triangle_count > 0
        && !scene_from_mesh(&found.mesh, "input", &s, &fuzz_logger)) {
        scene_gbuffer_request q = {
            .width = 4, .height = 4, .layers = 2, .threads = 1, .texture_frames = true};
        scene_gbuffer g = {0};
        scene_frame(s, 1.0f, 1.0f, &q.view);
        if (!scene_render_gbuffer(s, &q, &g, &fuzz_logger))
            scene_gbuffer_free(&g);
    }
    scene_free(s);
    import_free(&found);
}
