#!/usr/bin/env python3
"""Enters the commands of pages as a reader would, and fails where one of them fails.

  run_pages.py PROGRAM FOLDER PAGE...

Each page gets a folder of its own below FOLDER that looks like the project's with a release build: examples/,
headers and build/release/qsmpc, which is PROGRAM. Of the page's fenced blocks, in their order,

  ```yaml title="NAME"         is written to the file NAME; of a file of examples/ it must be an exact part
  ```sh                        is run in the same shell as those before it, and must succeed
  ```sh exit="1"               must end with this exit code
  ```sh no-test="REASON"       is not run; it is listed with the reason
  ```text                      after a block that was run: each line must be in its output, its numbers within 2 %;
                               in lines with milliseconds they may be any
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FENCE = re.compile(r"^```(\w+)([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
TOLERANCE = 0.02  # relative


class Failure(Exception):
    pass


def shows(line, printed):
    """Whether the words of `line` are in the line `printed`, with about the same numbers or with milliseconds."""
    words = map(re.escape, " ".join(NUMBER.sub("\0", line).split()).split("\0"))
    found = re.search(f"({NUMBER.pattern})".join(words), " ".join(printed.split()))
    if not found:
        return False
    pairs = zip(map(float, NUMBER.findall(line)), map(float, found.groups()))
    return re.search(r"\bms\b", line) is not None or all(
        abs(there - here) <= TOLERANCE * abs(here) for there, here in pairs)


def blocks(text):
    """(line, language, options, body) of each fenced block."""
    for match in FENCE.finditer(text):
        options = dict(re.findall(r'([\w-]+)="([^"]*)"', match[2]))
        yield text.count("\n", 0, match.start()) + 1, match[1], options, match[3]


class Reader:
    """A shell in a folder that looks like the project's."""

    def __init__(self, program, folder):
        shutil.rmtree(folder, ignore_errors=True)
        release = folder / "build/release"
        release.mkdir(parents=True)
        (release / "qsmpc").symlink_to(program)
        shutil.copytree(ROOT / "examples", folder / "examples")
        for room in ("controller", "models", "harness", "render"):
            (folder / room).symlink_to(ROOT / room)
        self.folder = folder
        environment = dict(os.environ, PATH=f"{release}:{os.environ['PATH']}")
        self.shell = subprocess.Popen(["bash"], cwd=folder, env=environment, stdin=subprocess.PIPE,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8")

    def enter(self, commands):
        """Output and exit code of the first command that fails, or of the last."""
        # Functions run in this shell, so folders and variables persist. A failing command ends the
        # function.
        lines = re.sub(r"\\\n", " ", commands).strip().split("\n")
        body = " && ".join(f"{{ {line}\n}}" for line in lines if not line.startswith("#"))
        self.shell.stdin.write(f"{body}\necho \"@@ $?\"\n")
        self.shell.stdin.flush()
        output = ""
        for line in self.shell.stdout:
            if line.startswith("@@ "):
                return output, int(line[3:])
            output += line
        raise Failure(f"the shell ended\n{output}")

    def close(self):
        self.shell.stdin.close()
        self.shell.wait()


def put_file(folder, name, body):
    if name.startswith("examples/"):
        if body not in (ROOT / name).read_text(encoding="utf-8"):
            raise Failure(f"is not a part of {name}")
        return
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(body, encoding="utf-8")


def compare(body, output):
    """Every line of `body` must be in `output`, in this order."""
    printed = iter(output.splitlines())
    for line in filter(str.strip, body.splitlines()):
        if not any(shows(line, candidate) for candidate in printed):
            raise Failure(f"the page shows the line\n  {line}\nand the command printed\n{output}")


def follow(page, reader):
    """How many blocks of commands were run."""
    output, count = None, 0
    for line, language, options, body in blocks(page.read_text(encoding="utf-8")):
        try:
            if language in ("sh", "bash"):
                output = None
                if "no-test" in options:
                    print(f"{page.relative_to(ROOT)}:{line}: not run: {options['no-test']}")
                    continue
                output, code = reader.enter(body)
                count += 1
                if code != int(options.get("exit", 0)):
                    raise Failure(f"exit code {code}\n{body}{output}")
            elif "title" in options:
                put_file(reader.folder, options["title"], body)
            elif language == "text" and output is not None:
                compare(body, output)
        except Failure as failure:
            raise Failure(f"{page.relative_to(ROOT)}:{line}: {failure}") from None
    return count


def main():
    program, folder, *pages = sys.argv[1:]
    for name in pages:
        page = ROOT / name
        reader = Reader(pathlib.Path(program).resolve(), pathlib.Path(folder) / page.stem)
        try:
            count = follow(page, reader)
        except Failure as failure:
            sys.exit(f"run_pages: {failure}")
        finally:
            reader.close()
        if count == 0:
            sys.exit(f"run_pages: {name} has no command that is run")
        print(f"{name}: {count} blocks of commands, ok")


main()
