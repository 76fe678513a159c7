/* SPDX-License-Identifier: MIT */
/* page_internal.h: what the files of the page share. */
#ifndef TOOL_STUDY_PAGE_INTERNAL_H
#define TOOL_STUDY_PAGE_INTERNAL_H

#include "page.h"
#include "common/text.h"

extern const char *const page_style[]; /* NULL-terminated */

enum { PAGE_MAX_COLUMNS = 32 };

typedef struct page_entry {
    char *id, *heading; /* owned */
} page_entry;

struct page {
    report *r;
    char *directory, *title; /* owned */
    bool made_directory, made_pictures;
    bool failed;
    text body, summary; /* summary: rows of the table of claims */
    bool has_lead;      /* lead: what stands before the first heading */
    size_t lead_length;
    page_entry *contents;
    size_t content_count, content_capacity;
    char **words; /* ids and names of pictures that are taken */
    size_t word_count, word_capacity;
    int32_t claims, verdicts[PAGE_NOT_MEASURED + 1];
    int32_t numbers;
    /* The open table: its head is written last, when the columns of numbers are known. */
    text head, rows; /* head: a part for each column, parted by U+001F */
    int32_t columns, column;
    bool has_words[PAGE_MAX_COLUMNS];
};

/* A word of letters, digits and dashes like `wanted` that this page has not used yet;
 * NULL after a failure. The page keeps it. */
const char *page_unique(page *p, const char *wanted);

/* All of index.html. */
void page_add_document(const page *p, text *out);

/* Words with `backticks`, without an element of their own. */
void page_words(page *p, const char *words);

/* Remembers the failure; the first one without a line of its own gets one. */
void page_fail_memory(page *p);

#endif
