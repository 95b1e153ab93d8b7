"""Which test suites execute which functions: others cannot notice a mutant of these."""
import concurrent.futures
import json
import os
import pathlib
import shutil
import subprocess
import tempfile

from project import BUILD, TREE, WORK, fail, link, run, stopped, tests_of


def instrumented(source, command, folder):
    """Compiles a source so that it counts what is executed. Returns its object file."""
    target = folder / (source.replace("/", "__") + ".o")
    words = [str(target) if word == command[command.index("-o") + 1] else word for word in command]
    done = stopped(run([*words, "--coverage", "-fprofile-update=atomic", "-O1", "-w"], cwd=BUILD))
    if done.returncode != 0:
        fail(f"{source} could not be compiled with --coverage:\n{done.stdout[-1000:]}")
    return target


def executed(binary, suite, folder):
    """{(source, first line, last line)} of the functions that a test suite executes."""
    with tempfile.TemporaryDirectory(dir=WORK) as name:
        environment = {**os.environ, "GCOV_PREFIX": name, "GCOV_PREFIX_STRIP": "99", "TMPDIR": name}
        stopped(run([binary, f"--gtest_filter={suite}.*"], cwd=BUILD / "tests", env=environment))
        counts = sorted(pathlib.Path(name).glob("*.gcda"))
        for file in counts:
            notes = file.with_suffix(".gcno")
            notes.symlink_to(folder / notes.name)
        documents = []
        if counts:
            read = subprocess.run(["gcov", "--json-format", "--stdout", *counts], capture_output=True, text=True, check=True)
            documents = documents_in(read.stdout)
    return {(os.path.relpath(file["file"], TREE), function["start_line"], function["end_line"])
            for document in documents
            for file in document["files"] for function in file["functions"] if function["execution_count"] > 0}


def documents_in(text):
    """JSON documents that follow each other, not always on lines of their own."""
    documents, decoder = [], json.JSONDecoder()
    text = text.strip()
    while text:
        document, end = decoder.raw_decode(text)
        documents.append(document)
        text = text[end:].lstrip()
    return documents


def measured(program, sources, compiled, jobs):
    """Runs each suite of a test program with these sources instrumented. Returns the same as reach_of."""
    folder = WORK / "reach" / program
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        objects = list(pool.map(lambda source: instrumented(source, compiled[source][0], folder), sources))
        # Optimised less, objects may leave symbols to their originals, which bring the others along.
        flags = ["--coverage", "-Wl,--allow-multiple-definition"]
        if not link(f"tests/{program}", objects, folder / program, flags):
            fail(f"{program} could not be linked with --coverage")
        suites = sorted({name.rpartition(".")[0] for name, _, _ in tests_of(program)})
        found = list(pool.map(lambda suite: executed(folder / program, suite, folder), suites))
    functions = {}
    for suite, places in zip(suites, found):
        for place in places:
            functions.setdefault(place, []).append(suite)
    return {source: [[first, last, names] for (of, first, last), names in sorted(functions.items()) if of == source]
            for source in sources}


def reach_of(program, sources, compiled, jobs):
    """{source: [[first line, last line, suites]]} of all functions of the sources that a test program executes."""
    cache = WORK / f"{program}.reach.json"
    binary = BUILD / "tests" / program
    if cache.exists() and cache.stat().st_mtime >= binary.stat().st_mtime:
        reach = json.loads(cache.read_text())
        if all(source in reach for source in sources):
            return reach
    reach = measured(program, sources, compiled, jobs)
    cache.with_suffix(".new").write_text(json.dumps(reach))
    os.replace(cache.with_suffix(".new"), cache)
    return reach


def suites_that_reach(functions, line):
    """The suites that execute the innermost function at the line; where none is there, those that execute any."""
    around = [last - first for first, last, _ in functions if first <= line <= last]
    return {suite for first, last, suites in functions for suite in suites
            if not around or (first <= line <= last and last - first == min(around))}
