# SPDX-License-Identifier: MIT
# shellcheck shell=bash disable=SC2034
# Sourced by ./demo and ./check: what they need from the system, how it is
# installed, and how the build is configured.

# One need a line: a command that has to be there, or "-" where the package itself is the
# need (libraries), and its name in Debian and Ubuntu.
needs_build='
cmake       cmake
ninja       ninja-build
gcc         gcc
pkg-config  pkg-config
-           libc6-dev
-           libembree-dev
-           libassimp-dev
-           libopenexr-dev
-           libpng-dev
-           libcjson-dev
-           libvulkan-dev
glslangValidator  glslang-tools
'
needs_tests='
g++         g++
python3     python3
spirv-cross spirv-cross
spirv-val   spirv-tools
clang-format  clang-format
-           libcmocka-dev
-           python3-dev
-           python3-numpy
-           python3-pytest
-           mesa-vulkan-drivers
-           vulkan-validationlayers
'

# What ./check --all needs beyond that.
needs_all='
clang            clang
chromium         chromium
llvm-symbolizer  llvm
Xvfb             xvfb
-                libgtk-4-dev
-                libclang-rt-dev
-                libomp-dev
-                slurmctld
-                slurmd
-                slurm-client
-                munge
'

# What study/run measures and draws with, and what tests it.
needs_study='
-         python3-numpy
-         python3-matplotlib
-         python3-jinja2
-         python3-openimageio
-         python3-pytest
chromium  chromium
'

# What builds and checks the Debian packages.
needs_packages='
dpkg-buildpackage  dpkg-dev
dh                 debhelper
dh_python3         dh-python
fakeroot           fakeroot
lintian            lintian
'

# To compile for 64-bit Arm on another machine and to run that.
needs_arm='
aarch64-linux-gnu-gcc  gcc-aarch64-linux-gnu
qemu-aarch64           qemu-user
-                      libc6-dev-arm64-cross
'

# The same for 64-bit Windows, WebAssembly and 32-bit x86.
needs_windows='
x86_64-w64-mingw32-gcc  gcc-mingw-w64-x86-64
wine                    wine
-                       wine64
'
needs_webassembly='
emcc  emscripten
node  nodejs
'
needs_x86_32() # the compiler's 32-bit libraries carry its version in their name
{
    printf '%s\n' '- libc6-dev-i386' "- lib32gcc-$(gcc -dumpversion | sed 's/\..*//')-dev"
}

# needs_missing NEEDS: the packages of those needs that are not met, one a line.
needs_missing()
{
    local command package
    while read -r command package; do
        [ -n "$command" ] || continue
        if [ "$command" != - ]; then
            command -v "$command" >/dev/null || echo "$package"
        elif [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" \
                != installed ]; then
            echo "$package"
        fi
    done <<<"$1"
}

# Where there is no dpkg, look for commands and libraries themselves; prints what is missing.
needs_missing_elsewhere()
{
    local command package library
    while read -r command package; do
        if [ -n "$command" ] && [ "$command" != - ] && ! command -v "$command" >/dev/null; then
            echo "$command (Debian package $package)"
        fi
    done <<<"$1"
    for library in OpenEXR assimp libpng libcjson; do
        pkg-config --exists "$library" 2>/dev/null || echo "$library with its headers"
    done
    if ! echo '#include <embree4/rtcore.h>' | gcc -E - >/dev/null 2>&1 \
        && ! echo '#include <embree3/rtcore.h>' | gcc -E - >/dev/null 2>&1; then
        echo "Embree 3 or 4 with its headers"
    fi
    if ! echo '#include <vulkan/vulkan.h>' | gcc -E - >/dev/null 2>&1; then
        echo "Vulkan's headers"
    fi
    if [[ $1 == *libcmocka-dev* ]] && ! pkg-config --exists cmocka 2>/dev/null; then
        echo "cmocka with its headers"
    fi
}

install_command()
{
    local sudo=$1
    shift
    echo "${sudo}apt-get update && ${sudo}apt-get install -y --no-install-recommends $*"
}

# needs_install NEEDS: installs what is missing, or says how and fails.
needs_install()
{
    local missing sudo=()
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        missing=$(needs_missing_elsewhere "$1")
        [ -n "$missing" ] || return 0
        echo "This is neither Debian nor Ubuntu. Install these, then run the command again:" >&2
        printf '%s\n' "$missing" | sed 's/^/  /' >&2
        return 1
    fi
    missing=$(needs_missing "$1" | sort -u | tr '\n' ' ')
    missing=${missing% }
    [ -n "$missing" ] || return 0
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            needs_refused "$missing"
            return 1
        elif sudo -n true 2>/dev/null; then
            sudo=(sudo -n)
        elif [ -t 0 ] && sudo -v; then
            sudo=(sudo)
        else
            needs_refused "$missing"
            return 1
        fi
    fi
    echo "Installing: $missing"
    # Names without quotes: the list is ours, and blanks part it. Stale lists may still do.
    "${sudo[@]}" apt-get -q update || echo "apt-get update failed; trying without" >&2
    # shellcheck disable=SC2086
    if ! "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive \
            apt-get -q install -y --no-install-recommends $missing; then
        needs_explain "$missing"
        return 1
    fi
}

needs_refused()
{
    echo "Packages are missing, and installing them takes root. Run this, then try again:" >&2
    if command -v sudo >/dev/null; then
        echo "  $(install_command 'sudo ' "$1")" >&2
    else
        echo "  su -c '$(install_command '' "$1")'" >&2
    fi
}

# After a failed installation: is it that this release has no such package?
needs_explain()
{
    local package
    for package in $1; do
        apt-cache show "$package" >/dev/null 2>&1 \
            || echo "This release has no package named $package." >&2
    done
    echo "The packages could not be installed; see the lines above. Run by hand:" >&2
    echo "  $(install_command "$([ "$(id -u)" -eq 0 ] || echo 'sudo ')" "$1")" >&2
}

# The build reads presets of CMake 3.25.
require_cmake()
{
    local version
    version=$(cmake --version | sed -n 's/^cmake version //p')
    if [ "$(printf '%s\n' 3.25 "$version" | sort -V | head -n 1)" != 3.25 ]; then
        echo "$(command -v cmake) is version $version, and 3.25 is needed. Debian 12 and" >&2
        echo "Ubuntu 24.04 have it; on older systems install a newer CMake first." >&2
        return 1
    fi
}

# configure PRESET [ARGUMENT...]: quietly, and anew where the tree was moved since.
configure()
{
    local preset=$1 home fresh=()
    shift
    if [ -f "build/$preset/CMakeCache.txt" ]; then
        home=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "build/$preset/CMakeCache.txt")
        [ "$home" = "$(pwd -P)" ] || fresh=(--fresh)
    fi
    # Modules of Python come as packages of the system, for the system's interpreter.
    if [ -x /usr/bin/python3 ]; then
        fresh+=(-DPython3_EXECUTABLE=/usr/bin/python3)
    fi
    cmake --preset "$preset" "${fresh[@]}" --log-level=WARNING \
        --no-warn-unused-cli "$@" >/dev/null
}
