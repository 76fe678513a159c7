# SPDX-License-Identifier: MIT
# What `cmake --install` puts where: library, headers, CMake package, pkg-config file; the
# tool installs itself. All paths are relative to the prefix, so that an installed tree can
# be moved.
option(CREVICE_INSTALL "Make rules for installation" ${PROJECT_IS_TOP_LEVEL})
if(NOT CREVICE_INSTALL)
    return()
endif()
include(CMakePackageConfigHelpers)

set(crevice_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/crevice)
install(TARGETS crevice EXPORT creviceTargets)
set(crevice_left_out "")
if(NOT CREVICE_HAS_VULKAN)
    set(crevice_left_out PATTERN "vulkan.h" EXCLUDE)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/crevice
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h" ${crevice_left_out})
# The shaders as they are, for renderers that take them in; they include shared/*.h.
if(TARGET crevice_shaders)
    set(crevice_shader_install ${CMAKE_INSTALL_DATADIR}/crevice/shaders)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/vulkan/shaders/
        DESTINATION ${crevice_shader_install}
        FILES_MATCHING PATTERN "*.glsl" PATTERN "*.comp")
    install(FILES ${PROJECT_SOURCE_DIR}/src/shared/params.h ${PROJECT_SOURCE_DIR}/src/shared/push.h
        DESTINATION ${crevice_shader_install}/shared)
endif()

# A file of targets for each kind of library, so that both can be installed.
get_target_property(crevice_type crevice TYPE)
if(crevice_type STREQUAL "STATIC_LIBRARY")
    set(crevice_kind static)
else()
    set(crevice_kind shared)
endif()
install(EXPORT creviceTargets NAMESPACE crevice:: DESTINATION ${crevice_cmake_dir}
    FILE crevice-${crevice_kind}-targets.cmake)

# A static library leaves its own dependencies to whoever links it.
set(crevice_pc_private -lm)
foreach(library IN LISTS CMAKE_DL_LIBS) # the Vulkan loader is looked up at run time
    string(APPEND crevice_pc_private " -l${library}")
endforeach()
if(CREVICE_OPENMP)
    find_package(OpenMP QUIET COMPONENTS C)
    if(OpenMP_C_FOUND)
        string(APPEND crevice_pc_private " ${OpenMP_C_FLAGS}")
    endif()
endif()
set(crevice_has_openmp OFF)
set(crevice_has_threads OFF) # of its own
if(CREVICE_OPENMP AND OpenMP_C_FOUND)
    set(crevice_has_openmp ON)
elseif(NOT WIN32)
    set(THREADS_PREFER_PTHREAD_FLAG ON)
    find_package(Threads QUIET)
    set(crevice_has_threads ${Threads_FOUND})
    string(APPEND crevice_pc_private " -pthread")
endif()
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/creviceConfig.cmake.in
    ${PROJECT_BINARY_DIR}/creviceConfig.cmake INSTALL_DESTINATION ${crevice_cmake_dir})
# Before 1.0 a minor version may break what the one before promised.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/creviceConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/creviceConfig.cmake
    ${PROJECT_BINARY_DIR}/creviceConfigVersion.cmake DESTINATION ${crevice_cmake_dir})

# Where only the static library is installed, `pkg-config --libs` needs no --static.
set(crevice_pc_cflags "")
set(crevice_pc_libs "")
if(crevice_type STREQUAL "STATIC_LIBRARY")
    set(crevice_pc_cflags " -DCRV_STATIC")
    set(crevice_pc_libs " ${crevice_pc_private}")
    set(crevice_pc_private "")
endif()
if(CREVICE_HAS_VULKAN)
    string(APPEND crevice_pc_cflags " -DCRV_HAS_VULKAN=1")
else()
    string(APPEND crevice_pc_cflags " -DCRV_HAS_VULKAN=0")
endif()
if(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
    set(crevice_pc_prefix ${CMAKE_INSTALL_PREFIX})
    set(crevice_pc_libdir ${CMAKE_INSTALL_LIBDIR})
else()
    file(RELATIVE_PATH crevice_pc_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
    string(REGEX REPLACE "/$" "" crevice_pc_prefix "\${pcfiledir}/${crevice_pc_prefix}")
    set(crevice_pc_libdir "\${prefix}/${CMAKE_INSTALL_LIBDIR}")
endif()
if(IS_ABSOLUTE "${CMAKE_INSTALL_INCLUDEDIR}")
    set(crevice_pc_includedir ${CMAKE_INSTALL_INCLUDEDIR})
else()
    set(crevice_pc_includedir "\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}")
endif()
configure_file(${PROJECT_SOURCE_DIR}/cmake/crevice.pc.in ${PROJECT_BINARY_DIR}/crevice.pc
    @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/crevice.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

if(TARGET crevice_tool AND NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr")
    # The tool finds its library beside itself, wherever the tree lies; in /usr the system does.
    if(NOT IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}" AND NOT IS_ABSOLUTE "${CMAKE_INSTALL_BINDIR}")
        file(RELATIVE_PATH crevice_rpath /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
        if(APPLE)
            set(crevice_origin "@loader_path")
        else()
            set(crevice_origin "$ORIGIN")
        endif()
        set_target_properties(crevice_tool PROPERTIES
            INSTALL_RPATH "${crevice_origin}/${crevice_rpath}")
    endif()
endif()

# Archives of what is installed: cpack -G TGZ, cpack -G ZIP.
if(PROJECT_IS_TOP_LEVEL)
    set(CPACK_GENERATOR TGZ ZIP)
    set(CPACK_PACKAGE_VENDOR "The Crevice authors")
    set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
    set(CPACK_VERBATIM_VARIABLES ON)
    include(CPack)
endif()
