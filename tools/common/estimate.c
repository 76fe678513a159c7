/* SPDX-License-Identifier: MIT */
#include "estimate.h"

#include "device.h"

#include <stdio.h>
#include <stdlib.h>

#ifdef _OPENMP
#include <omp.h>
#endif

int estimate_open(estimator *e, const common_settings *common, report *r)
{
    *e = (estimator){.context = NULL};
#ifdef _OPENMP
    /* Files are packed and unpacked by as many. */
    if (common->threads.value > 0)
        omp_set_num_threads(common->threads.value);
#endif
    return device_context(common, r, &e->run, &e->context);
}

void estimate_fit(estimator *e, const crv_gbuffer_desc *desc)
{
    if (crv_gbuffer_desc_equal(&e->desc, desc))
        return;
    crv_gbuffer_destroy(e->gbuffer);
    crv_plan_destroy(e->plan);
    e->gbuffer = NULL;
    e->plan = NULL;
    e->desc = *desc;
}

bool estimate_same_options(const crv_options *a, const crv_options *b)
{
    if (a->method != b->method || a->filter != b->filter)
        return false;
    for (int32_t i = 0; i < crv_option_count(); i++) {
        const crv_option *option = crv_option_at(i);
        /* Infinite values equal themselves; none is NaN. */
        const double x = crv_options_get(a, option), y = crv_options_get(b, option);
        if (x < y || x > y)
            return false;
    }
    return true;
}

crv_status estimate_take(crv_context *context, const crv_gbuffer_desc *desc,
                         const crv_options *options, crv_plan **plan, crv_options *taken)
{
    if (*plan && estimate_same_options(taken, options))
        return CRV_OK;
    if (!*plan || crv_plan_set_options(*plan, options) != CRV_OK) {
        crv_plan *made = NULL;
        const crv_status status = crv_plan_create(context, options, desc, &made);
        if (status != CRV_OK)
            return status;
        crv_plan_destroy(*plan);
        *plan = made;
    }
    *taken = *options;
    return CRV_OK;
}

int estimate_plan(estimator *e, const crv_options *options, report *r)
{
    if (e->plan && estimate_same_options(&e->options, options))
        return EXIT_DONE;
    crv_plan_destroy(e->plan);
    e->plan = NULL;
    e->options = *options;
    return report_ok(r, crv_plan_create(e->context, options, &e->desc, &e->plan), "plan")
               ? EXIT_DONE
               : EXIT_FAILED;
}

int estimate_depth(estimator *e, float **out, report *r)
{
    float *depth = malloc((size_t)e->desc.width * (size_t)e->desc.height * sizeof *depth);
    crv_image view = crv_image_packed(depth, e->desc.width, e->desc.height, 1);
    if (!depth)
        return report_no_memory(r);
    if (!report_ok(r, crv_gbuffer_get_depth(e->gbuffer, 0, &view), "depth")) {
        free(depth);
        return EXIT_FAILED;
    }
    *out = depth;
    return EXIT_DONE;
}

static bool reads(const crv_options *o, const char *key)
{
    const crv_option *option = crv_option_find(key);
    return option && crv_option_applies(option, o->method, o->filter) != 0;
}

int estimate_check_method(const char *flag, const char *key, const crv_method *method,
                          report *r)
{
    const crv_option *option = crv_option_find(key);
    char names[256] = "";
    size_t used = 0;
    if (crv_option_applies(option, method, NULL))
        return EXIT_DONE;
    for (int32_t i = 0; i < crv_method_count() && used < sizeof names; i++)
        if (crv_option_applies(option, crv_method_at(i), NULL))
            used += (size_t)snprintf(names + used, sizeof names - used, "%s--method %s",
                                     used == 0 ? "" : " or ", crv_method_at(i)->name);
    report_error(r, "%s: is not read by %s; give %s", flag, method->name, names);
    return EXIT_USAGE;
}

bool estimate_is_of_relief(const crv_options *options)
{
    return reads(options, "characteristic")
           && options->characteristic == CRV_CHARACTERISTIC_FIELD;
}

/* "hbao 8x8, radius 1, bilateral13: 0.41 s", "vao 12 samples, radius ..." */
static void tell(const estimator *e, double seconds, report *r)
{
    const crv_options *o = &e->options;
    char samples[32] = "";
    if (reads(o, "directions") && reads(o, "steps"))
        snprintf(samples, sizeof samples, " %dx%d", o->directions, o->steps);
    else if (reads(o, "samples"))
        snprintf(samples, sizeof samples, " %d samples", o->samples);
    report_info(r, "%s%s, radius %g, %s: %.2f s", o->method->name, samples,
                (double)o->radius, o->filter ? o->filter->name : "no filter", seconds);
    for (int32_t i = 0; i < crv_option_count(); i++)
        if (crv_option_applies(crv_option_at(i), o->method, o->filter))
            report_detail(r, "  %s %g", crv_option_at(i)->key,
                          crv_options_get(o, crv_option_at(i)));
}

int estimate_run(estimator *e, io_image *out, report *r)
{
    static const char *const names[] = {"AO", "bent.X", "bent.Y", "bent.Z"};
    const bool bent = e->options.bent_normal;
    const int32_t width = e->desc.width - e->desc.guard_left - e->desc.guard_right;
    const int32_t height = e->desc.height - e->desc.guard_top - e->desc.guard_bottom;
    const double start = report_seconds();
    crv_result result;
    if (io_image_init(out, width, height, names, bent ? 4 : 1, &r->logger) != 0)
        return EXIT_FAILED;
    crv_result_init(&result, sizeof result);
    result.accessibility = io_image_view(out, 0, 1);
    if (bent)
        result.bent_normal = io_image_view(out, 1, 3);
    e->run = progress_begin(r, "estimation", 0, 0);
    const crv_status status = crv_plan_run_result(e->plan, e->gbuffer, &result);
    progress_end(&e->run);
    if (!report_ok(r, status, "estimation")) {
        io_image_free(out);
        return EXIT_FAILED;
    }
    tell(e, report_seconds() - start, r);
    return EXIT_DONE;
}

void estimate_close(estimator *e)
{
    crv_plan_destroy(e->plan);
    crv_gbuffer_destroy(e->gbuffer);
    crv_context_destroy(e->context);
    *e = (estimator){0};
}
