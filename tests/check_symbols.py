#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Which room of libcrevice may use whose functions and tables: what the linker sees, where
check_arrows.py sees what is included. And what no room may: variables that calls share,
functions that open files, read the environment, print, set the locale or end the process. Usage: check_symbols.py NM LIST; LIST is a file that
names the library's objects, one a line. Exits 1 and lists what breaks a rule."""
import re
import subprocess
import sys

# Room: the rooms whose symbols it may use.
ROOMS = {
    "base": set(),
    "core": {"base"},
    "methods": {"base", "core"},
    "filters": {"base", "core"},
    "cpu/kernels": set(),
    "cpu": {"base", "core", "cpu/kernels"},
    "vulkan": {"base", "core"},
    "backends": {"cpu", "vulkan"},  # src/backends.c: the list of them
}

# Tables that a room may name beyond its rooms: lists of methods, filters and backends.
TABLES = {"core": re.compile(r"crv__(method|filter)_\w+$|crv__backends$")}


FORBIDDEN = re.compile(r"(f?open(64)?|openat|creat|getenv|secure_getenv|socket|connect|system"
                       r"|popen|fork|exec\w+|(_|quick_)?exit|_Exit|abort|raise|kill|signal"
                       r"|sigaction|setlocale|printf|puts|putchar|fputs|fwrite|stdout|stderr"
                       r"|rand|srand|strtok)$")
# What the linker may write to; tables of pointers lie in .data.rel.ro.
VARIABLES = re.compile(r"\.(data|bss|tdata|tbss|lbss|ldata)(\.(?!rel\.ro).*)?$|\*COM\*$")


def room_of(path):
    """The room of an object file, from the part of its path that names its source."""
    if "crevice_kernels_" in path:
        return "cpu/kernels"
    match = re.search(r"crevice\.dir/(?:\./)?(\w+)[/.]", path)
    return match.group(1) if match and match.group(1) in ROOMS else None


def tables_of(nm, words, paths):
    """The lines that nm prints of each object, by the object's path."""
    lines = subprocess.run([nm, "-A", *words, *paths], check=True, capture_output=True,
                           text=True).stdout.splitlines()
    tables = {path: [] for path in paths}
    for line in lines:
        path, found, rest = line.partition(".o:")
        if found and rest:  # else a heading
            tables[path + ".o"].append(rest)
    return tables


def symbols_of(lines):
    """Names that an object defines, and names that it wants from others."""
    pairs = [line.split()[-2:] for line in lines if line.strip()]
    defined = {name for kind, name in pairs if kind != "U"}
    wanted = {name for kind, name in pairs if kind == "U"}
    return defined, wanted


def variables_of(lines):
    """Names of what can be written to: the last of the columns is the section."""
    rows = [[cell.strip() for cell in line.split("|")] for line in lines if "|" in line]
    return [row[0] for row in rows if VARIABLES.match(row[-1]) and row[3] == "OBJECT"]


def main(nm, paths):
    faults = 0
    homes = {}
    wants = []
    symbols, sections = tables_of(nm, ["-g"], paths), tables_of(nm, ["-f", "sysv"], paths)
    for path in paths:
        room = room_of(path)
        if room is None:
            print(f"{path}: lies in no room; add its folder to {__file__}")
            faults += 1
            continue
        defined, wanted = symbols_of(symbols[path])
        homes.update((name, room) for name in defined)
        wants.append((path, room, wanted))
        for name in variables_of(sections[path]):
            print(f"{path}: has a variable {name}, which all calls would share")
            faults += 1
        for name in sorted(filter(FORBIDDEN.match, wanted)):
            print(f"{path}: calls {name}(), which a library may not")
            faults += 1
    arrows = 0
    for path, room, wanted in wants:
        for name in sorted(wanted & homes.keys()):
            home = homes[name]
            arrows += 1
            table = TABLES.get(room)
            if home != room and home not in ROOMS[room] and not (table and table.match(name)):
                print(f"{path}: uses {name} of {home}/, which {room}/ may not")
                faults += 1
    if not arrows:
        print("no object uses another's symbol; are these the library's objects?")
        faults += 1
    print(f"{len(wants)} objects, {arrows} arrows, {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: check_symbols.py NM LIST")
    with open(sys.argv[2], encoding="utf-8") as listed:
        sys.exit(main(sys.argv[1], [line.strip() for line in listed if line.strip()]))
