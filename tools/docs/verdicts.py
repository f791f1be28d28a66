#!/usr/bin/env python3
"""docs/verdicts.md: the part below its mark is made from validation/cases, validation/flags.json and the results of a run.

    verdicts.py           say whether the page is what the cases make of it now; tables of quantities are taken as they stand
    verdicts.py --run     the same, tables against the results of the last run too, apart from what was measured (lines that begin with `measured`)
    verdicts.py --write   make it anew; cases that build/cases has no results of keep the tables that they have

Results are build/cases/<case>/results.json, left by `gate run` (make validate; --tier full for all). docs/measured/faults.csv, if it is there, says which
case was the first to catch which fault.
"""
import csv, glob, json, math, os, re, sys

MARK = "<!-- What follows is made by tools/docs/verdicts.py from the cases and the results of a run. Do not edit. -->"
LAYERS = [("pair", "Layer 1: a frozen pair"), ("noise", "Layer 2: noise at frozen places"), ("single", "Layer 3: one sphere"), ("two-bodies", "Layer 4: two bodies"),
          ("dilute", "Layer 5: dilute"), ("dense", "Layer 6: dense"), ("published", "Layer 7: published figures")]
PAGE = "docs/verdicts.md"


def number(text):
    return float(text)      # numbers, and the words nan and inf that JSON cannot say


def short(x):
    return f"{x:.3g}"


def bar_of(result):
    """Kind of test, and its bar in words: what the results of one table row share."""
    p, tolerance, resolution, declared = (number(result[k]) for k in ("p", "tolerance", "resolution", "declared"))
    if not math.isnan(p):
        return "obeys", "two-stage p" + ("" if math.isnan(declared) else f"; must resolve {short(declared)}")
    if not math.isnan(resolution):
        return "agrees", f"within {short(tolerance)}, four standard errors included"
    if math.isnan(tolerance):
        return "says", "-"
    return "exact", f"error at most {short(tolerance)}"


def measured_of(results):
    """The worst of a row, from our solver."""
    kind = bar_of(results[0])[0]
    if kind == "obeys":
        sees = [number(r["resolution"]) for r in results if not math.isnan(number(r["resolution"]))]
        text = f"least p {short(min(number(r['p']) for r in results))}"
        return text + (f", resolves {short(max(sees))}" if sees else "")
    worst = max((number(r["error"]) for r in results), default=math.nan)
    return "-" if math.isnan(worst) else f"worst {short(worst)}"


def names_of(results):
    """Quantities of a row; where names differ in numbers only ("gap 0.01: force"), once with the number of them."""
    groups = {}
    for r in results:
        groups.setdefault(re.sub(r"(?<![A-Za-z0-9_.])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?", "#", r["what"]), []).append(r["what"])
    parts = [items[0] if len(items) == 1 else f"{pattern} ({len(items)})" for pattern, items in groups.items()]
    return "; ".join(parts).replace("|", "\\|")


def table(results):
    rows = {}
    for r in results:
        if r["verdict"] != "skip":
            rows.setdefault((r["judgement"], *bar_of(r)), []).append(r)
    lines = ["| quantities | judged as | test | bar |", "| --- | --- | --- | --- |"]
    measured = []
    for (judgement, kind, bar), members in rows.items():
        lines.append(f"| {names_of(members)} | {'model' if judgement else 'invariant'} | {kind} | {bar} |")
        measured.append(measured_of(members))
    return lines + ["", "measured with our solver, row by row: " + "; ".join(measured)]


def case_lines(case, results, old, caught, reasons):
    """One case. `old`: its lines in the present page, for the table where there are no results."""
    lines = [f"### {case['name']}", "", case["about"].rstrip(".") + "."]
    facts = [f"check `{case['check']}`", f"{case['tier']} tier", "needs " + ", ".join(case["needs"]) if case["needs"] else "", f"seed {case['seed']}"]
    if case.get("p_values"):
        facts.append(f"at most {case['p_values']} p-values")
    lines += ["", "; ".join(f for f in facts if f) + "."]
    if "tolerance" in case:
        reason = case["tolerance"]["reason"].rstrip(".")
        first = reasons.setdefault(reason, case["name"])
        lines += ["", f"Tolerance {case['tolerance']['value']:g}" + (f": {reason}." if first == case["name"] else f", for the reason given at [{first}](#{first}).")]
    if "double" in case:
        lines += ["", "For doubles only: " + case["double"].rstrip(".") + "."]
    sizes = {k: v for k, v in case.get("parameters", {}).items() if k in ("draws", "realisations", "repeats", "pairs", "copies", "spheres", "counts", "strain", "steps")
             and not isinstance(v, (list, dict))}
    if sizes:
        lines += ["", "Sample: " + ", ".join(f"{k} {v:g}" for k, v in sizes.items()) + "."]
    if "declared" in case.get("parameters", {}):
        lines += ["", "Must resolve: " + ", ".join(f"{k.replace('_', ' ')} {v:g}" for k, v in case["parameters"]["declared"].items()) + " (of itself)."]
    margins = {k: v for k, v in case.get("parameters", {}).items() if k.endswith("margin")}
    if margins:
        lines += ["", "Margins: " + ", ".join(f"{k[:-7].replace('_', ' ')} {v:g}" for k, v in margins.items()) + "."]
    if case["flags"]:
        lines += ["", "Would show: " + ", ".join(case["flags"]) + "."]
    if caught:
        lines += ["", "measured: first to catch " + "; ".join(caught) + "."]
    if results:
        lines += [""] + table(results)
    else:
        start = next((k for k, line in enumerate(old) if line.startswith("| quantities")), None)
        lines += [""] + (old[start:] if start is not None else ["measured: no run of this case was at hand when the page was made; its quantities follow with the next"])
    while lines[-1] == "":
        lines.pop()
    return lines + [""]


def old_sections(page):
    sections, name = {}, None
    for line in page.splitlines():
        if line.startswith("#"):
            name = line[4:] if line.startswith("### ") else None
        elif name:
            sections.setdefault(name, []).append(line)
    return sections


def generated(page, with_results):
    cases = []
    for path in glob.glob("validation/cases/*/*/case.json"):
        case = json.load(open(path))
        case["name"] = os.path.basename(os.path.dirname(path))
        cases.append(case)
    cases.sort(key=lambda c: (["pair", "noise", "single", "two-bodies", "dilute", "dense", "published"].index(c["layer"]), ["fast", "standard", "full"].index(c["tier"]),
                              c.get("order", 50), c["name"]))
    old, caught, reasons, used = old_sections(page), {}, {}, 0
    if os.path.exists("docs/measured/faults.csv"):
        with open("docs/measured/faults.csv") as f:
            for row in csv.DictReader(line for line in f if not line.startswith("#")):
                caught.setdefault(row.get("A") or "", []).append(row["fault"])
    n = sum(case.get("p_values", 0) for case in cases)
    lines = [MARK, "", "## In numbers", "", "| layer | fast | standard | full | p-values |", "| --- | --- | --- | --- | --- |"]
    for layer, title in LAYERS:
        of_layer = [c for c in cases if c["layer"] == layer]
        tiers = " | ".join(str(sum(c["tier"] == tier for c in of_layer)) for tier in ("fast", "standard", "full"))
        lines.append(f"| {title} | {tiers} | {sum(c.get('p_values', 0) for c in of_layer)} |")
    lines += ["", f"{len(cases)} cases, at most n = {n} p-values. For a right code: a second stage somewhere in a run of all tiers with a chance of at most {1e-4 * n:.2g}; a given result "
              f"failed falsely with a chance of {1e-10 / n:.1g}, any of them with at most 1e-10.", ""]
    for layer, title in LAYERS:
        lines += [f"## {title}", ""]
        for case in (c for c in cases if c["layer"] == layer):
            path = os.path.join("build/cases", case["name"], "results.json")
            results = json.load(open(path))["results"] if with_results and os.path.exists(path) else None
            bad = [r["what"] for r in results or [] if r["verdict"] not in ("pass", "skip")]
            if bad:
                sys.exit(f"verdicts: in the last run {case['name']} did not pass ({bad[0]}); the page is made from a run in which all pass")
            if results is not None and all(r["verdict"] == "skip" for r in results):
                results = None
            used += results is not None
            lines += case_lines(case, results, old.get(case["name"], []), caught.get(case["name"]), reasons)
    flags = json.load(open("validation/flags.json"))
    lines += ["## Classes of mistake", "", "| flag | mistake | effect | cases that would show it |", "| --- | --- | --- | --- |"]
    for flag, entry in sorted(flags.items()):
        count = sum(flag in c["flags"] for c in cases)
        lines.append("| " + " | ".join(text.replace("|", "\\|") for text in (flag, entry["mistake"], entry["effect"], str(count))) + " |")
    return "\n".join(lines) + "\n", len(cases), used, sum(line.startswith("measured with") for line in lines)


def without_measured(text):
    return [line for line in text.splitlines() if not line.startswith("measured")]


def main(word):
    os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
    page = open(PAGE).read()
    if MARK not in page:
        sys.exit(f"verdicts: {PAGE} has lost its mark, the line that begins with <!-- What follows")
    preface, rest = page[:page.index(MARK)], page[page.index(MARK):]
    text, cases, used, tables = generated(rest, word is not None)
    if word == "--write":
        open(PAGE, "w").write(preface + text)
    else:
        was, now = without_measured(rest), without_measured(text)
        for k in range(max(len(was), len(now))):
            one, two = (x[k] if k < len(x) else "(nothing)" for x in (was, now))
            if one != two:
                sys.exit(f"verdicts: {PAGE} is not what the cases and their results make of it: it says\n  {one[:300]}\nand should say\n  {two[:300]}\n"
                         "write it anew after a look: make validate, then tools/docs/verdicts.py --write")
    print(f"verdicts: {cases} cases, {tables} with their quantities, {used} of these compared with a run; the page is {'written' if word == '--write' else 'current'}")


if __name__ == "__main__":
    if sys.argv[1:] not in ([], ["--run"], ["--write"]):
        sys.exit("verdicts: say nothing, --run or --write")
    main(sys.argv[1] if len(sys.argv) > 1 else None)
