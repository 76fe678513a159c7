# SPDX-License-Identifier: MIT
# The Vulkan backend, or what stands in for it. Its headers and a GLSL compiler are needed to
# build it; the loader is looked up at run time.
set(CREVICE_VULKAN AUTO CACHE STRING "Vulkan backend: ON, OFF, or AUTO where it can be built")
set_property(CACHE CREVICE_VULKAN PROPERTY STRINGS AUTO ON OFF)

set(CREVICE_HAS_VULKAN OFF)
if(CREVICE_VULKAN)
    find_path(CREVICE_VULKAN_HEADERS vulkan/vulkan.h DOC "Where Vulkan's headers are (1.3)")
    include(${CMAKE_CURRENT_LIST_DIR}/shaders/shaders.cmake)
    if(CREVICE_VULKAN_HEADERS AND CREVICE_GLSLANG)
        set(CREVICE_HAS_VULKAN ON)
    elseif(NOT CREVICE_VULKAN STREQUAL "AUTO")
        message(FATAL_ERROR "CREVICE_VULKAN is ON, but Vulkan's headers (libvulkan-dev) or "
            "glslangValidator (glslang-tools) are missing")
    else()
        message(STATUS "Without Vulkan: its headers (libvulkan-dev) or glslangValidator "
            "(glslang-tools) are missing")
    endif()
endif()

if(NOT CREVICE_HAS_VULKAN)
    target_sources(crevice PRIVATE vulkan/absent.c)
    return()
endif()
target_sources(crevice PRIVATE
    vulkan/backend.c vulkan/barriers.c vulkan/commands.c vulkan/device.c vulkan/formats.c
    vulkan/host_pass.c vulkan/loader.c vulkan/memory.c vulkan/pass.c vulkan/pipelines.c
    vulkan/program.c vulkan/record.c vulkan/scratch.c vulkan/slot.c
    ${CREVICE_SHADER_INCLUDE_DIR}/crevice_shaders.h)
add_dependencies(crevice crevice_shaders)
target_include_directories(crevice PRIVATE ${CREVICE_SHADER_INCLUDE_DIR})
if(NOT CREVICE_VULKAN_HEADERS STREQUAL "/usr/include")
    target_include_directories(crevice SYSTEM PRIVATE ${CREVICE_VULKAN_HEADERS})
endif()
target_link_libraries(crevice PRIVATE ${CMAKE_DL_LIBS})
