/* SPDX-License-Identifier: MIT */
/*
 * page.h: the page of `crevice report`: index.html with pictures beside it in a folder of
 * their own, plots inline as SVG, readable without a network or scripts, in light and
 * dark. Text is escaped here and nowhere else. Errors are sticky: after the first, which
 * has been reported, all calls do nothing and page_close() fails.
 */
#ifndef TOOL_STUDY_PAGE_H
#define TOOL_STUDY_PAGE_H

#include "common/report.h"

typedef struct page page;

/* Makes DIR and DIR/pictures where they are missing, and finds out whether so many bytes
 * can be written there. Returns an exit code. */
int page_open(const char *directory, const char *title, size_t room, report *r,
              page **out);

/* Writes index.html through a temporary file and frees the page, also where it fails.
 * Returns an exit code. */
int page_close(page *p);

/* Frees the page without writing it. NULL does nothing. */
void page_abandon(page *p);

/* Whether something could not be written, so that further work is in vain. */
bool page_failed(const page *p);

/* Writes a text beside index.html. Returns an exit code. */
int page_attach(page *p, const char *name, const char *content);

/* 1, 2, 3 ...: for ids inside fragments of page_raw(). */
int32_t page_next_number(page *p);

/* A section begins: level 2 or 3, listed in the contents at level 2. id: a word. What
 * stands before the first is the introduction, above the summary of claims. */
void page_heading(page *p, int level, const char *id, const char *text);

#if defined(__GNUC__)
#define PAGE_PRINTF(text, rest) __attribute__((format(printf, text, rest)))
#else
#define PAGE_PRINTF(text, rest)
#endif

/* A paragraph. `backticks` become code, here and in cells, captions and claims; nothing
 * else is marked up. */
void page_text(page *p, const char *format, ...) PAGE_PRINTF(2, 3);

/* A table: header cells, then rows cell by cell. Cells that are numbers are aligned
 * right. emphasis marks the best of a column. */
void page_table_begin(page *p, const char *caption, const char *const *headers,
                      int32_t columns);
void page_cell(page *p, const char *format, ...) PAGE_PRINTF(2, 3);
void page_cell_strong(page *p, const char *format, ...) PAGE_PRINTF(2, 3);
void page_table_end(page *p);

/* Pictures that follow each other stand in one grid, until page_grid_end(). */
void page_grid_begin(page *p);
void page_pairs_begin(page *p); /* two and two that belong together stay side by side */
void page_grid_end(page *p);

/* A grey picture of accessibility, written as pictures/NAME.png; caption and alternative
 * text are the same. name: letters, digits, dashes; where it is taken, a number is added.
 */
void page_picture(page *p, const char *name, const float *grey, int32_t width,
                  int32_t height, const char *caption);

/* The signed error a - b as a heat map of that scale (heatmap.h). */
void page_error_map(page *p, const char *name, const float *a, const float *b,
                    const uint8_t *mask, int32_t width, int32_t height, double scale,
                    const char *caption);

/* Closed until clicked: long tables and picture walls. */
void page_details_begin(page *p, const char *summary);
void page_details_end(page *p);

/* What a paper states, and what was measured. */
typedef enum page_verdict {
    PAGE_HOLDS,
    PAGE_PARTLY,
    PAGE_FAILS,
    PAGE_NOT_MEASURED
} page_verdict;

typedef struct page_claim {
    const char *paper;     /* "2008a, Figure 12" */
    const char *statement; /* what it says, in one sentence of our own */
    page_verdict verdict;  /* decided from the numbers */
    const char *measured;  /* the numbers, in one or two sentences */
    const char *reason;    /* where it does not hold: why, likely; else NULL */
} page_claim;

/* A box that says so; also a row of the summary that page_close() puts on top. */
void page_claim_box(page *p, const page_claim *claim);

/* A finished fragment of HTML or SVG, well-formed. */
void page_raw(page *p, const char *html);

#endif
