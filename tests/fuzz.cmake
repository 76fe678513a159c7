# SPDX-License-Identifier: MIT
# Fuzzers: fuzz_NAME for each target where clang's libFuzzer is asked for (CREVICE_FUZZ),
# else one program that runs seeds and kept inputs through all of them.
set(fuzz_targets image frame api convert mesh gltf pipe text checkpoint sky cameras append)
find_package(assimp REQUIRED)
find_package(embree CONFIG REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(CJSON REQUIRED IMPORTED_TARGET libcjson)

# Targets see rooms from inside; the commands come with the tool, but for its main().
set(tool_dir ${PROJECT_SOURCE_DIR}/tools/crevice)
get_target_property(tool_sources crevice_tool SOURCES)
list(FILTER tool_sources EXCLUDE REGEX "^main\\.c$")
list(TRANSFORM tool_sources PREPEND ${tool_dir}/)
set(fuzz_sources fuzz/support.c fuzz/pixels.c ${tool_sources})
foreach(target IN LISTS fuzz_targets)
    list(APPEND fuzz_sources fuzz/${target}.c)
endforeach()
add_library(crevice_fuzz STATIC EXCLUDE_FROM_ALL ${fuzz_sources})
target_include_directories(crevice_fuzz
    PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/fuzz ${tool_dir} ${PROJECT_SOURCE_DIR})
target_link_libraries(crevice_fuzz
    PUBLIC crevice_common embree PRIVATE crevice_flags PkgConfig::CJSON)
target_sources(crevice_fuzz INTERFACE
    ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/edges.c ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/requests.c)
foreach(call malloc calloc realloc import_pipe_send _exit)
    target_link_options(crevice_fuzz INTERFACE LINKER:--wrap=${call})
endforeach()

find_package(OpenEXR 3.1 REQUIRED)
find_package(PNG REQUIRED)
pkg_check_modules(CMOCKA REQUIRED IMPORTED_TARGET cmocka)
add_executable(fuzz_seeds
    fuzz/seeds.c fuzz/seeds_models.c fuzz/seeds_pictures.c fuzz/seeds_readers.c test_io_support.c)
target_compile_definitions(fuzz_seeds PRIVATE _XOPEN_SOURCE=700)
target_include_directories(fuzz_seeds PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(fuzz_seeds PRIVATE crevice_fuzz assimp::assimp crevice_flags
    OpenEXR::OpenEXRCore PNG::PNG PkgConfig::CMOCKA)
set(fuzz_seeds ${CMAKE_CURRENT_BINARY_DIR}/fuzz_seeds_made)
set(fuzz_kept ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/kept)
add_test(NAME fuzz_seeds COMMAND fuzz_seeds ${fuzz_seeds})
set_tests_properties(fuzz_seeds PROPERTIES FIXTURES_SETUP fuzz_seeds
    TIMEOUT ${CREVICE_TEST_TIMEOUT})

# Seeds of a target that are not damaged bit by bit, and which of the rest are.
set(fuzz_more_image image_packed)
set(fuzz_more_frame frame_packed)
set(fuzz_more_gltf gltf_text)
set(fuzz_step_image 1)
set(fuzz_step_gltf 1)
set(fuzz_step_checkpoint 1)
set(fuzz_step_pipe 1)
set(fuzz_step_cameras 1)
set(fuzz_step_append 97) # each copy waits for the disk
set(fuzz_step_mesh 2999) # each run forks
set(fuzz_step_image_packed 23)

foreach(target IN LISTS fuzz_targets)
    set(fuzz_corpora_${target} ${fuzz_kept}/${target} ${fuzz_seeds}/${target})
    foreach(more IN LISTS fuzz_more_${target})
        list(APPEND fuzz_corpora_${target} ${fuzz_seeds}/${more})
    endforeach()
endforeach()

if(CREVICE_FUZZ)
    if(NOT CMAKE_C_COMPILER_ID MATCHES "Clang")
        message(FATAL_ERROR "CREVICE_FUZZ needs clang: it comes with libFuzzer")
    endif()
    # Comparisons of what was computed steer no input, and half of the time would go there.
    get_property(sets GLOBAL PROPERTY CREVICE_SETS)
    list(TRANSFORM sets PREPEND crevice_kernels_)
    foreach(target IN ITEMS crevice ${sets})
        target_compile_options(${target} PRIVATE -fno-sanitize-coverage=trace-cmp)
    endforeach()
    set(CREVICE_FUZZ_SECONDS 10 CACHE STRING "How long each fuzzer runs as a test")
    add_custom_target(fuzzers DEPENDS fuzz_seeds)
    foreach(target IN LISTS fuzz_targets)
        add_executable(fuzz_${target} fuzz/libfuzzer.c)
        target_compile_definitions(fuzz_${target} PRIVATE FUZZ_TARGET=fuzz_${target})
        target_link_libraries(fuzz_${target} PRIVATE crevice_fuzz crevice_flags)
        target_link_options(fuzz_${target} PRIVATE -fsanitize=fuzzer)
        add_dependencies(fuzzers fuzz_${target})
        add_test(NAME fuzz_${target} COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/run.sh
            $<TARGET_FILE:fuzz_${target}> ${CMAKE_CURRENT_BINARY_DIR}/fuzz_${target}_run
            ${CREVICE_FUZZ_SECONDS} ${fuzz_corpora_${target}})
        set_tests_properties(fuzz_${target} PROPERTIES FIXTURES_REQUIRED fuzz_seeds
            LABELS fuzz TIMEOUT 600)
    endforeach()
    return()
endif()

# fuzz_test(NAME TARGET ARGUMENT...): in a folder of its own, on one thread: files so small
# are not worth more.
add_executable(fuzz_replay fuzz/replay.c)
target_link_libraries(fuzz_replay PRIVATE crevice_fuzz crevice_flags)
function(fuzz_test name target)
    set(place ${CMAKE_CURRENT_BINARY_DIR}/${name}_run)
    file(MAKE_DIRECTORY ${place})
    add_test(NAME ${name} WORKING_DIRECTORY ${place}
        COMMAND fuzz_replay ${target} ${ARGN})
    set_tests_properties(${name} PROPERTIES FIXTURES_REQUIRED fuzz_seeds
        TIMEOUT ${CREVICE_TEST_TIMEOUT} ENVIRONMENT OMP_NUM_THREADS=1)
endfunction()

foreach(target IN LISTS fuzz_targets)
    fuzz_test(fuzz_${target} ${target} ${fuzz_corpora_${target}})
    foreach(folder IN ITEMS ${target} ${fuzz_more_${target}})
        set(step ${fuzz_step_${folder}})
        if(CREVICE_SANITIZE AND step) # slow
            math(EXPR step "10 * ${step} + 1")
        endif()
        if(step)
            fuzz_test(damage_${folder} ${target} --damage ${step} ${fuzz_seeds}/${folder})
        endif()
    endforeach()
endforeach()
