/* SPDX-License-Identifier: MIT */
#include "metrics_print.h"

#include <stdio.h>

#include "json.h"

static void add_differences(cJSON *root, const metrics *m)
{
    json_add_number(root, "pixels", (double)m->pixels);
    json_add_number(root, "mean_a", m->mean_a);
    json_add_number(root, "mean_b", m->mean_b);
    json_add_number(root, "bias", m->bias);
    json_add_number(root, "rmse", m->rmse);
    json_add_number(root, "mae", m->mae);
    json_add_number(root, "psnr_db", m->psnr_db);
    json_add_number(root, "ssim", m->ssim);
    json_add_number(root, "ssim_windows", (double)m->ssim_windows);
    json_add_number(root, "max_error", m->max_error);
    json_add_number(root, "max_x", m->max_x);
    json_add_number(root, "max_y", m->max_y);
    json_add_number(root, "error_q01", m->error_q01);
    json_add_number(root, "error_q99", m->error_q99);
}

static void add_fit(cJSON *root, const metrics_fit *fit)
{
    json_add_number(root, "fit_power", fit->power.power);
    json_add_number(root, "fit_power_rmse", fit->power.rmse);
    json_add_number(root, "fit_intensity", fit->intensity.intensity);
    json_add_number(root, "fit_intensity_rmse", fit->intensity.rmse);
    json_add_number(root, "fit_both_intensity", fit->both.intensity);
    json_add_number(root, "fit_both_power", fit->both.power);
    json_add_number(root, "fit_both_rmse", fit->both.rmse);
}

static void add_angles(cJSON *root, const metrics_findings *f)
{
    json_add_number(root, "bent_pixels", (double)f->bent.pixels);
    json_add_number(root, "bent_median_deg", f->bent.median_deg);
    json_add_number(root, "bent_q95_deg", f->bent.q95_deg);
    json_add_number(root, "bent_open", f->open);
    json_add_number(root, "bent_open_pixels", (double)f->bent_open.pixels);
    json_add_number(root, "bent_open_median_deg", f->bent_open.median_deg);
    json_add_number(root, "bent_open_q95_deg", f->bent_open.q95_deg);
}

int metrics_print_json(const metrics_findings *f, report *r)
{
    cJSON *root = cJSON_CreateObject();
    json_add_text(root, "a", f->a);
    json_add_text(root, "b", f->b);
    json_add_number(root, "width", f->width);
    json_add_number(root, "height", f->height);
    add_differences(root, &f->m);
    json_add_number(root, "flip", f->flip);
    json_add_number(root, "flip_ppd", f->flip_ppd);
    add_fit(root, &f->fit);
    if (f->has_bent)
        add_angles(root, f);
    if (f->heat_map) {
        json_add_text(root, "heat_map", f->heat_map);
        json_add_number(root, "heat_scale", f->heat_scale);
    }
    return json_print(root, r);
}

static void print_angles(const metrics_findings *f)
{
    printf("bent     median %.3f, 95 %% %.3f degrees of %lld pixels\n",
           f->bent.median_deg, f->bent.q95_deg, (long long)f->bent.pixels);
    if (f->bent_open.pixels > 0)
        printf("         median %.3f, 95 %% %.3f degrees of %lld above %g in B\n",
               f->bent_open.median_deg, f->bent_open.q95_deg,
               (long long)f->bent_open.pixels, f->open);
    else
        printf("         none above %g in B\n", f->open);
}

void metrics_print_text(const metrics_findings *f)
{
    const metrics *m = &f->m;
    printf("pixels   %lld of %lld\n", (long long)m->pixels,
           (long long)f->width * f->height);
    printf("mean     %.6f and %.6f\n", m->mean_a, m->mean_b);
    printf("bias     %+.6f\n", m->bias);
    printf("RMSE     %.6f\n", m->rmse);
    printf("MAE      %.6f\n", m->mae);
    printf("PSNR     %.2f dB\n", m->psnr_db);
    if (m->ssim_windows > 0)
        printf("SSIM     %.6f\n", m->ssim);
    else
        printf("SSIM     none: no 11x11 window without background\n");
    printf("FLIP     %.6f\n", f->flip);
    printf("largest  %.6f at (%d, %d)\n", m->max_error, m->max_x, m->max_y);
    printf("errors   %+.6f to %+.6f but for 1 %% on each side\n", m->error_q01,
           m->error_q99);
    printf("fitted   RMSE %.6f after power %.4f\n", f->fit.power.rmse,
           f->fit.power.power);
    printf("         RMSE %.6f after intensity %.4f\n", f->fit.intensity.rmse,
           f->fit.intensity.intensity);
    printf("         RMSE %.6f after intensity %.4f and power %.4f\n", f->fit.both.rmse,
           f->fit.both.intensity, f->fit.both.power);
    if (f->has_bent && f->bent.pixels > 0)
        print_angles(f);
    else if (f->has_bent)
        printf("bent     no pixel with a direction in both\n");
}
