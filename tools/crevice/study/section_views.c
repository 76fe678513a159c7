/* SPDX-License-Identifier: MIT */
/* section_views.c: what is measured on, and with what: views and references. */
#include <stdio.h>

#include "sections.h"

static const double degree = 3.14159265358979323846 / 180.0;

static void describe_camera(const study_view *v, char *out, size_t size)
{
    const scene_view *c = &v->camera;
    bool ortho = c->projection == CRV_ORTHOGRAPHIC;

    snprintf(out, size,
             "--eye %.4g,%.4g,%.4g --target %.4g,%.4g,%.4g --up %.4g,%.4g,%.4g %s %.4g",
             (double)c->eye[0], (double)c->eye[1], (double)c->eye[2],
             (double)c->target[0], (double)c->target[1], (double)c->target[2],
             (double)c->up[0], (double)c->up[1], (double)c->up[2],
             ortho ? "--ortho" : "--vfov",
             ortho ? (double)c->view_height : (double)c->vfov_rad / degree);
}

static void write_table(study *s, cJSON *list)
{
    static const char *const headers[] = {"View", "Triangles", "Radius", "Surface",
                                          "Camera"};

    page_table_begin(s->page,
                     "Radius: of influence, scene units. Surface: share of the pixels "
                     "that show one, and count.",
                     headers, 5);
    for (int32_t i = 0; i < s->view_count; i++) {
        const study_view *v = &s->views[i];
        double share = (double)v->pixels / ((double)v->width * (double)v->height);
        char camera[256];
        cJSON *item = cJSON_CreateObject();

        describe_camera(v, camera, sizeof camera);
        page_cell(s->page, v == s->main ? "%s (main)" : "%s", v->name);
        page_cell(s->page, "%lld", (long long)scene_triangle_count(v->model));
        page_cell(s->page, "%.4g", (double)v->radius);
        page_cell(s->page, "%.1f %%", 100.0 * share);
        page_cell(s->page, "`%s`", camera);
        cJSON_AddStringToObject(item, "name", v->name);
        cJSON_AddStringToObject(item, "camera", camera);
        study_add_number(item, "triangles", (double)scene_triangle_count(v->model));
        study_add_number(item, "radius", (double)v->radius);
        study_add_number(item, "pixels", (double)v->pixels);
        cJSON_AddItemToArray(list, item);
    }
    page_table_end(s->page);
}

int study_views_section(study *s)
{
    const study_target target = {.definition = REFERENCE_HEMISPHERE,
                                 .weighting = CRV_WEIGHTING_COSINE,
                                 .falloff = CRV_FALLOFF_LINEAR};
    int result = EXIT_DONE;

    page_heading(s->page, 2, "views", "Views");
    write_table(s, cJSON_AddArrayToObject(s->results, "views"));
    page_text(s->page, "Ray-traced, cosine weighting, linear falloff:");
    page_grid_begin(s->page);
    for (int32_t i = 0; i < s->view_count && result == EXIT_DONE; i++) {
        study_view *v = &s->views[i];
        const float *truth = NULL;
        char name[80];

        result = study_reference(s, v, &target, REFERENCE_FULL, STUDY_ONE_LAYER, &truth);
        snprintf(name, sizeof name, "view-%s", v->name);
        if (result == EXIT_DONE)
            page_picture(s->page, name, truth, v->width, v->height, v->name);
    }
    page_grid_end(s->page);
    return result;
}

void study_references_section(study *s)
{
    page_heading(s->page, 2, "references", "References");
    page_text(
        s->page,
        "Ray-traced with up to %d low-discrepancy rays for each pixel; a pixel is "
        "done earlier when its standard error is below %.4f. The root mean square "
        "standard error below is what the references themselves add to every error "
        "on this page, in squares: an error of 0.05 against a reference of 0.005 is "
        "one of 0.0497.",
        s->rays, study_reference_stop(s));
    study_references_table(s);
}
