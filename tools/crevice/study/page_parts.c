/* SPDX-License-Identifier: MIT */
/* page_parts.c: paragraphs, tables and claims. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "page_internal.h"

/* `words` between backticks become code. */
static void add_words(text *out, char *words)
{
    bool code = false;

    for (char *part = words; part != NULL;) {
        char *tick = strchr(part, '`');

        if (tick != NULL)
            *tick = '\0';
        text_add_escaped(out, part);
        if (tick != NULL || code) {
            text_add(out, code ? "</code>" : "<code>");
            code = !code;
        }
        part = tick != NULL ? tick + 1 : NULL;
    }
    if (code)
        text_add(out, "</code>");
}

void page_words(page *p, const char *words)
{
    text copy = {0};

    if (page_failed(p))
        return;
    text_add(&copy, words);
    if (copy.failed)
        page_fail_memory(p);
    else
        add_words(&p->body, copy.data);
    text_free(&copy);
}

void page_text(page *p, const char *format, ...)
{
    text words = {0};
    va_list arguments;

    if (page_failed(p))
        return;
    va_start(arguments, format);
    text_vaddf(&words, format, arguments);
    va_end(arguments);
    if (words.failed)
        page_fail_memory(p);
    text_add(&p->body, "<p>");
    if (words.data != NULL)
        add_words(&p->body, words.data);
    text_add(&p->body, "</p>\n");
    text_free(&words);
}

/* Cells that are no longer than this stay in one line. */
enum { SHORT_WORDS = 20 };

static const char part_end[] = "\x1f";

void page_table_begin(page *p, const char *caption, const char *const *headers,
                      int32_t columns)
{
    if (page_failed(p))
        return;
    text_free(&p->head);
    text_free(&p->rows);
    p->columns = columns < PAGE_MAX_COLUMNS ? columns : PAGE_MAX_COLUMNS;
    p->column = 0;
    memset(p->has_words, 0, sizeof p->has_words);
    text_add(&p->body, "<figure class=\"table\">");
    if (caption != NULL && caption[0] != '\0') {
        text_add(&p->body, "<figcaption>");
        page_words(p, caption);
        text_add(&p->body, "</figcaption>");
    }
    text_add(&p->body, "<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
                       "aria-label=\"Table\"><table>");
    for (int32_t i = 0; i < p->columns; i++) {
        text_add_escaped(&p->head, headers[i]);
        text_add(&p->head, part_end);
    }
}

/* Nothing, a dash, or a number with at most a short unit. */
static bool is_number(const char *words)
{
    char *end;

    if (words[0] == '\0' || strcmp(words, "-") == 0 || strcmp(words, "\xe2\x80\x93") == 0)
        return true;
    strtod(words, &end);
    return end != words
           && (*end == '\0' || strcmp(end, "%") == 0 || strcmp(end, " %") == 0
               || strcmp(end, "x") == 0);
}

static void add_cell(page *p, bool strong, const char *format, va_list arguments)
{
    text words = {0};
    bool number;

    if (page_failed(p) || p->columns == 0)
        return;
    text_vaddf(&words, format, arguments);
    if (words.failed)
        page_fail_memory(p);
    number = words.data == NULL || is_number(words.data);
    if (!number)
        p->has_words[p->column] = true;
    if (p->column == 0)
        text_add(&p->rows, "<tr>");
    text_add(&p->rows, number                        ? "<td class=\"n\">"
                       : words.length <= SHORT_WORDS ? "<td class=\"s\">"
                                                     : "<td>");
    text_add(&p->rows, strong ? "<strong>" : "");
    if (words.data != NULL)
        add_words(&p->rows, words.data);
    text_add(&p->rows, strong ? "</strong></td>" : "</td>");
    if (++p->column == p->columns) {
        text_add(&p->rows, "</tr>\n");
        p->column = 0;
    }
    text_free(&words);
}

void page_cell(page *p, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    add_cell(p, false, format, arguments);
    va_end(arguments);
}

void page_cell_strong(page *p, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    add_cell(p, true, format, arguments);
    va_end(arguments);
}

void page_table_end(page *p)
{
    char *part;

    while (!page_failed(p) && p->column > 0)
        page_cell(p, "%s", "");
    if (page_failed(p) || p->columns == 0)
        return;
    text_add(&p->body, "<thead><tr>");
    part = p->head.data;
    for (int32_t i = 0; i < p->columns; i++) {
        size_t length = strcspn(part, part_end);

        text_addf(&p->body, "<th scope=\"col\"%s>%.*s</th>",
                  p->has_words[i] ? "" : " class=\"n\"", (int)length, part);
        part += length + 1;
    }
    text_add(&p->body, "</tr></thead><tbody>\n");
    if (p->rows.data != NULL)
        text_add(&p->body, p->rows.data);
    text_add(&p->body, "</tbody></table></div></figure>\n");
    p->columns = 0;
}

void page_grid_begin(page *p)
{
    page_raw(p, "<div class=\"grid\">\n");
}

void page_pairs_begin(page *p)
{
    page_raw(p, "<div class=\"grid pairs\">\n");
}

void page_grid_end(page *p)
{
    page_raw(p, "</div>\n");
}

void page_details_begin(page *p, const char *summary)
{
    page_raw(p, "<details><summary>");
    page_words(p, summary);
    page_raw(p, "</summary>\n");
}

void page_details_end(page *p)
{
    page_raw(p, "</details>\n");
}

static const struct {
    const char *style, *words;
} verdicts[] = {{"holds", "holds"},
                {"partly", "holds in part"},
                {"fails", "does not hold"},
                {"none", "not measured"}};

void page_claim_box(page *p, const page_claim *claim)
{
    const char *style = verdicts[claim->verdict].style;
    const char *words = verdicts[claim->verdict].words;

    if (page_failed(p))
        return;
    p->claims++;
    p->verdicts[claim->verdict]++;
    text_addf(&p->body,
              "<section class=\"claim %s\" id=\"claim-%d\"><p><span class=\"verdict\">%s"
              "</span> <span class=\"paper\">",
              style, p->claims, words);
    text_add_escaped(&p->body, claim->paper);
    text_add(&p->body, "</span></p><p>");
    page_words(p, claim->statement);
    text_add(&p->body, "</p><p>Measured: ");
    page_words(p, claim->measured != NULL ? claim->measured : "nothing");
    text_add(&p->body, "</p>");
    if (claim->reason != NULL && claim->verdict != PAGE_HOLDS) {
        text_add(&p->body, "<p>Likely reason: ");
        page_words(p, claim->reason);
        text_add(&p->body, "</p>");
    }
    text_add(&p->body, "</section>\n");
    text_addf(&p->summary, "<tr class=\"%s\"><td class=\"paper\">", style);
    text_add_escaped(&p->summary, claim->paper);
    text_addf(&p->summary, "</td><td><a href=\"#claim-%d\">", p->claims);
    text_add_escaped(&p->summary, claim->statement);
    text_addf(&p->summary, "</a></td><td class=\"verdict\">%s</td></tr>\n", words);
}
