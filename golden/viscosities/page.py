#!/usr/bin/env python3
"""Puts the rows of *-table.csv and retraced.csv between the marks of docs/viscosities.md. `make golden` and `make retrace` call it: page.py TABLE_FOLDER PAGE."""
import csv, glob, os, re, sys

folder, page = sys.argv[1:]
COLUMNS = "viscosity contact lubrication pressure N1 N2 contacts temperature spin_temperature".split()


def number(value, error):
    """4.176(35): the error in units of the last digit."""
    if error == 0 or error != error:
        return f"{value:.4g}"
    digits = 0
    while error * 10 ** digits < 9.95 and digits < 6:
        digits += 1
    return f"{value:.{digits}f}({error * 10 ** digits:.0f})"


def rows(path):
    points = {}
    for row in csv.DictReader(line for line in open(path) if line[0] != "#"):
        points.setdefault(row["point"], {})[row["quantity"]] = {k: float(v) for k, v in row.items() if k not in ("point", "quantity")}
    return points


lines = ["| row | code | eta_r | contact | lubrication | pressure | N1 | N2 | contacts | T | T of spin | core-seconds |",
         "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
order = ["contact-named", "contact", "brownian-named", "brownian-50", "brownian-45", "repulsion"]
for name in order:
    path = os.path.join(folder, f"viscosities-{name}-table.csv")
    for point, q in rows(path).items() if os.path.exists(path) else ():
        v = q["viscosity"]
        for code, cost in (("candidate", "core_seconds"), ("reference", "reference_core_seconds")):
            cells = [number(q[c][code], q[c][code + "_error"]) if q[c][code] else "" for c in COLUMNS]
            lines.append(f"| {point if code == 'candidate' else ''} | {'shear' if code == 'candidate' else 'LAMMPS'} | " + " | ".join(cells) + f" | {v[cost]:.0f} |")
        worst = max(COLUMNS, key=lambda c: (abs(q[c]["difference"]) + 4 * q[c]["difference_error"]) / q[c]["margin"] if q[c]["margin"] else 0)
        w = q[worst]
        lines.append(f"| | difference | {v['difference']:.1g} +- {v['difference_error']:.1g} of {v['margin']:.2g} | worst of its margin: {worst.replace('_', ' ')} "
                     f"{w['difference']:.1g} +- {w['difference_error']:.1g} of {w['margin']:.2g} | | | | | | | | |")
text = open(page).read()
retraced = ["| row | pieces, up to step | places within | stresses within | |", "| --- | --- | --- | --- | --- |"]
with open(os.path.join(folder, "retraced.csv")) as f:
    retraced += [f"| {r['row']} | {r['pieces']}, {r['steps']} | {r['places']} | {r['stresses']} | {r['verdict']} |" for r in csv.DictReader(f)]
for mark, new in ("table", lines), ("retraced", retraced):
    text, found = re.subn(rf"(<!-- {mark} -->\n).*?(<!-- end of {mark} -->)", lambda m: m[1] + "\n".join(new) + "\n" + m[2], text, flags=re.S)
    if not found:
        sys.exit(f"{page}: no marks for the {mark}")
open(page, "w").write(text)
