/* SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 200809L

#include "page.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io.h"
#include "common/output.h"
#include "page_internal.h"

void page_fail_memory(page *p)
{
    if (!p->failed)
        report_no_memory(p->r);
    p->failed = true;
}

bool page_failed(const page *p)
{
    return p->failed || p->body.failed || p->summary.failed || p->head.failed
           || p->rows.failed;
}

static char *joined(const char *folder, const char *name)
{
    text path = {0};

    text_addf(&path, "%s/%s", folder, name);
    if (path.failed)
        text_free(&path);
    return path.data;
}

typedef struct folder {
    const char *path;
    size_t room;
    bool *made;
    const crv_logger *log;
} folder;

static int make_folder(void *data)
{
    const folder *f = data;

    return io_make_folder(f->path, f->room, f->made, f->log);
}

/* index.html must be a name for a file. */
static bool name_is_free(page *p)
{
    char *path = joined(p->directory, "index.html");
    struct stat status;
    bool is_folder = path != NULL && stat(path, &status) == 0 && S_ISDIR(status.st_mode);

    if (path == NULL)
        page_fail_memory(p);
    if (is_folder)
        report_error(p->r, "%s: is a folder; remove it, or choose another -o", path);
    free(path);
    return !is_folder && !p->failed;
}

static bool prepare(page *p, size_t room)
{
    folder f = {p->directory, 4096, &p->made_directory, &p->r->logger};
    char *pictures = joined(p->directory, "pictures");
    bool done = false;

    if (pictures == NULL)
        page_fail_memory(p);
    else if (output_guarded(make_folder, &f) == 0 && name_is_free(p)) {
        f = (folder){pictures, room, &p->made_pictures, &p->r->logger};
        done = output_guarded(make_folder, &f) == 0;
    }
    free(pictures);
    return done;
}

int page_open(const char *directory, const char *title, size_t room, report *r,
              page **out)
{
    page *p = calloc(1, sizeof *p);
    size_t length = strlen(directory);

    if (p == NULL)
        return report_no_memory(r);
    while (length > 1 && directory[length - 1] == '/')
        length--;
    p->r = r;
    p->directory = strndup(directory, length);
    p->title = strdup(title);
    if (p->directory == NULL || p->title == NULL)
        page_fail_memory(p);
    if (p->failed || !prepare(p, room)) {
        page_abandon(p);
        return EXIT_FAILED;
    }
    page_unique(p, "statements"); /* of the summary */
    *out = p;
    return EXIT_DONE;
}

static void page_free(page *p)
{
    for (size_t i = 0; i < p->content_count; i++) {
        free(p->contents[i].id);
        free(p->contents[i].heading);
    }
    for (size_t i = 0; i < p->word_count; i++)
        free(p->words[i]);
    free(p->contents);
    free(p->words);
    text_free(&p->body);
    text_free(&p->summary);
    text_free(&p->head);
    text_free(&p->rows);
    free(p->directory);
    free(p->title);
    free(p);
}

/* Folders that this page made and nothing was written to go again. */
void page_abandon(page *p)
{
    char *pictures;

    if (p == NULL)
        return;
    pictures = p->directory != NULL ? joined(p->directory, "pictures") : NULL;
    if (p->made_pictures && pictures != NULL)
        rmdir(pictures);
    if (p->made_directory && p->directory != NULL)
        rmdir(p->directory);
    free(pictures);
    page_free(p);
}

static bool is_taken(const page *p, const char *word)
{
    for (size_t i = 0; i < p->word_count; i++)
        if (strcmp(p->words[i], word) == 0)
            return true;
    return false;
}

static const char *keep_word(page *p, char *word)
{
    if (p->word_count == p->word_capacity) {
        size_t capacity = p->word_capacity == 0 ? 64 : 2 * p->word_capacity;
        char **words = realloc(p->words, capacity * sizeof *words);

        if (words == NULL) {
            free(word);
            page_fail_memory(p);
            return NULL;
        }
        p->words = words;
        p->word_capacity = capacity;
    }
    p->words[p->word_count++] = word;
    return word;
}

const char *page_unique(page *p, const char *wanted)
{
    text word = {0};
    size_t length;

    for (size_t i = 0; i < 120 && wanted[i] != '\0'; i++)
        text_addf(&word, "%c", isalnum((unsigned char)wanted[i]) ? wanted[i] : '-');
    if (word.length == 0)
        text_add(&word, "x");
    length = word.length;
    for (int i = 2; !word.failed && is_taken(p, word.data); i++) {
        word.length = length;
        text_addf(&word, "-%d", i);
    }
    if (word.failed) {
        text_free(&word);
        page_fail_memory(p);
        return NULL;
    }
    return keep_word(p, word.data);
}

int32_t page_next_number(page *p)
{
    return ++p->numbers;
}

void page_raw(page *p, const char *html)
{
    if (!page_failed(p))
        text_add(&p->body, html);
}

static void list_heading(page *p, const char *id, const char *heading)
{
    if (p->content_count == p->content_capacity) {
        size_t capacity = p->content_capacity == 0 ? 16 : 2 * p->content_capacity;
        page_entry *contents = realloc(p->contents, capacity * sizeof *contents);

        if (contents == NULL) {
            page_fail_memory(p);
            return;
        }
        p->contents = contents;
        p->content_capacity = capacity;
    }
    p->contents[p->content_count++] = (page_entry){strdup(id), strdup(heading)};
    if (p->contents[p->content_count - 1].id == NULL
        || p->contents[p->content_count - 1].heading == NULL)
        page_fail_memory(p);
}

void page_heading(page *p, int level, const char *id, const char *heading)
{
    const char *word;

    if (page_failed(p) || (word = page_unique(p, id)) == NULL)
        return;
    if (!p->has_lead) {
        p->has_lead = true;
        p->lead_length = p->body.length;
    }
    text_addf(&p->body, "<h%d id=\"%s\">", level, word);
    text_add_escaped(&p->body, heading);
    text_addf(&p->body, "</h%d>\n", level);
    if (level == 2)
        list_heading(p, word, heading);
}

typedef struct bytes {
    const char *path;
    const text *content;
    const crv_logger *log;
} bytes;

static int write_bytes(void *data)
{
    const bytes *b = data;

    return io_write_bytes(b->path, b->content->data, b->content->length, b->log);
}

static int write_text(const page *p, const char *name, const text *content)
{
    char *path = joined(p->directory, name);
    bytes b = {path, content, &p->r->logger};
    int result = EXIT_FAILED;

    if (path == NULL || content->failed)
        report_no_memory(p->r);
    else if (output_guarded(write_bytes, &b) == 0)
        result = EXIT_DONE;
    if (result == EXIT_DONE)
        report_info(p->r, "wrote %s", path);
    free(path);
    return result;
}

int page_attach(page *p, const char *name, const char *content)
{
    text copy = {0};
    int result;

    text_add(&copy, content);
    result = write_text(p, name, &copy);
    text_free(&copy);
    p->failed = p->failed || result != EXIT_DONE;
    return result;
}

int page_close(page *p)
{
    text document = {0};
    int result = EXIT_FAILED;

    if (!p->failed && page_failed(p))
        page_fail_memory(p);
    if (!p->failed) {
        page_add_document(p, &document);
        result = write_text(p, "index.html", &document);
        text_free(&document);
    }
    page_free(p);
    return result;
}
