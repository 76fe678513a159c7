/* SPDX-License-Identifier: MIT */
#include "process.h"

#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include "sanitized.h"

bool pipe_open(pipe_ends *ends)
{
    int both[2];
#ifdef __linux__
    if (pipe2(both, O_CLOEXEC) != 0)
        return false;
#else
    if (pipe(both) != 0)
        return false;
    for (int i = 0; i < 2; i++)
        fcntl(both[i], F_SETFD, FD_CLOEXEC);
#endif
    *ends = (pipe_ends){.from = both[0], .to = both[1]};
    return true;
}

void pipe_close(int end)
{
    close(end);
}

int64_t pipe_read(int from, void *bytes, size_t size)
{
    ssize_t got;
    do {
        got = read(from, bytes, size);
    } while (got < 0 && errno == EINTR);
    return (int64_t)got;
}

int pipe_wait(int from, double seconds)
{
    struct pollfd ready = {.fd = from, .events = POLLIN};
    return poll(&ready, 1, (int)(seconds * 1e3));
}

bool pipe_write(int to, const void *bytes, size_t size)
{
    const char *at = bytes;
    while (size > 0) {
        const ssize_t sent = write(to, at, size);
        if (sent < 0 && errno == EINTR)
            continue;
        if (sent <= 0)
            return false;
        at += sent;
        size -= (size_t)sent;
    }
    return true;
}

static void end_with(pid_t parent, bool may_finish)
{
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, may_finish ? SIGTERM : SIGKILL);
    if (getppid() != parent)
        _exit(1);
#else
    (void)parent;
    (void)may_finish;
#endif
}

bool process_start(process *child, bool may_finish, int (*work)(void *user), void *user)
{
    const pid_t parent = getpid();
    const pid_t id = fork();
    if (id == 0) {
        end_with(parent, may_finish);
        _exit(work(user));
    }
    child->id = id;
    return id > 0;
}

void process_kill(process child)
{
    kill((pid_t)child.id, SIGKILL);
}

bool process_wait(process child, process_end *end)
{
    int status = 0;
    *end = (process_end){0};
    while (waitpid((pid_t)child.id, &status, 0) < 0)
        if (errno != EINTR)
            return false;
    if (WIFEXITED(status))
        end->code = WEXITSTATUS(status);
    if (WIFSIGNALED(status))
        end->signal = WTERMSIG(status);
    end->was_killed = end->signal == SIGKILL;
    return true;
}

const char *process_signal_name(int signal)
{
    return strsignal(signal);
}

/* A handler of the host would go on in the host's code. */
static void end_by_signals(void)
{
    static const int ending[] = {SIGINT,  SIGTERM, SIGHUP, SIGQUIT, SIGPIPE,
                                 SIGSEGV, SIGBUS,  SIGFPE, SIGABRT, SIGILL};
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    for (size_t i = 0; i < sizeof ending / sizeof *ending; i++) {
        struct sigaction former;
        if (sigaction(ending[i], NULL, &former) == 0 && former.sa_handler != SIG_IGN)
            signal(ending[i], SIG_DFL);
    }
    signal(SIGPIPE, SIG_DFL);
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

static void limit_memory(uint64_t bytes)
{
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    const uint64_t mapped = mapped_bytes();
    if (!bytes && pages > 0 && page > 0)
        bytes = (uint64_t)pages * (uint64_t)page;
    if (bytes && bytes < UINT64_MAX - mapped) {
        const struct rlimit memory = {(rlim_t)(bytes + mapped), (rlim_t)(bytes + mapped)};
        setrlimit(RLIMIT_AS, &memory);
    }
}

void process_confine(uint64_t memory_bytes)
{
    const struct rlimit no_core = {0, 0};
    end_by_signals();
    setrlimit(RLIMIT_CORE, &no_core);
    setlocale(LC_ALL, "C");
    if (SANITIZED)
        return;
    const int nowhere = open("/dev/null", O_WRONLY);
    limit_memory(memory_bytes);
    if (nowhere >= 0) {
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
    }
}

void process_own_folder(char *out, size_t size)
{
    const ssize_t length = readlink("/proc/self/exe", out, size - 1);
    out[length > 0 ? length : 0] = '\0';
    char *slash = strrchr(out, '/');
    out[slash ? slash + 1 - out : 0] = '\0';
}

void process_become(const char *program, char *const *words)
{
    execvp(program, words);
}
