#!/bin/sh
# SPDX-License-Identifier: MIT
# Each public header compiles alone, and twice, as C11 and as C++17.
# Usage: check_headers.sh INCLUDE_FOLDER CC CXX
set -eu
include=$1 cc=$2 cxx=$3
flags='-Wall -Wextra -Wconversion -Wshadow -pedantic -Werror -fsyntax-only'
count=0
failed=0
for header in "$include"/crevice/*.h; do
    name=crevice/${header##*/}
    source="#include \"$name\"
#include \"$name\"
int one(void);
int one(void) { return 1; }"
    for language in "$cc -x c -std=c11 -Wstrict-prototypes" "$cxx -x c++ -std=c++17"; do
        count=$((count + 1))
        # Flags without quotes: blanks part them.
        # shellcheck disable=SC2086
        if ! printf '%s\n' "$source" | $language $flags -I "$include" -; then
            echo "$name does not compile alone: $language" >&2
            failed=$((failed + 1))
        fi
    done
done
echo "$((count - failed)) passed, $failed failed"
[ "$count" -gt 0 ] && [ "$failed" -eq 0 ]
