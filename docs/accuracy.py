#!/usr/bin/env python3
"""Tables and pictures of docs/accuracy.md: what accuracy costs in time.

    docs/accuracy.py PROGRAM FOLDER            runs the studies, prints the tables
    docs/accuracy.py PROGRAM FOLDER --write    puts tables and pictures into docs/, too

Runs `PROGRAM accuracy problems/NAME.json --optimum -o FOLDER/NAME` for some of the problems,
where FOLDER/NAME holds no result yet: some two minutes of processor time. Takes the tables from
there. Those of costs and knobs stand in docs/accuracy.md between lines `<!-- NAME -->` and
`<!-- end of NAME -->`; its sentences sum up the others.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys

PROBLEMS = ["slider_crank", "four_bar", "robot_arm"]
PICTURES = {
    "accuracy.svg": "accuracy.svg",
    "accuracy-gradients.svg": "accuracy-gradients.svg",
    "accuracy-optimum.svg": "accuracy-optimum.svg",
}
PICTURED = "slider_crank"
ROOT = pathlib.Path(__file__).resolve().parent.parent


def study(program, folder, name, *options):
    result = folder / name / "result.json"
    if not result.exists():
        words = [program, "accuracy", f"problems/{name}.json", *options, "-o", str(folder / name)]
        done = subprocess.run(words, cwd=ROOT, stdout=subprocess.DEVNULL, check=False)
        if done.returncode != 0:
            sys.exit(f"{' '.join(words)} ended with {done.returncode}")
    return json.loads(result.read_text(encoding="utf-8"))


def percent(share):
    return f"{100 * share:g} %"


def milliseconds(seconds):
    return f"{1e3 * seconds:.2g} ms" if seconds < 0.00995 else f"{1e3 * seconds:.0f} ms"


def setting(document):
    text = f"{1e3 * document['step']:.3g} ms, "
    if "elements" in document:
        return text + str(document["elements"])
    return text + f"×{document['element_factor']:g}"


def grams(kilograms):
    sign = "−" if kilograms < 0 else "+"
    return f"{sign}{abs(1e3 * kilograms):.2g} g"


def value_cell(choice):
    return f"{milliseconds(choice['seconds'])} ({setting(choice)})" if choice else "–"


def optimum_cell(result, target):
    found = [
        run
        for run in result["optimum"]
        if "failure" not in run and run["relative_error"] <= target
    ]
    if not found:
        return "–"
    best = min(found, key=lambda run: run["seconds"])
    return f"{best['seconds']:.2g} s ({setting(best['settings'])}; {grams(best['error'])})"


def cost_table(results):
    yield "| problem | error | values | values and gradients | optimum |"
    yield "|---|---|---|---|---|"
    for name, result in results.items():
        for row in result["recommendations"]:
            target = row["error"]
            cells = [value_cell(row["values"]), value_cell(row["gradients"])]
            cells.append(optimum_cell(result, target))
            yield f"| {name} | {percent(target)} | " + " | ".join(cells) + " |"


def reference_table(results):
    yield "| problem | reference | optimum | known to | values known to | another formulation differs by |"
    yield "|---|---|---|---|---|---|"
    for name, result in results.items():
        optimum, reference = result["optimum_reference"], result["reference"]
        counted = result["counted"]
        error = max(reference["errors"][response] for response in counted)
        differences = reference["check"].get("differences")
        other = f"{max(differences[r] for r in counted):.1e}" if differences else "–"
        known = f"± {1e3 * optimum['error']:.2g} g" if optimum["error"] is not None else "–"
        yield (
            f"| {name} | {setting(reference)} | {optimum['objective']:.6g} kg | {known} | "
            f"{error:.1e} | {other} |"
        )


def effect_table(results):
    yield "| problem | effect | time | optimum |"
    yield "|---|---|---|---|"
    for name, result in results.items():
        for effect in result["effects"]:
            title = effect["effect"].replace("_", " ")
            word = "without" if effect["value"] == "off" else "with"
            if "failure" in effect:
                yield f"| {name} | {word} {title} | fails | – |"
                continue
            sign = "−" if effect["time_change"] < 0 else "+"
            time = f"{sign}{abs(100 * effect['time_change']):.0f} %"
            change = effect["optimum_change"]
            optimum = grams(change) if change is not None else "–"
            yield f"| {name} | {word} {title} | {time} | {optimum} |"


def knob_table(results):
    """Of one problem: all knobs at its recommended setting."""
    result = results[PICTURED]
    counted = result["counted"]
    yield f"| {PICTURED} at {setting(result['base'])} | time | largest error | optimum |"
    yield "|---|---|---|---|"
    for knob in result["knobs"]:
        title = f"{knob['knob'].replace('_', ' ')} {knob['value']}"
        if "failure" in knob:
            yield f"| {title} | fails | – | – |"
            continue
        error = max(knob["errors"][response] for response in counted)
        sign = "−" if knob["time_change"] < 0 else "+"
        change = knob["optimum_error"]
        yield (
            f"| {title} | {sign}{abs(100 * knob['time_change']):.0f} % | {error:.1e} | "
            f"{grams(change) if change is not None else '–'} |"
        )


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    results = {name: study(program, folder, name, "--optimum") for name in PROBLEMS}
    tables = {
        "costs": cost_table(results),
        "references": reference_table(results),
        "effects": effect_table(results),
        "knobs": knob_table(results),
    }
    tables = {name: "\n".join(table) for name, table in tables.items()}
    if "--write" not in sys.argv:
        print("\n\n".join(tables.values()))
        return
    page = ROOT / "docs" / "accuracy.md"
    text = page.read_text(encoding="utf-8")
    for name, table in tables.items():
        text = re.sub(
            rf"(<!-- {name} -->\n).*?(<!-- end of {name} -->)",
            lambda found, table=table: f"{found[1]}\n{table}\n\n{found[2]}",
            text,
            flags=re.DOTALL,
        )
    page.write_text(text, encoding="utf-8")
    for source, target in PICTURES.items():
        shutil.copyfile(folder / PICTURED / source, ROOT / "docs" / target)


main()
