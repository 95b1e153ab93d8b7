"""The copy of the project in which mutants are compiled and linked, and the tests that it passes."""
import hashlib
import json
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
WORK = ROOT / "build" / "mutation"
TREE = WORK / "tree"
BUILD = TREE / "build" / "test"


def fail(message):
    print(f"mutate: {message}", file=sys.stderr)
    sys.exit(2)


def run(command, **options):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)


def stopped(done):
    """The result of a command, unless Ctrl-C ended it, which says nothing about a mutant."""
    if done.returncode in (-signal.SIGINT, -signal.SIGTERM):
        raise KeyboardInterrupt
    return done


def must(command, what):
    done = run(command)
    if done.returncode != 0:
        print(done.stdout[-3000:], file=sys.stderr)
        fail(f"{what} failed")
    return done.stdout


def compiled_alone(sources):
    """What is added to the top-level CMakeLists.txt of the copy so that a mutant does not compile a whole batch."""
    # A source's properties are seen only in the folder whose CMakeLists.txt names it.
    folders = {next(str(folder) for folder in pathlib.Path(source).parents if (ROOT / folder / "CMakeLists.txt").exists())
               for source in sources}
    files = "\n".join("  ${CMAKE_SOURCE_DIR}/" + source for source in sources)
    return (f"\nset_source_files_properties(\n{files}\n"
            f"  DIRECTORY {' '.join(sorted(folders))} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)\n")


def copy_project(sources):
    """What git knows of the project as it is now, with `sources` compiled one by one; files that are the same keep
    their times."""
    known = must(["git", "-C", ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard"], "git ls-files")
    wanted = {name for name in known.split("\0") if name and (ROOT / name).is_file()}
    for name in wanted:
        source, copy = ROOT / name, TREE / name
        content = source.read_bytes()
        if name == "CMakeLists.txt":
            content += compiled_alone(sources).encode()
        if copy.exists() and copy.read_bytes() == content:
            continue
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_bytes(content)
        shutil.copymode(source, copy)
    for copy in [path for path in TREE.rglob("*") if path.is_file()]:
        name = str(copy.relative_to(TREE))
        if name not in wanted and not name.startswith("build/"):
            copy.unlink()


def build(targets):
    """As scripts/test does, which takes what was compiled before from ccache."""
    return run(["bash", "-c", 'source "$0/scripts/common.sh"; build test --target "$@"', TREE, *targets])


def compilations():
    """{source: (command, object file)} of all that is compiled, the sources of batches only as batches."""
    found = {}
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        words = [word for word in shlex.split(entry["command"]) if word != "ccache"]
        found[os.path.relpath(entry["file"], TREE)] = (words, BUILD / words[words.index("-o") + 1])
    return found


def link(output, objects, place, flags=(), original=None):
    """Links what the build has as `output` with `objects`, which come before those of libraries that define the same,
    and without the object `original`. Returns whether that was possible."""
    steps = must(["ninja", "-C", BUILD, "-t", "commands", output], f"asking how {output} is linked")
    last = steps.strip().splitlines()[-1]  # followed by what the build does with it
    words = shlex.split(next(step for step in last.split("&&") if f" -o {output} " in step))
    words = [word for word in words if BUILD / word != original]
    at = words.index("-o")
    # Traced twice, the linker also names what it takes from libraries: the original where the objects lack something.
    words[at:at + 2] = [*map(str, objects), *flags, "-Wl,--trace", "-Wl,--trace", "-o", str(place)]
    done = stopped(run(words, cwd=BUILD))
    if original is not None:
        library = next(part for part in original.parts if part.endswith(".dir")).removesuffix(".dir")
        if f"lib{library}.a){original.name}" in done.stdout:
            return False
    return done.returncode == 0


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def tests_of(program):
    """The tests of a program that pass, each with its file and the seconds that it takes."""
    cache = WORK / f"{program}.json"
    binary = BUILD / "tests" / program
    if not cache.exists() or cache.stat().st_mtime < binary.stat().st_mtime:
        run([binary, f"--gtest_output=json:{cache}.new"], cwd=BUILD / "tests")
        os.replace(f"{cache}.new", cache)
    tests = []
    for suite in json.loads(cache.read_text())["testsuites"]:
        for test in suite["testsuite"]:
            if test.get("result") == "COMPLETED" and not test.get("failures"):
                name = f"{test['classname']}.{test['name']}"
                seconds = float(test["time"].rstrip("s"))
                tests.append((name, os.path.relpath(test["file"], TREE), seconds))
    return tests
