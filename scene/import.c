/* SPDX-License-Identifier: MIT */
#include "import.h"

#include <errno.h>
#include <string.h>

#include "gltf.h"
#include "import_assimp.h"
#include "internal.h"
#include "system/clock.h"
#include "system/process.h"

#define DEFAULT_TIMEOUT_S 600.0

/* In the child. */
static int read_model(const char *path, import *out, const crv_logger *log)
{
    if (gltf_is(path) ? gltf_read(path, out, log) : import_assimp(path, out, log))
        return -1;
    if (out->mesh.failed)
        scene_log(log, CRV_LOG_ERROR, path,
                  "no memory for its triangles; simplify the model");
    return out->mesh.failed ? -1 : 0;
}

/* What the child gets. */
typedef struct order {
    const char *path;
    const scene_limits *limits;
    pipe_ends ends;
} order;

static int run_child(void *data)
{
    order *o = data;
    const int64_t memory = o->limits ? o->limits->memory_bytes : 0;
    const crv_logger log = import_pipe_logger(&o->ends.to);
import found = {0 };
    pipe_close(o->ends.from);
    process_confine(memory > 0 ? (uint64_t)memory : 0);
    return read_model(o->path, &found, &log) == 0 && import_pipe_send(o->ends.to, &found)
               ? 0
               : 1;
}

/* The line for a child that brought neither a result nor an error. */
static void tell_end(const char *path, import_end end, const process_end *how,
                     double timeout, const crv_logger *log)
{
    static const char cure[] =
        "the file is damaged or too large; export it again, or as glTF";
    if (end == IMPORT_TIMEOUT)
        scene_log(log, CRV_LOG_ERROR, path,
                  "was not read within %g s; the file is damaged, or wants more time: "
                  "simplify it, or allow more",
                  timeout);
    else if (end == IMPORT_NO_MEMORY || how->was_killed)
        scene_log(log, CRV_LOG_ERROR, path,
                  "takes more memory to read than there is; simplify the model, or "
                  "export it again if it is small");
    else if (how->signal)
        scene_log(log, CRV_LOG_ERROR, path, "made its importer crash (%s); %s",
                  process_signal_name(how->signal), cure);
    else
        scene_log(log, CRV_LOG_ERROR, path, "made its importer fail; %s", cure);
}

static int wait_for(process child, int from, const char *path, const import_wait *wait,
                    import *out, const crv_logger *log)
{
    int errors = 0;
    process_end how;
import found = {0 };
    const import_end end = import_pipe_receive(from, wait, &found, &errors, log);
    /* What it could still do is of no interest; if it has ended it tells how. */
    if (end != IMPORT_NOTHING)
        process_kill(child);
    process_wait(child, &how);
    if (end == IMPORT_DONE && errors == 0) {
        *out = found;
        return 0;
    }
    import_free(&found);
    if (end != IMPORT_NOTHING)
        how = (process_end){0};
    if (errors == 0)
        tell_end(path, end, &how, wait->timeout, log);
    return -1;
}

int import_file(const char *path, const scene_limits *limits, import *out,
                const crv_logger *log)
{
    const double timeout =
        limits && limits->timeout_s > 0.0 ? limits->timeout_s : DEFAULT_TIMEOUT_S;
    const import_wait wait = {clock_seconds(), timeout, limits};
    order o = {.path = path, .limits = limits};
    process child;
    const bool piped = pipe_open(&o.ends);
    const bool started = piped && process_start(&child, false, run_child, &o);
    if (!started)
        scene_log(log, CRV_LOG_ERROR, path, "cannot be read (%s); close other programs",
                  strerror(errno));
    if (!piped)
        return -1;
    pipe_close(o.ends.to);
    const int result = started ? wait_for(child, o.ends.from, path, &wait, out, log) : -1;
    pipe_close(o.ends.from);
    return result;
}
