/* SPDX-License-Identifier: MIT */
/* page_document.c: the document around what the sections wrote. */
#include "page_internal.h"

static void add_contents(const page *p, text *out)
{
    text_add(out, "<nav aria-label=\"Contents\"><strong>Contents</strong><ol>\n");
    if (p->claims > 0)
        text_add(out, "<li><a href=\"#statements\">The papers' statements</a></li>\n");
    for (size_t i = 0; i < p->content_count; i++) {
        text_addf(out, "<li><a href=\"#%s\">", p->contents[i].id);
        text_add_escaped(out, p->contents[i].heading);
        text_add(out, "</a></li>\n");
    }
    text_add(out, "</ol></nav>\n");
}

static void add_summary(const page *p, text *out)
{
    const int32_t *n = p->verdicts;

    if (p->claims == 0)
        return;
    text_addf(out,
              "<h2 id=\"statements\">The papers&#39; statements</h2>\n"
              "<p>Of %d statements that were measured here, %d hold, %d hold in part, %d "
              "do not hold%s.</p>\n",
              p->claims - n[PAGE_NOT_MEASURED], n[PAGE_HOLDS], n[PAGE_PARTLY],
              n[PAGE_FAILS],
              n[PAGE_NOT_MEASURED] > 0 ? "; others were not measured" : "");
    text_add(out, "<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
                  "aria-label=\"Statements\"><table><thead><tr><th>Paper</th>"
                  "<th>Statement</th><th>Here</th></tr></thead><tbody>\n");
    text_add(out, p->summary.data);
    text_add(out, "</tbody></table></div>\n");
}

void page_add_document(const page *p, text *out)
{
    size_t lead = p->has_lead ? p->lead_length : p->body.length;

    text_add(out,
             "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
             "<meta name=\"viewport\" content=\"width=device-width, "
             "initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light "
             "dark\">\n<title>");
    text_add_escaped(out, p->title);
    text_add(out, "</title>\n<link rel=\"icon\" href=\"data:image/svg+xml,%3Csvg "
                  "xmlns='http://www.w3.org/2000/svg' viewBox='0 0 16 16'%3E%3Cpath "
                  "fill='%23bbb' d='M0 0h16v16H0z'/%3E%3Cpath fill='%23333' d='M0 0l8 "
                  "11 8-11v16H0z'/%3E%3C/svg%3E\">\n<style>\n");
    for (size_t i = 0; page_style[i] != NULL; i++)
        text_add(out, page_style[i]);
    text_add(out, "</style>\n</head>\n<body>\n<div class=\"page\">\n");
    add_contents(p, out);
    text_add(out, "<main>\n<h1>");
    text_add_escaped(out, p->title);
    text_add(out, "</h1>\n");
    if (p->body.data != NULL)
        text_addf(out, "%.*s", (int)lead, p->body.data);
    add_summary(p, out);
    if (p->body.data != NULL)
        text_add(out, p->body.data + lead);
    text_add(out, "</main>\n</div>\n</body>\n</html>\n");
}
