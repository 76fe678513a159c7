/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* pipe2 */
#include "import.h"

#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include "gltf.h"
#include "import_assimp.h"
#include "internal.h"
#include "sanitized.h"

#define DEFAULT_TIMEOUT_S 600.0

/* Bytes that the child may take: what the machine has, unless the caller says less. */
static uint64_t memory_limit(const scene_limits *limits)
{
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    if (limits && limits->memory_bytes > 0)
        return (uint64_t)limits->memory_bytes;
    return pages > 0 && page > 0 ? (uint64_t)pages * (uint64_t)page : UINT64_MAX;
}

/* The address space that this process has already: the child inherits it. */
static uint64_t mapped_bytes(void)
{
    unsigned long long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file && fscanf(file, "%llu", &pages) != 1)
        pages = 0;
    if (file)
        fclose(file);
    return (uint64_t)pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

/* Ends with the parent, writes no core, says nothing of its own on the terminal, takes no
 * more than its share of memory, and is ended by signals: a handler of the host would go
 * on in the host's code. Sanitizers reserve terabytes and have something to say. */
static void confine(pid_t parent, const scene_limits *limits)
{
    static const int ending[] = {SIGINT,  SIGTERM, SIGHUP, SIGQUIT, SIGPIPE,
                                 SIGSEGV, SIGBUS,  SIGFPE, SIGABRT, SIGILL};
    const struct rlimit no_core = {0, 0};
    sigset_t none;
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(1);
#else
    (void)parent;
#endif
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    for (size_t i = 0; i < sizeof ending / sizeof *ending; i++) {
        struct sigaction former;
        if (sigaction(ending[i], NULL, &former) == 0 && former.sa_handler != SIG_IGN)
            signal(ending[i], SIG_DFL);
    }
    signal(SIGPIPE, SIG_DFL);
    setrlimit(RLIMIT_CORE, &no_core);
    setlocale(LC_ALL, "C");
    if (!SANITIZED) {
        const uint64_t bytes = memory_limit(limits), mapped = mapped_bytes();
        const int nowhere = open("/dev/null", O_WRONLY);
        if (bytes < UINT64_MAX - mapped) {
            const struct rlimit memory = {(rlim_t)(bytes + mapped),
                                          (rlim_t)(bytes + mapped)};
            setrlimit(RLIMIT_AS, &memory);
        }
        if (nowhere >= 0) {
            dup2(nowhere, STDOUT_FILENO);
            dup2(nowhere, STDERR_FILENO);
        }
    }
}

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

static void run_child(int fd, const char *path)
{
    const crv_logger log = import_pipe_logger(&fd);
import found = {0 };
    _exit(read_model(path, &found, &log) == 0 && import_pipe_send(fd, &found) ? 0 : 1);
}

/* The line for a child that brought neither a result nor an error. */
static void tell_end(const char *path, import_end end, int status, double timeout,
                     const crv_logger *log)
{
    static const char cure[] =
        "the file is damaged or too large; export it again, or as glTF";
    if (end == IMPORT_TIMEOUT)
        scene_log(log, CRV_LOG_ERROR, path,
                  "was not read within %g s; the file is damaged, or wants more time: "
                  "simplify it, or allow more",
                  timeout);
    else if (end == IMPORT_NO_MEMORY
             || (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL))
        scene_log(log, CRV_LOG_ERROR, path,
                  "takes more memory to read than there is; simplify the model, or "
                  "export it again if it is small");
    else if (WIFSIGNALED(status))
        scene_log(log, CRV_LOG_ERROR, path, "made its importer crash (%s); %s",
                  strsignal(WTERMSIG(status)), cure);
    else
        scene_log(log, CRV_LOG_ERROR, path, "made its importer fail; %s", cure);
}

static int wait_for(pid_t child, int fd, const char *path, const import_wait *wait,
                    import *out, const crv_logger *log)
{
    int errors = 0, status = 0;
import found = {0 };
    const import_end end = import_pipe_receive(fd, wait, &found, &errors, log);
    /* What it could still do is of no interest; if it has ended it tells how. */
    if (end != IMPORT_NOTHING)
        kill(child, SIGKILL);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    if (end == IMPORT_DONE && errors == 0) {
        *out = found;
        return 0;
    }
    import_free(&found);
    if (errors == 0)
        tell_end(path, end, end == IMPORT_NOTHING ? status : 0, wait->timeout, log);
    return -1;
}

int import_file(const char *path, const scene_limits *limits, import *out,
                const crv_logger *log)
{
    const double timeout =
        limits && limits->timeout_s > 0.0 ? limits->timeout_s : DEFAULT_TIMEOUT_S;
    const import_wait wait = {import_clock(), timeout, limits};
    const pid_t parent = getpid();
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) {
        scene_log(log, CRV_LOG_ERROR, path, "cannot be read (%s); close other programs",
                  strerror(errno));
        return -1;
    }
    const pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        confine(parent, limits);
        run_child(ends[1], path);
    }
    close(ends[1]);
    if (child < 0)
        scene_log(log, CRV_LOG_ERROR, path, "cannot be read (%s); close other programs",
                  strerror(errno));
    const int result = child < 0 ? -1 : wait_for(child, ends[0], path, &wait, out, log);
    close(ends[0]);
    return result;
}
