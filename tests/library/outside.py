#!/usr/bin/env python3
"""Installs a build into a folder, and uses it from there: from C, from C++ by find_package, from Python.

    outside.py BUILD
"""

import os
import pathlib
import subprocess
import sys
import tempfile

TESTS = pathlib.Path(__file__).resolve().parent
ROOT = TESTS.parents[1]
PROBLEM = str(ROOT / "problems" / "slider_crank.json")
PYTHON = """
import pleuel, sys
p = pleuel.load(sys.argv[1], set={"/simulation/end_time": "5 ms", "/simulation/step": "0.1 ms"})
assert abs(p.evaluate().objective - 7850 * 0.02 * 0.03 * 0.3) < 1e-12
assert p.jacobian().shape == (8, 4)
assert pleuel.__file__.startswith(sys.argv[2]), pleuel.__file__
"""


def run(*words: object, **environment: str) -> str:
    """Standard output; the rest, and all of it after a failure, on standard error."""
    done = subprocess.run([str(word) for word in words], env={**os.environ, **environment}, text=True, capture_output=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


def use_from_c(prefix: pathlib.Path, libraries: pathlib.Path, work: pathlib.Path) -> None:
    """With an address sanitizer in the program, which the library knows nothing of."""
    source = work / "c_test.c"
    source.write_text((TESTS / "c_test.c").read_text().replace('"include/pleuel.h"', "<pleuel.h>"))
    flags = run("pkg-config", "--cflags", "--libs", "pleuel", PKG_CONFIG_PATH=str(libraries / "pkgconfig")).split()
    for more in ([], ["-fsanitize=address"]):
        run("gcc", "-std=c99", "-O0", *more, source, *flags, "-lm", "-o", work / "c_test")
        print(run(work / "c_test", PROBLEM, LD_LIBRARY_PATH=str(libraries)), end="")


def use_from_cpp(prefix: pathlib.Path, work: pathlib.Path) -> None:
    run("cmake", "-S", TESTS / "outside", "-B", work / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", work / "build")
    print(run(work / "build" / "outside", PROBLEM), end="")


def use_from_python(prefix: pathlib.Path, libraries: pathlib.Path) -> None:
    """By the system's Python, whose NumPy it is."""
    package = prefix / "lib" / "python3" / "dist-packages"
    run("/usr/bin/python3", "-c", PYTHON, PROBLEM, package, PYTHONPATH=str(package), LD_LIBRARY_PATH=str(libraries),
        PYTHONDONTWRITEBYTECODE="1")


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        prefix, work = pathlib.Path(folder) / "installed", pathlib.Path(folder) / "work"
        work.mkdir()
        run("cmake", "--install", sys.argv[1], "--prefix", prefix)
        libraries = next(prefix.rglob("libpleuel.so")).parent
        print(run(prefix / "bin" / "pleuel", "--version"), end="")
        use_from_c(prefix, libraries, work)
        use_from_cpp(prefix, work)
        use_from_python(prefix, libraries)


main()
