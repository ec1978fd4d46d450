#!/usr/bin/env python3
"""What a call of the library costs from Python, beside the same call from C: of a design that was simulated last, so that
almost nothing is computed.

    bench/call_costs.py [--build build/release]

Needs gcc and the system's NumPy. Prints the median processor time of a call of pleuel_evaluate [us].
"""

import argparse
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
FILE = str(ROOT / "problems" / "slider_crank.json")
CALLS, ROUNDS = 1000, 21
IN_C = """
#include <pleuel.h>
#include <stdio.h>
#include <time.h>
int main(int count, char **words) {
  const char *const quick[] = {"/simulation/end_time=5 ms", "/simulation/step=0.1 ms"};
  pleuel_problem p;
  double x[4], f, c[6];
  if (pleuel_open(words[1], NULL, quick, 2, NULL, &p) || pleuel_bounds(p, x, NULL, NULL, 4)) return count;
  for (int round = 0; round < %d; ++round) {
    struct timespec begin, end;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &begin);
    for (int i = 0; i < %d; ++i) pleuel_evaluate(p, x, 4, &f, c, 6, NULL, NULL);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &end);
    printf("%%g\\n", ((end.tv_sec - begin.tv_sec) + 1e-9 * (end.tv_nsec - begin.tv_nsec)) / %d);
  }
  return 0;
}
""" % (ROUNDS, CALLS, CALLS)


def seconds_in_c(libraries: pathlib.Path) -> float:
    with tempfile.TemporaryDirectory() as folder:
        source, program = pathlib.Path(folder) / "calls.c", pathlib.Path(folder) / "calls"
        source.write_text(IN_C)
        link = [f"-I{ROOT / 'include'}", f"-L{libraries}", f"-Wl,-rpath,{libraries}", "-lpleuel"]
        subprocess.run(["gcc", "-O1", source, *link, "-o", program], check=True)
        lines = subprocess.run([program, FILE], check=True, capture_output=True, text=True).stdout.split()
    return statistics.median(map(float, lines))


def seconds_in_python() -> float:
    import pleuel

    problem = pleuel.load(FILE, set={"/simulation/end_time": "5 ms", "/simulation/step": "0.1 ms"})
    x, times = problem.start, []
    for _ in range(ROUNDS):
        begin = time.process_time()
        for _ in range(CALLS):
            problem.evaluate(x)
        times.append((time.process_time() - begin) / CALLS)
    return statistics.median(times)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release")
    libraries = parser.parse_args().build.resolve() / "lib"
    os.environ["PLEUEL_LIBRARY"] = str(libraries / "libpleuel.so")
    sys.path.insert(0, str(ROOT / "python"))
    in_c, in_python = 1e6 * seconds_in_c(libraries), 1e6 * seconds_in_python()
    print(f"C {in_c:.1f}  Python {in_python:.1f}  overhead {in_python - in_c:.1f} us")


main()
