# SPDX-License-Identifier: MIT
# The kernels, compiled once per instruction set that the compiler and the target have.
set(crevice_kernel_sources
    cpu/kernels/table_tmpl.c
    cpu/kernels/alchemy_tmpl.c cpu/kernels/containment_tmpl.c cpu/kernels/hbao_tmpl.c
    cpu/kernels/hsao_tmpl.c cpu/kernels/raymarch_tmpl.c cpu/kernels/ssao_tmpl.c
    cpu/kernels/vao_tmpl.c cpu/kernels/vo_tmpl.c
    cpu/kernels/deal_tmpl.c cpu/kernels/alchemy_fast_tmpl.c cpu/kernels/hbao_fast_tmpl.c
    cpu/kernels/vo_fast_tmpl.c
    cpu/kernels/depth_tmpl.c cpu/kernels/normals_tmpl.c
    cpu/kernels/bilateral13_tmpl.c cpu/kernels/box4_tmpl.c cpu/kernels/gauss5_tmpl.c)

function(crevice_kernels set)
    set(target crevice_kernels_${set})
    string(TOUPPER ${set} SET)
    add_library(${target} OBJECT ${crevice_kernel_sources})
    target_compile_definitions(${target} PRIVATE CRV_BUILD CRV_STATIC CRV__SIMD_${SET})
    target_compile_options(${target} PRIVATE ${ARGN})
    target_include_directories(${target} PRIVATE
        ${PROJECT_SOURCE_DIR}/include ${CMAKE_CURRENT_SOURCE_DIR})
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:crevice_flags>)
    target_sources(crevice PRIVATE $<TARGET_OBJECTS:${target}>)
endfunction()

if(CMAKE_C_COMPILER_ID MATCHES "GNU|Clang" AND CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
    crevice_kernels(sse4 -msse4.1)
    crevice_kernels(avx2 -mavx2 -mfma)
    crevice_kernels(avx512 -mavx512f -mavx512bw -mavx512dq -mavx512vl -mprefer-vector-width=512)
    set_property(SOURCE cpu/isa.c PROPERTY COMPILE_DEFINITIONS CRV__HAVE_X86)
elseif(CMAKE_C_COMPILER_ID MATCHES "GNU|Clang" AND CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
    crevice_kernels(neon)
    set_property(SOURCE cpu/isa.c PROPERTY COMPILE_DEFINITIONS CRV__HAVE_NEON)
endif()
