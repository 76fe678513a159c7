#!/bin/sh
# SPDX-License-Identifier: MIT
# Installs the library, moves the installed tree, and builds and runs a host against it,
# through CMake's find_package and through pkg-config; then builds one that takes the
# sources in. pool: a static library without OpenMP, whose threads are its own.
# Usage: check_package.sh SOURCE WORK CC shared|static|pool
set -eu
source=$1 work=$2 cc=$3 kind=$4 openmp=ON
# The two kinds are built with two generators, so that both are tried.
case $kind in
shared) shared=ON generator=Ninja ;;
static) shared=OFF generator='Unix Makefiles' ;;
pool) shared=OFF generator=Ninja openmp=OFF ;;
*)
    echo "unknown kind $kind" >&2
    exit 2
    ;;
esac
consumer=$source/tests/consumer_cmake
rm -rf "$work"
mkdir -p "$work"

# One instruction set is enough: the others are installed in the same way. Nothing waits for
# the results, so the compiler need not optimise.
configure()
{
    cmake -G "$generator" -DCMAKE_BUILD_TYPE=Release -DCMAKE_C_FLAGS_RELEASE=-DNDEBUG \
        -DCREVICE_ISA=native --log-level=WARNING --no-warn-unused-cli "$@" >/dev/null
}

build()
{
    cmake --build "$1" -j "$(nproc 2>/dev/null || echo 2)" >"$work/build.log" \
        || { cat "$work/build.log" >&2; return 1; }
}

echo "-- $kind library, installed"
configure -S "$source" -B "$work/build" -DBUILD_SHARED_LIBS=$shared -DCMAKE_C_COMPILER="$cc" \
    -DCREVICE_BUILD_TOOLS=OFF -DCREVICE_BUILD_TESTS=OFF -DCREVICE_BUILD_EXAMPLES=OFF \
    -DCREVICE_OPENMP=$openmp \
    -DCMAKE_INSTALL_PREFIX="$work/first prefix"
build "$work/build"
cmake --install "$work/build" >/dev/null
mv "$work/first prefix" "$work/prefix"

# Nothing but the public headers, and no path of the build, may have got out.
vulkan=$(find "$work/prefix" -name creviceConfig.cmake \
    -exec sed -n 's/^set(crevice_HAS_VULKAN \(.*\))$/\1/p' {} +)
(cd "$source/include" && find crevice -name '*.h' | sort) >"$work/expected"
if [ "$vulkan" != ON ]; then
    sed -i '/vulkan\.h$/d' "$work/expected"
fi
(cd "$work/prefix/include" && find . -type f | sed 's|^\./||' | sort) >"$work/installed"
diff "$work/expected" "$work/installed"
if grep -rIlF -e "$source" -e "$work" "$work/prefix"; then
    echo "the files above name a folder of the build" >&2
    exit 1
fi

shaders=$work/prefix/share/crevice/shaders
if [ -d "$shaders" ]; then
    echo "-- GLSL, installed"
    glslang=$(sed -n 's/^CREVICE_GLSLANG:[A-Z]*=//p' "$work/build/CMakeCache.txt")
    for shader in "$shaders"/*.comp; do
        "$glslang" --quiet --target-env vulkan1.2 -I"$shaders" -o "$work/installed.spv" "$shader"
    done
fi

echo "-- find_package"
configure -S "$consumer" -B "$work/consumer_cmake" -DCMAKE_PREFIX_PATH="$work/prefix" \
    -DCMAKE_C_COMPILER="$cc"
build "$work/consumer_cmake"
"$work/consumer_cmake/consumer"

echo "-- find_package in a project of C++ alone"
configure -S "$consumer" -B "$work/consumer_cxx" -DCMAKE_PREFIX_PATH="$work/prefix" \
    -DCONSUMER_LANGUAGE=CXX
build "$work/consumer_cxx"
"$work/consumer_cxx/consumer"

echo "-- pkg-config"
pc=$(find "$work/prefix" -name crevice.pc)
PKG_CONFIG_PATH=$(dirname "$pc")
export PKG_CONFIG_PATH
libdir=$(dirname "$PKG_CONFIG_PATH")
pkg-config --validate crevice
# eval: pkg-config escapes blanks in paths for the shell.
eval "$cc -std=c11 \"\$consumer/main.c\" -o \"\$work/consumer_pkgconfig\" \
    $(pkg-config --cflags --libs crevice)"
LD_LIBRARY_PATH=$libdir "$work/consumer_pkgconfig"
if [ $shared = OFF ] && readelf -d "$work/consumer_pkgconfig" | grep -q libcrevice; then
    echo "the static library was not linked" >&2
    exit 1
fi
if [ "$kind" = pool ]; then
    for host in consumer_cmake/consumer consumer_cxx/consumer consumer_pkgconfig; do
        if readelf -d "$work/$host" | grep -Eq 'lib(gomp|omp|iomp)'; then
            echo "$host needs OpenMP, without which the library was built" >&2
            exit 1
        fi
    done
    exit 0 # the rest is that of the other kinds
fi

echo "-- add_subdirectory"
configure -S "$consumer" -B "$work/consumer_source" -DCREVICE_SOURCE="$source" \
    -DBUILD_SHARED_LIBS=$shared -DCMAKE_C_COMPILER="$cc"
if [ "$kind" = static ]; then # the objects are those of the installed library
    build "$work/consumer_source"
    "$work/consumer_source/consumer"
fi

echo "-- add_subdirectory leaves its parent's settings alone"
configure -S "$consumer" -B "$work/consumer_parent" -DCREVICE_SOURCE="$source" \
    -DCMAKE_BUILD_TYPE= -DCONSUMER_BUILD_TYPE_UNSET=ON -DCMAKE_C_COMPILER="$cc"
