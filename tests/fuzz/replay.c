/* SPDX-License-Identifier: MIT */
/*
 * fuzz_replay TARGET FOLDER...: runs every file of the folders through the target.
 * fuzz_replay TARGET --damage STEP FOLDER...: every STEPth of its truncations, then of
 * the single bits of its first 4 KiB turned over, instead.
 */
#define _POSIX_C_SOURCE 200809L

#include <dirent.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "fuzz.h"

/* A call that waits for ever is a fault; so is one that computes for a second. Sanitizers
 * and Valgrind slow it down ten times at most. */
#define LIMIT_S     30
#define LIMIT_CPU_S 10.0
#ifdef NDEBUG
#undef LIMIT_CPU_S
#define LIMIT_CPU_S 1.0
#endif
enum { DAMAGED_BYTES = 4096 };

static const struct {
    const char *name;
    void (*run)(const uint8_t *data, size_t size);
} targets[] = {
    {"image", fuzz_image},     {"frame", fuzz_frame},   {"api", fuzz_api},
    {"mesh", fuzz_mesh},       {"gltf", fuzz_gltf},     {"pipe", fuzz_pipe},
    {"text", fuzz_text},       {"sky", fuzz_sky},       {"checkpoint", fuzz_checkpoint},
    {"cameras", fuzz_cameras}, {"append", fuzz_append}, {"convert", fuzz_convert},
};
enum { TARGET_COUNT = sizeof targets / sizeof *targets };

/* What to do to each file. */
static int target, step;
static long runs;

static double cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void run(const uint8_t *data, size_t size)
{
    const double before = cpu_seconds();
    alarm(LIMIT_S);
    targets[target].run(data, size);
    alarm(0);
    const double spent = cpu_seconds() - before;
    FUZZ_CHECK(spent < LIMIT_CPU_S, "%g s", spent);
    runs++;
}

/* The part in a block of its own size, so that reading beyond it is seen. */
static void run_part(const uint8_t *data, size_t size)
{
    uint8_t *part = malloc(size + (size == 0));
    memcpy(part, data, size);
    run(part, size);
    free(part);
}

static void run_damaged(uint8_t *data, size_t size)
{
    for (size_t length = 0; length < size; length += (size_t)step)
        run_part(data, length);
    const size_t bits = 8 * (size < DAMAGED_BYTES ? size : DAMAGED_BYTES);
    for (size_t bit = 0; bit < bits; bit += (size_t)step) {
        data[bit / 8] ^= (uint8_t)(1u << bit % 8);
        run(data, size);
        data[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
}

static void replay(const char *path)
{
    FILE *file = fopen(path, "rb");
    FUZZ_CHECK(file && !fseek(file, 0, SEEK_END), "%s cannot be opened", path);
    const long size = ftell(file);
    rewind(file);
    uint8_t *data = malloc((size_t)size + (size == 0));
    FUZZ_CHECK(size >= 0 && fread(data, 1, (size_t)size, file) == (size_t)size,
               "%s cannot be read", path);
    fclose(file);
    if (step > 0)
        run_damaged(data, (size_t)size);
    else
        run_part(data, (size_t)size);
    free(data);
}

/* A folder that is not there has no files. */
static void replay_folder(const char *folder)
{
    DIR *directory = opendir(folder);
    for (const struct dirent *entry = directory ? readdir(directory) : NULL; entry;
         entry = readdir(directory)) {
        char path[4096];
        if (entry->d_name[0] == '.')
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        printf("%s\n", path); /* the last line names the file that failed */
        fflush(stdout);
        replay(path);
    }
    if (directory)
        closedir(directory);
}

int main(int argc, char **argv)
{
    int first = 2;
    while (argc > 2 && target < TARGET_COUNT && strcmp(targets[target].name, argv[1]))
        target++;
    if (argc > 4 && !strcmp(argv[2], "--damage")) {
        step = atoi(argv[3]);
        first = 4;
    }
    if (argc <= first || target == TARGET_COUNT || step < 0) {
        fprintf(stderr, "usage: fuzz_replay TARGET [--damage STEP] FOLDER...\n");
        return 2;
    }
    for (int i = first; i < argc; i++)
        replay_folder(argv[i]);
    printf("%s: %ld runs, %d error lines\n", argv[1], runs, fuzz_errors);
    return runs > 0 ? 0 : 1;
}
