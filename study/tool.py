# SPDX-License-Identifier: MIT
"""Runs `crevice`, and keeps what it made: a file or an answer for each command line.

A key is the digest of the program, of its arguments and of the files that they name, so
that a run that was interrupted goes on where it was, and nothing old is taken for new."""
import hashlib
import json
import os
import shlex
import subprocess
from pathlib import Path
from typing import Any

HOME = Path(__file__).resolve().parent.parent


class ToolError(Exception):
    """A run of the tool that failed; says what the tool said."""


def find_tool(given: str | None) -> Path:
    """The program: the given one, else the newest that was built here."""
    if given:
        if not Path(given).is_file():
            raise ToolError(f"{given}: is no program; name the tool crevice with --tool")
        return Path(given).resolve()
    built = sorted(HOME.glob("build/*/tools/crevice/crevice"), key=os.path.getmtime)
    if not built:
        raise ToolError("the tool crevice is not built; build it, or name it with --tool")
    return built[-1]


def digest_of(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def environment(command: str) -> dict[str, str]:
    """Threads that wait for work sleep: on a busy machine short runs take a tenth of the time.
    What is timed keeps the runtime's own way."""
    passive = {} if command == "bench" else {"OMP_WAIT_POLICY": "passive"}
    return passive | dict(os.environ)


class Tool:
    def __init__(self, program: Path, folder: Path, common: list[str], timed: list[str]):
        """common: arguments of every run that computes (--threads); timed: of those that
        estimate (--device, --isa)."""
        self.program = program
        self.folder = folder
        self.common, self.timed = common, timed
        self.digest = digest_of(program)
        self.runs = 0  # that were not kept from before
        self.files: dict[str, str] = {}
        folder.mkdir(parents=True, exist_ok=True)

    def name_of(self, argument: str) -> str:
        """What an argument means, wherever its file lies."""
        path = Path(argument)
        if path.parent == self.folder:
            return path.name
        if not (os.sep in argument or "." in argument) or not path.is_file():
            return argument
        if argument not in self.files:
            self.files[argument] = digest_of(path)
        return self.files[argument]

    def key(self, arguments: list[str]) -> str:
        words = [self.digest, *map(self.name_of, arguments)]
        return hashlib.sha256("\0".join(words).encode()).hexdigest()[:24]

    def run(self, arguments: list[str]) -> subprocess.CompletedProcess[str]:
        self.runs += 1
        done = subprocess.run([str(self.program), *arguments], text=True, check=False,
                              capture_output=True, stdin=subprocess.DEVNULL,
                              env=environment(arguments[0]))
        if done.returncode != 0:
            raise ToolError(f"crevice {shlex.join(arguments)}\n{done.stderr.strip()}")
        return done

    def settings_of(self, command: str) -> list[str]:
        if command in ("compare", "methods", "devices"):
            return []
        return self.common + (self.timed if command in ("ao", "bench", "render") else [])

    def make(self, command: str, arguments: list[str], suffix: str = ".exr") -> Path:
        """The file that the command writes with -o."""
        arguments = [command, *arguments, *self.settings_of(command)]
        made = self.folder / (self.key(arguments) + suffix)
        notes = made.with_suffix(".txt")
        if made.exists() and notes.exists():
            return made
        done = self.run([*arguments, "-o", str(made)])
        notes.write_text(f"crevice {shlex.join(arguments)}\n{done.stderr}", encoding="utf-8")
        return made

    def forget(self, made: Path) -> None:
        """Removes a file that only went into another one."""
        made.unlink(missing_ok=True)
        made.with_suffix(".txt").unlink(missing_ok=True)

    def notes(self, made: Path) -> str:
        """The command that made a file, and what the tool said of it."""
        return made.with_suffix(".txt").read_text(encoding="utf-8")

    def ask(self, command: str, arguments: list[str]) -> dict[str, Any]:
        """The JSON that the command prints."""
        arguments = [command, *arguments, *self.settings_of(command)]
        return self.recall(self.key(arguments), lambda: json.loads(self.run(arguments).stdout))

    def recall(self, key: str, make: Any) -> Any:
        """A value that JSON can hold, made once for each key."""
        kept = self.folder / (key + ".json")
        if kept.exists():
            return json.loads(kept.read_text(encoding="utf-8"))
        value = make()
        part = kept.with_suffix(".part")
        part.write_text(json.dumps(value), encoding="utf-8")
        part.replace(kept)
        return value
