/* SPDX-License-Identifier: MIT */
#include "vulkan_stage.h"

#include <stdlib.h>
#include <string.h>

#include "fixture.h"

const scene_encoding STAGE_USUAL = {.name = "usual",
                                    .depth_format = VK_FORMAT_D32_SFLOAT,
                                    .depth = CRV_DEPTH_REVERSED,
                                    .normal_format = VK_FORMAT_R8G8B8A8_UNORM,
                                    .normals = CRV_VULKAN_NORMALS_XYZ_HALVED,
                                    .space = CRV_NORMAL_WORLD,
                                    .result_format = VK_FORMAT_R32_SFLOAT,
                                    .method = "hbao",
                                    .filter = "bilateral13"};

static stage *stage_empty(engine *g, const scene_encoding *e)
{
    stage *t = calloc(1, sizeof *t);
    assert_non_null(t);
    *t = (stage){.g = g, .e = *e, .s = malloc(sizeof *t->s)};
    assert_non_null(t->s);
    t->context = scene_context(t->g, &t->log);
    return t;
}

stage *stage_open(engine *g, const scene_encoding *e, int width, int height)
{
    stage *t = stage_empty(g, e);
    scene_make_sized(t->s, e, 1, width, height);
    t->in = scene_upload(t->g, t->s, e);
    return t;
}

stage *stage_open_guarded(engine *g, const scene_encoding *e)
{
    stage *t = stage_empty(g, e);
    scene_make(t->s, e, 1);
    t->in = scene_upload(t->g, t->s, e);
    return t;
}

void stage_close(stage *t)
{
    scene_free(t->g, &t->in);
    crv_context_destroy(t->context);
    free(t->s);
    free(t);
}

crv_vulkan_pass *stage_pass(const stage *t, const crv_options *options, int frames,
                            int width, int height)
{
    crv_vulkan_pass_desc desc = scene_pass_desc(&t->e);
    crv_gbuffer_desc size;
    crv_vulkan_pass *pass = NULL;
    desc.frames = frames;
    crv_gbuffer_desc_init(&size, sizeof size, width, height);
    assert_int_equal(crv_vulkan_pass_create(t->context, options, &size, &desc, &pass),
                     CRV_OK);
    return pass;
}

crv_vulkan_pass *stage_usual_pass(const stage *t)
{
    const crv_options options = scene_options(&t->e);
    const crv_vulkan_pass_desc desc = scene_pass_desc(&t->e);
    crv_vulkan_pass *pass = NULL;
    assert_int_equal(
        crv_vulkan_pass_create(t->context, &options, &t->s->desc, &desc, &pass), CRV_OK);
    return pass;
}

void stage_draw(const stage *t, crv_vulkan_pass *pass, const crv_vulkan_frame *frame)
{
    assert_int_equal(crv_vulkan_pass_record(pass, engine_begin(t->g, 0), frame), CRV_OK);
    engine_submit(t->g, 0);
    engine_wait(t->g);
}

float *stage_drawn(const stage *t, crv_vulkan_pass *pass, const crv_vulkan_frame *frame)
{
    stage_draw(t, pass, frame);
    return scene_download(t->g, t->s, &t->e, &t->in);
}

size_t stage_pixels(const stage *t)
{
    return (size_t)t->s->desc.width * (size_t)t->s->desc.height;
}

void stage_assert_refused(stage *t, crv_status status, crv_status wanted,
                          const char *part)
{
    assert_int_equal(status, wanted);
    assert_int_equal(t->log.errors, 1);
    if (!strstr(t->log.last, part))
        fail_msg("\"%s\" has no \"%s\"", t->log.last, part);
    t->log.errors = 0;
}
