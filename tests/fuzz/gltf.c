/* SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include <string.h>

#include "gltf.h"

void fuzz_gltf(const uint8_t *data, size_t size)
{
    const bool binary = size > 4 && !memcmp(data, "glTF", 4);
    const char *path = fuzz_file(binary ? "input.glb" : "input.gltf", data, size);
import found = {0 };
    if (!gltf_is(path))
        return;
    const int before = fuzz_errors;
    const int result = gltf_read(path, &found, &fuzz_logger);
    FUZZ_CHECK(fuzz_errors == before + (result ? 1 : 0), "%d lines",
               fuzz_errors - before);
    for (size_t i = 0; !result && i < 3 * found.mesh.triangle_count; i++)
        FUZZ_CHECK(found.mesh.indices[i] < found.mesh.vertex_count, "corner %zu", i);
    import_free(&found);
}
