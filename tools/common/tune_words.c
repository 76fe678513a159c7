/* SPDX-License-Identifier: MIT */
/* What is fitted, in words. */
#include <string.h>

#include "text.h"
#include "tune.h"

static const struct word {
    const char *name; /* the option's key, too */
    unsigned bit;
} words[] = {{"radius", TUNE_RADIUS},
             {"thickness", TUNE_THICKNESS},
             {"falloff", TUNE_FALLOFF},
             {"contrast", TUNE_CONTRAST},
             {"intensity", TUNE_INTENSITY}};
enum { WORDS = sizeof words / sizeof words[0] };

unsigned tune_parse(const char *text)
{
    unsigned fits = 0;
    for (;;) {
        const size_t length = strcspn(text, ",");
        int i = 0;
        while (i < WORDS
               && (strlen(words[i].name) != length
                   || strncmp(words[i].name, text, length) != 0))
            i++;
        if (i == WORDS)
            return 0;
        fits |= words[i].bit;
        if (text[length] == '\0')
            return fits;
        text += length + 1;
    }
}

static bool reads(const crv_method *method, const char *key)
{
    return crv_option_applies(crv_option_find(key), method, NULL) != 0;
}

unsigned tune_applicable(unsigned fits, const crv_method *method)
{
    for (int i = 0; i < WORDS; i++)
        if (!reads(method, words[i].name)
            && !(words[i].bit == TUNE_THICKNESS && reads(method, "thickness_rule")))
            fits &= ~words[i].bit;
    return fits;
}

const char *tune_words(unsigned fits, char out[64])
{
    out[0] = '\0';
    for (int i = 0; i < WORDS; i++)
        if (fits & words[i].bit)
            append_to(out, 64, "%s%s", out[0] != '\0' ? ", " : "", words[i].name);
    return out;
}
