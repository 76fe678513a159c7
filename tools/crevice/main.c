/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "help_camera.h"
#include "help_passes.h"
#include "help_scenes.h"
#include "launch.h"
#include "common/help.h"
#include "common/manual.h"
#include "common/viewer_args.h"
#include "common/nearest.h"
#include "system/file.h"

#ifdef _OPENMP
#include <omp.h>
#endif

enum { THREADS_MAX = 1024 }; /* as --threads */

static const command *const commands[] = {&command_render,
                                          &command_ao,
                                          &command_gbuffer,
                                          &command_reference,
                                          &command_compare,
                                          &command_methods,
                                          &command_devices,
                                          &command_bench,
                                          &command_tune,
                                          &command_view,
                                          NULL};

static const help_topic topics[] = {
    {.name = "passes",
     .summary = "the passes of renderers that `crevice ao` knows by name",
     .write = help_passes},
    {.name = "camera", .summary = "files of cameras, for --camera", .write = help_camera},
    {.name = "scenes",
     .summary = "scenes made in code: builtin:NAME",
     .write = help_scenes},
    {.name = NULL}};

/* NULL with an error for an unknown name. kind: what it should have been. */
static const command *find_command(const char *name, const char *kind, report *r)
{
    const char *names[16];
    int32_t count = 0;
    for (; commands[count]; count++) {
        if (strcmp(commands[count]->name, name) == 0)
            return commands[count];
        names[count] = commands[count]->name;
    }
    const char *nearest = nearest_name(name, names, count);
    if (nearest)
        report_error(r, "%s: no such %s; did you mean %s?", name, kind, nearest);
    else
        report_error(r, "%s: no such %s; see `crevice help`", name, kind);
    return NULL;
}

/* For packages: `help --man [COMMAND]`, `help --completion SHELL`, and `help --pages DIR`
 * for all of them. */
static int help_as_pages(int argc, char **argv, report *r)
{
    if (strcmp(argv[0], "--man") == 0) {
        if (argc < 2) {
            manual_overview(stdout, commands);
            return EXIT_DONE;
        }
        const command *c = find_command(argv[1], "command", r);
        if (c)
            manual_command(stdout, c);
        return c ? EXIT_DONE : EXIT_USAGE;
    }
    if (argc == 2 && strcmp(argv[0], "--pages") == 0)
        return manual_write_all(argv[1], commands, r);
    if (argc == 2 && strcmp(argv[0], "--completion") == 0
        && completion_write(stdout, argv[1], commands))
        return EXIT_DONE;
    report_error(r,
                 "help %s: give --man [COMMAND], --pages DIR or --completion SHELL, for "
                 "bash, zsh or fish",
                 argv[0]);
    return EXIT_USAGE;
}

static int help(int argc, char **argv, report *r)
{
    if (argc == 0) {
        help_overview(stdout, commands, topics);
        return EXIT_DONE;
    }
    if (strncmp(argv[0], "--", 2) == 0)
        return help_as_pages(argc, argv, r);
    for (const help_topic *t = topics; t->name; t++) {
        if (strcmp(t->name, argv[0]) == 0) {
            t->write(stdout);
            return EXIT_DONE;
        }
    }
    const command *c = find_command(argv[0], "command or topic", r);
    if (!c)
        return EXIT_USAGE;
    help_command(stdout, c, args_method(c, argc - 1, argv + 1));
    return EXIT_DONE;
}

static bool wants_help(int argc, char **argv)
{
    for (int i = 0; i < argc && strcmp(argv[i], "--") != 0; i++)
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0)
            return true;
    return false;
}

static int run_command(const command *c, int argc, char **argv, report *r)
{
    if (wants_help(argc, argv)) {
        help_command(stdout, c, args_method(c, argc, argv));
        return EXIT_DONE;
    }
    if (c->program)
        return launch(c, argc, argv, r);
    void *settings = calloc(1, c->settings_size);
    if (!settings)
        return report_no_memory(r);
    int result = args_parse(c, argc, argv, settings, r);
    if (result == EXIT_DONE)
        result = c->run(settings, r);
    free(settings);
    return result;
}

static int dispatch(int argc, char **argv, report *r)
{
    if (argc < 2) {
        help_overview(stderr, commands, topics);
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("crevice %s\n", crv_version());
        return EXIT_DONE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)
        return help(0, NULL, r);
    if (strcmp(argv[1], "help") == 0)
        return help(argc - 2, argv + 2, r);
    const command *c = find_command(argv[1], "command", r);
    return c ? run_command(c, argc - 2, argv + 2, r) : EXIT_USAGE;
}

/* OMP_NUM_THREADS may ask for more than the system can make, which ends in a crash. */
static void limit_threads(report *r)
{
#ifdef _OPENMP
    const int wanted = omp_get_max_threads();

    if (wanted <= THREADS_MAX)
        return;
    report_warning(r, "OMP_NUM_THREADS: %d are more than %d threads; takes %d", wanted,
                   THREADS_MAX, omp_get_num_procs());
    omp_set_num_threads(omp_get_num_procs());
#else
    (void)r;
#endif
}

int main(int argc, char **argv)
{
    report r;
    report_init(&r);
    limit_threads(&r);
    file_limit_fails();
    int result = dispatch(argc, argv, &r);
    /* A full disk behind a redirection shows only now. */
    if ((fflush(stdout) != 0 || ferror(stdout)) && result == EXIT_DONE) {
        report_error(&r, "standard output: could not be written; is the disk full?");
        result = EXIT_FAILED;
    }
    if (result != EXIT_DONE && r.errors == 0 && argc >= 2)
        report_error(&r, "%s: failed", argv[1]);
    return result;
}
