# SPDX-License-Identifier: MIT
# Writes SPIR-V modules as C arrays and a table of them.
# cmake -DFOLDER=... -DNAMES=a;b -DOUT=header -P embed.cmake
set(text "/* SPDX-License-Identifier: MIT */\n/* Generated from the shaders. */\n")
string(APPEND text "#ifndef CREVICE_SHADERS_H\n#define CREVICE_SHADERS_H\n\n")
string(APPEND text "#include <stddef.h>\n#include <stdint.h>\n\n")
set(rows "")
set(count 0)
foreach(name IN LISTS NAMES)
    file(READ ${FOLDER}/${name}.spv hex HEX)
    string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${hex}")
    string(REGEX REPLACE "(0x........,0x........,0x........,0x........,0x........,0x........,)"
        "\\1\n" words "${words}")
    string(APPEND text "static const uint32_t crv__spv_${name}[] = {\n${words}\n};\n\n")
    string(APPEND rows "    {\"${name}\", crv__spv_${name}, sizeof crv__spv_${name}},\n")
    math(EXPR count "${count} + 1")
endforeach()
string(APPEND text "enum { CRV__SHADER_COUNT = ${count} };\n\n")
string(APPEND text "/* A module, by the name of its method, filter or pass. */\n")
string(APPEND text "typedef struct crv__shader {\n    const char *name;\n")
string(APPEND text "    const uint32_t *words;\n    size_t size_bytes;\n} crv__shader;\n\n")
string(APPEND text "static const crv__shader crv__shaders[CRV__SHADER_COUNT] = {\n${rows}};\n\n#endif\n")
file(WRITE ${OUT} "${text}")
