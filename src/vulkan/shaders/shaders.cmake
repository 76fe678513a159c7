# SPDX-License-Identifier: MIT
# GLSL to SPIR-V at build time, embedded as C arrays: crevice_shaders.h in
# CREVICE_SHADER_INCLUDE_DIR, made by the target crevice_shaders. CREVICE_GLSLANG is the
# compiler; where there is none, none of this is defined.
find_program(CREVICE_GLSLANG NAMES glslangValidator glslang
    DOC "The GLSL compiler of the Vulkan backend")
if(NOT CREVICE_GLSLANG)
    return()
endif()

set(crevice_shader_dir ${CMAKE_CURRENT_LIST_DIR})
set(CREVICE_SHADER_INCLUDE_DIR ${CMAKE_CURRENT_BINARY_DIR}/shaders)
file(MAKE_DIRECTORY ${CREVICE_SHADER_INCLUDE_DIR}) # not every generator makes it
set(CREVICE_SHADERS
    hbao gtao bitmask hsao raymarch alchemy vo containment vao ssao
    bilateral13 box4 edges15 gauss5 bilateral13_half gauss5_half
    convert depth_convert deinterleave prefilter width)
# Only 1.3 devices are used, but SPIR-V 1.6 would ask them for maintenance4.
set(CREVICE_SHADER_TARGET vulkan1.2)

file(GLOB crevice_shader_includes CONFIGURE_DEPENDS ${crevice_shader_dir}/*.glsl
    ${PROJECT_SOURCE_DIR}/src/shared/*.h)
set(CREVICE_SHADER_MODULES "")
foreach(name IN LISTS CREVICE_SHADERS)
    set(module ${CREVICE_SHADER_INCLUDE_DIR}/${name}.spv)
    add_custom_command(OUTPUT ${module}
        COMMAND ${CREVICE_GLSLANG} -g0 --quiet --target-env ${CREVICE_SHADER_TARGET}
            -I${PROJECT_SOURCE_DIR}/src -o ${module} ${crevice_shader_dir}/${name}.comp
        DEPENDS ${crevice_shader_dir}/${name}.comp ${crevice_shader_includes}
        COMMENT "SPIR-V ${name}" VERBATIM)
    list(APPEND CREVICE_SHADER_MODULES ${module})
endforeach()

set(crevice_shader_header ${CREVICE_SHADER_INCLUDE_DIR}/crevice_shaders.h)
add_custom_command(OUTPUT ${crevice_shader_header}
    COMMAND ${CMAKE_COMMAND} -DFOLDER=${CREVICE_SHADER_INCLUDE_DIR}
        "-DNAMES=${CREVICE_SHADERS}" -DOUT=${crevice_shader_header}
        -P ${crevice_shader_dir}/embed.cmake
    DEPENDS ${CREVICE_SHADER_MODULES} ${crevice_shader_dir}/embed.cmake
        ${CMAKE_CURRENT_LIST_FILE}
    COMMENT "SPIR-V as C arrays" VERBATIM)
add_custom_target(crevice_shaders DEPENDS ${crevice_shader_header})
set_target_properties(crevice_shaders PROPERTIES
    CREVICE_TARGET_ENV ${CREVICE_SHADER_TARGET} CREVICE_INCLUDE ${CREVICE_SHADER_INCLUDE_DIR})
