/* SPDX-License-Identifier: MIT */
#include "plot_axis.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double marks[] = {1.0, 2.0, 5.0};

static void add_tick(plot_axis *axis, double value, bool has_label)
{
    if (axis->tick_count < PLOT_MAX_TICKS)
        axis->ticks[axis->tick_count++] = (plot_tick){value, has_label};
}

/* The smallest 1, 2 or 5 times a power of ten that parts the range into six at most. */
static double step_of(double range)
{
    double unit = pow(10.0, floor(log10(range / 6.0)));

    for (int i = 0; i < 3; i++)
        if (range / (marks[i] * unit) <= 6.0 + 1e-9)
            return marks[i] * unit;
    return 10.0 * unit;
}

static void make_linear(plot_axis *axis, bool from_zero)
{
    double step, first, last;

    if (from_zero)
        axis->low = fmin(axis->low, 0.0);
    if (!(axis->high > axis->low)) {
        double room = fmax(fabs(axis->high), 1e-9) * 0.5;
        axis->low -= from_zero && axis->low >= 0.0 ? 0.0 : room;
        axis->high += room;
    }
    step = step_of(axis->high - axis->low);
    first = floor(axis->low / step + 1e-9);
    last = ceil(axis->high / step - 1e-9);
    for (double i = first; i <= last + 0.5; i += 1.0)
        add_tick(axis, i * step, true);
    axis->low = first * step;
    axis->high = last * step;
}

/* The nearest digit times a power of ten that is not above (below) the value. */
static double round_log(double value, bool up)
{
    double unit = pow(10.0, floor(log10(value) + 1e-9)), digit = value / unit;

    return unit * (up ? ceil(digit - 1e-9) : floor(digit + 1e-9));
}

/* Labels that do not crowd: on axes of a decade or so most digits, of three decades 1, 2
 * and 5, else decades; of many decades not all of these. */
static bool labelled(int digit, int exponent, double decades)
{
    int every = decades > 16.0 ? 3 : decades > 8.0 ? 2 : 1;

    if (digit == 1)
        return exponent % every == 0;
    if (decades <= 1.3)
        return digit <= 5 || digit == 7;
    return decades <= 3.0 && (digit == 2 || digit == 5);
}

static void make_log(plot_axis *axis)
{
    double decades;

    axis->low = round_log(axis->low, false);
    axis->high = round_log(axis->high, true);
    if (!(axis->high > axis->low * 1.0001)) {
        axis->low = round_log(axis->low * 0.5, false);
        axis->high = round_log(axis->high * 2.0, true);
    }
    decades = log10(axis->high / axis->low);
    for (int e = (int)floor(log10(axis->low) + 1e-9); e <= 300; e++) {
        for (int m = 1; m <= 9; m++) {
            double value = m * pow(10.0, e);

            if (value > axis->high * (1.0 + 1e-9))
                return;
            if (value < axis->low * (1.0 - 1e-9) || (decades > 5.0 && m > 1))
                continue;
            add_tick(axis, value, labelled(m, e, decades));
        }
    }
}

plot_axis plot_axis_make(double low, double high, bool is_log, bool from_zero)
{
    plot_axis axis = {.low = low, .high = high, .is_log = is_log};

    if (is_log)
        make_log(&axis);
    else
        make_linear(&axis, from_zero);
    return axis;
}

double plot_axis_place(const plot_axis *axis, double value)
{
    if (axis->is_log)
        return log(value / axis->low) / log(axis->high / axis->low);
    return (value - axis->low) / (axis->high - axis->low);
}

void plot_axis_label(double value, char *out, int32_t size)
{
    char text[32];
    char *exponent;

    /* What is left of 0.1 + 0.2 - 0.3. */
    snprintf(text, sizeof text, "%.6g", fabs(value) < 1e-12 ? 0.0 : value);
    exponent = strchr(text, 'e');
    if (exponent != NULL) {
        char *digits = exponent + 1;
        char sign = *digits == '-' ? '-' : '\0';

        digits += strspn(digits, "+-0");
        *exponent = '\0';
        snprintf(out, (size_t)size, sign != '\0' ? "%se-%s" : "%se%s", text, digits);
    } else {
        snprintf(out, (size_t)size, "%s", text);
    }
}
