# SPDX-License-Identifier: MIT
# Style, headers and installation: scripts that look at the source tree, or build their own.
# Sanitizers have nothing to find there.
if(CREVICE_SANITIZE)
    return()
endif()

set(here ${CMAKE_CURRENT_SOURCE_DIR})
function(style_test name)
    add_test(NAME ${name} COMMAND ${ARGN})
    set_tests_properties(${name} PROPERTIES LABELS style TIMEOUT 120 SKIP_RETURN_CODE 77)
endfunction()
function(packaging_test name)
    add_test(NAME ${name} COMMAND ${ARGN})
    set_tests_properties(${name} PROPERTIES LABELS packaging TIMEOUT 600)
endfunction()

find_package(Python3 REQUIRED COMPONENTS Interpreter)
style_test(style_arrows ${Python3_EXECUTABLE} ${here}/check_arrows.py ${PROJECT_SOURCE_DIR})
file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/objects.txt
    CONTENT "$<JOIN:${crevice_objects},\n>\n")
style_test(style_symbols ${Python3_EXECUTABLE} ${here}/check_symbols.py ${CMAKE_NM}
    ${CMAKE_CURRENT_BINARY_DIR}/objects.txt)
style_test(style_text ${Python3_EXECUTABLE} ${here}/check_style.py ${PROJECT_SOURCE_DIR})
style_test(style_scripts ${Python3_EXECUTABLE} ${here}/check_scripts.py)
style_test(style_format sh ${here}/check_format.sh ${PROJECT_SOURCE_DIR})
style_test(style_headers sh ${here}/check_headers.sh
    ${PROJECT_SOURCE_DIR}/include ${CMAKE_C_COMPILER} g++)
if(TARGET crevice_shaders)
    get_target_property(shaders crevice_shaders CREVICE_INCLUDE)
endif()
style_test(style_msvc ${Python3_EXECUTABLE} ${here}/check_msvc.py ${PROJECT_SOURCE_DIR}
    "${shaders}" "${CREVICE_VULKAN_HEADERS}")
set_tests_properties(style_msvc PROPERTIES LABELS once) # it compiles the library
style_test(style_setup bash ${here}/check_setup.sh ${PROJECT_SOURCE_DIR})

foreach(kind shared static pool)
    packaging_test(packaging_${kind} sh ${here}/check_package.sh ${PROJECT_SOURCE_DIR}
        ${CMAKE_CURRENT_BINARY_DIR}/packaging_${kind} ${CMAKE_C_COMPILER} ${kind})
endforeach()
if(TARGET crevice_tool)
    packaging_test(packaging_tool sh ${here}/check_tool_install.sh ${PROJECT_BINARY_DIR}
        ${CMAKE_CURRENT_BINARY_DIR}/packaging_tool)
endif()
if(TARGET example_minimal)
    packaging_test(packaging_example ${Python3_EXECUTABLE} ${here}/check_example.py
        $<TARGET_FILE:example_minimal> ${CMAKE_CURRENT_BINARY_DIR}/packaging_example)
endif()
if(TARGET example_host)
    add_test(NAME example_host COMMAND ${Python3_EXECUTABLE} ${here}/check_host.py
        $<TARGET_FILE:example_host>)
    set_tests_properties(example_host PROPERTIES TIMEOUT 60)
endif()
