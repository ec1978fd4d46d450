#!/usr/bin/env python3
"""Makes the Debian packages of a build, unpacks them into a folder, and runs what they bring.

    packages.py BUILD
"""

import os
import pathlib
import subprocess
import sys
import tempfile

NAMES = {"pleuel", "libpleuel0", "libpleuel-dev", "python3-pleuel"}


def run(*words: object, **more: object) -> str:
    """Standard output; after a failure all of it."""
    done = subprocess.run([str(word) for word in words], text=True, capture_output=True, **more)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


def expect_dependencies(package: pathlib.Path) -> str:
    """The name of a package; what links a library has to name those of the system that it needs."""
    name, depends = (run("dpkg-deb", "-f", package, field).strip() for field in ("Package", "Depends"))
    wanted = "libudunits2-0" if name == "libpleuel0" else "libpleuel0"
    if wanted not in depends:
        sys.exit(f"{name} depends on {depends!r}, which lacks {wanted}")
    return name


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        made, root = pathlib.Path(folder) / "made", pathlib.Path(folder) / "root"
        run("cpack", "-G", "DEB", "-B", made, cwd=sys.argv[1])
        packages = list(made.glob("*.deb"))
        names = {expect_dependencies(package) for package in packages}
        if names != NAMES:
            sys.exit(f"the packages are {names}")
        for package in packages:
            run("dpkg-deb", "-x", package, root)
        for name in NAMES:
            (root / "usr/share/doc" / name / "copyright").read_text()
        print(run(root / "usr/bin/pleuel", "show", root / "usr/share/pleuel/problems/slider_crank.json").splitlines()[0])
        environment = {
            **os.environ, "PYTHONPATH": str(root / "usr/lib/python3/dist-packages"),
            "LD_LIBRARY_PATH": str(next(root.rglob("libpleuel.so")).parent), "PYTHONDONTWRITEBYTECODE": "1",
        }
        print(run("/usr/bin/python3", "-c", "import pleuel; print(pleuel.version())", env=environment), end="")


main()
