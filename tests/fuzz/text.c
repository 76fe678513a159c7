/* SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include <math.h>
#include <string.h>

#include "commands.h"
#include "common/nearest.h"
#include "common/options_file.h"
#include "common/frames.h"
#include "common/viewer_args.h"

static const command *const commands[] = {
    &command_render,  &command_ao,      &command_gbuffer, &command_reference,
    &command_compare, &command_methods, &command_devices, &command_bench,
    &command_tune,    &command_view};
enum {
    COMMAND_COUNT = sizeof commands / sizeof *commands,
    MAX_WORDS = 64,
    MAX_SIZE = 4096
};

static void parse(const command *c, int count, char **words)
{
    report r;
    report_init(&r);
    r.logger = fuzz_logger;
    r.quiet = true;
    const int before = fuzz_errors;
    void *settings = calloc(1, c->settings_size);
    const int result = args_parse(c, count, words, settings, &r);
    const int errors = r.errors + fuzz_errors - before;
    FUZZ_CHECK((result == EXIT_DONE) == (errors == 0), "exit code %d, %d lines", result,
               errors);
    if (result == EXIT_DONE && c->library_options) {
        const common_settings *s = settings;
        FUZZ_CHECK(crv_options_check(&s->options, NULL) == CRV_OK, "options taken");
    }
    free(settings);
}

/* The same words as a file of options. */
static void read_options(const char *text, size_t size)
{
    report r;
    report_init(&r);
    r.logger = fuzz_logger;
    r.quiet = true;
    options_file file;
    crv_options o;
    crv_options_init(&o, sizeof o, NULL);
    const int before = fuzz_errors;
    const char *path = fuzz_file("input", (const uint8_t *)text, size);
    int result = options_file_read(path, &file, &r);
    if (result == EXIT_DONE)
        result = options_file_apply(&file, &o, &r);
    options_file_free(&file);
    const int errors = r.errors + fuzz_errors - before;
    FUZZ_CHECK((result == EXIT_DONE) == (errors == 0), "exit code %d, %d lines", result,
               errors);
    FUZZ_CHECK(crv_options_check(&o, NULL) == CRV_OK, "options of a file");
}

/* Whatever is set passes the check, and is set again from its own value. */
static void set_options(int count, char **words)
{
    crv_options o;
    crv_options_init(&o, sizeof o, NULL);
    for (int i = 0; i + 1 < count; i += 2)
        crv_options_set(&o, words[i], words[i + 1], &fuzz_logger);
    FUZZ_CHECK(crv_options_check(&o, NULL) == CRV_OK, "options set");
    for (int32_t i = 0; i < crv_option_count(); i++) {
        const crv_option *option = crv_option_at(i);
        const double value = crv_options_get(&o, option);
        FUZZ_CHECK(value >= option->min && value <= option->max, "%s is %g", option->key,
                   value);
    }
}

static void list_frames(const char *text)
{
    frame_list list;
    char name[64];
    int32_t before = INT32_MIN;
    if (frames_places(text) == 1)
        frames_name(text, -12, name, sizeof name);
    if (!frames_parse(text, &list))
        return;
    const int32_t count = frames_count(&list);
    FUZZ_CHECK(count > 0, "%d frames", count);
    for (int32_t i = 0; i < count && i < 100; i++)
        before = frames_at(&list, i);
    FUZZ_CHECK(before != INT32_MIN && abs(frames_at(&list, count - 1)) <= 1000000000,
               "frame %d", frames_at(&list, count - 1));
}

void fuzz_text(const uint8_t *data, size_t size)
{
    char *words[MAX_WORDS + 1] = {0};
    int count = 0;
    if (size < 2 || size > MAX_SIZE)
        return;
    const int kind = data[0] % (COMMAND_COUNT + 2);
    if (kind == COMMAND_COUNT)
        read_options((const char *)data + 1, size - 1);
    char *copy = malloc(size);
    memcpy(copy, data + 1, size - 1);
    copy[size - 1] = '\0';
    for (char *at = copy; at && count < MAX_WORDS;) {
        char *end = strchr(at, '\n');
        if (end)
            *end = '\0';
        words[count++] = at;
        at = end ? end + 1 : NULL;
    }
    if (kind < COMMAND_COUNT)
        parse(commands[kind], count, words);
    else if (kind == COMMAND_COUNT)
        set_options(count, words);
    else
        for (int i = 0; i < count; i++) {
            list_frames(words[i]);
            nearest_name(words[i], (const char *const *)words, count);
        }
    free(copy);
}
