/* SPDX-License-Identifier: MIT */
#include <stdio.h>

#include "commands.h"
#include "common/device.h"
#include "common/json.h"

typedef struct devices_settings {
    common_settings common;
    bool json;
} devices_settings;

static const arg devices_rows[] = {
    {.name = "--json", ARG_INTO(ARG_FLAG, devices_settings, json), .help = "write JSON"},
};
static const arg_table devices_table = ARG_TABLE("What to write", devices_rows);

static const arg_table *const tables[] = {&devices_table, &args_output_lines, NULL};

static const char *const examples[] = {
    "what --device may name here",
    "crevice devices",
    NULL,
};

static void print_device(int32_t index, const crv_device_info *info)
{
    char name[32];
    snprintf(name, sizeof name, "vulkan:%d", index);
    printf("%-10s %s (%s%s)\n", name, info->name, info->driver,
           info->software ? "; a CPU" : "");
    if (info->missing[0] != '\0')
        printf("           cannot be used: %s\n", info->missing);
}

static void add_device(cJSON *list, int32_t index, const crv_device_info *info)
{
    cJSON *object = cJSON_CreateObject();
    char name[32];
    snprintf(name, sizeof name, "vulkan:%d", index);
    json_add_text(object, "device", name);
    json_add_text(object, "name", info->name);
    json_add_text(object, "driver", info->driver);
    cJSON_AddBoolToObject(object, "software", info->software);
    json_add_text(object, "missing", info->missing);
    cJSON_AddItemToArray(list, object);
}

/* Keeps the reason why there is no Vulkan: here it is no error. */
static void keep_line(void *user, crv_log_level level, const char *line)
{
    if (level == CRV_LOG_ERROR)
        snprintf(user, 512, "%s", line);
}

static int run(const void *settings, report *r)
{
    const devices_settings *s = settings;
    char sets[128], why[512] = "";
    const crv_logger logger = {.fn = keep_line, .user = why};
    cJSON *root = cJSON_CreateObject();
    cJSON *list = cJSON_AddArrayToObject(root, "vulkan");
    crv_device_info info;
    int32_t count = 0;
    device_list_isas(sets, sizeof sets);
    if (!s->json)
        printf("%-10s %s\n", "cpu", sets);
    json_add_text(root, "cpu", sets);
    while (crv_vulkan_device_info(count, &info, &logger) == CRV_OK) {
        if (!s->json)
            print_device(count, &info);
        add_device(list, count++, &info);
    }
    if (count == 0 && why[0] == '\0')
        snprintf(why, sizeof why, "vulkan: there is no device; install a driver");
    if (count == 0)
        json_add_text(root, "vulkan_missing", why);
    if (count == 0 && !s->json)
        printf("%s\n", why);
    if (s->json)
        return json_print(root, r);
    cJSON_Delete(root);
    return EXIT_DONE;
}

const command command_devices = {
    .name = "devices",
    .summary = "list the processors and GPUs that --device may name",
    .synopsis = "[--json]",
    .tables = tables,
    .examples = examples,
    .settings_size = sizeof(devices_settings),
    .run = run,
};
