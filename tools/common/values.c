/* SPDX-License-Identifier: MIT */
/* Text to values, completely: "12abc" is not a number. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "args.h"

bool args_number(const char *text, double *out)
{
    char *end = NULL;
    if (text[0] == '\0' || isspace((unsigned char)text[0]))
        return false;
    const double value = strtod(text, &end);
    if (end == text || *end != '\0' || isnan(value))
        return false;
    *out = value;
    return true;
}

static bool set_int(const arg *row, const char *text, arg_int *out)
{
    double value;
    if (!args_number(text, &value) || value < row->min || value > row->max
        || floor(value) < value)
        return false;
    out->value = (int32_t)value;
    return true;
}

static bool set_number(const arg *row, const char *text, arg_number *out)
{
    double value;
    if (row->choices && strcmp(text, row->choices[0]) == 0) {
        out->value = NAN;
        return true;
    }
    if (!args_number(text, &value) || value < row->min || value > row->max)
        return false;
    out->value = value;
    return true;
}

int args_numbers(const char *text, double *out, int max)
{
    char copy[128];
    char *part = copy;
    int count = 0;
    if (strlen(text) >= sizeof copy)
        return -1;
    memcpy(copy, text, strlen(text) + 1);
    while (part) {
        char *comma = strchr(part, ',');

        if (comma)
            *comma = '\0';
        if (count == max || !args_number(part, &out[count]) || !isfinite(out[count]))
            return -1;
        count++;
        part = comma ? comma + 1 : NULL;
    }
    return count;
}

static bool set_vector(const char *text, arg_vector *out)
{
    double value[3];
    if (args_numbers(text, value, 3) != 3)
        return false;
    /* Squares of coordinates must stay finite in single precision. */
    for (int i = 0; i < 3; i++)
        if (!(fabs(value[i]) < 1e18))
            return false;
    memcpy(out->value, value, sizeof value);
    return true;
}

/* Digits only, so that neither "+1x1" nor "1e3x1" passes. */
static bool edge(const char *text, const char **end, int32_t *out)
{
    int64_t value = 0;
    if (!isdigit((unsigned char)*text))
        return false;
    for (; isdigit((unsigned char)*text); text++) {
        value = value * 10 + (*text - '0');
        if (value > CRV_MAX_SIZE)
            return false;
    }
    *out = (int32_t)value;
    *end = text;
    return value >= 1;
}

static bool set_size(const char *text, arg_size *out)
{
    const char *rest;
    return edge(text, &rest, &out->width) && (*rest == 'x' || *rest == 'X')
           && edge(rest + 1, &rest, &out->height) && *rest == '\0';
}

const char *arg_choice(const arg *row, int32_t index)
{
    return row->choices ? row->choices[index] : row->choice_name(index);
}

static bool set_choice(const arg *row, const char *text, arg_int *out)
{
    for (int32_t i = 0; arg_choice(row, i); i++) {
        if (strcmp(text, arg_choice(row, i)) == 0) {
            out->value = i;
            return true;
        }
    }
    return false;
}

static bool add_text(const char *text, arg_texts *out)
{
    if (text[0] == '\0' || out->count == ARG_TEXTS_MAX)
        return false;
    out->value[out->count++] = text;
    return true;
}

bool args_set_value(const arg *row, const char *text, void *settings)
{
    void *member = (char *)settings + row->offset;
    switch (row->type) {
    case ARG_FLAG:
        *(bool *)member = true;
        return true;
    case ARG_TEXT:
        *(const char **)member = text;
        return text[0] != '\0';
    case ARG_TEXTS:
        return add_text(text, member);
    case ARG_INT:
        return set_int(row, text, member);
    case ARG_NUMBER:
        return set_number(row, text, member);
    case ARG_VECTOR:
        return set_vector(text, member);
    case ARG_SIZE:
        return set_size(text, member);
    case ARG_CHOICE:
        return set_choice(row, text, member);
    }
    return false;
}

static void describe_choices(const arg *row, char *out, size_t size)
{
    size_t used = 0;
    int32_t count = 0;
    while (arg_choice(row, count))
        count++;
    /* Long lists need places at which a line may break. */
    const char *between = count > 6 ? ", " : "|";
    for (int32_t i = 0; i < count && used < size; i++)
        used += (size_t)snprintf(out + used, size - used, "%s%s", i == 0 ? "" : between,
                                 arg_choice(row, i));
}

void args_describe_values(const arg *row, char *out, size_t size)
{
    const char *space = row->unit ? " " : "";
    const char *unit = row->unit ? row->unit : "";
    out[0] = '\0';
    switch (row->type) {
    case ARG_FLAG:
    case ARG_TEXT:
    case ARG_TEXTS:
        break;
    case ARG_INT:
    case ARG_NUMBER:
        snprintf(out, size, "%.10g to %.10g%s%s%s%s", row->min, row->max, space, unit,
                 row->choices ? ", or " : "", row->choices ? row->choices[0] : "");
        break;
    case ARG_VECTOR:
        snprintf(out, size, "three numbers X,Y,Z%s%s", space, unit);
        break;
    case ARG_SIZE:
        snprintf(out, size, "WIDTHxHEIGHT, each 1 to %d px", CRV_MAX_SIZE);
        break;
    case ARG_CHOICE:
        describe_choices(row, out, size);
        break;
    }
}
