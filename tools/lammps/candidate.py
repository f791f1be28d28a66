#!/usr/bin/env python3
"""Stock LAMMPS as a candidate of the gate, and `shear --export lammps`: a worked example of an adapter, sharing nothing with our solver.

    lammps-candidate [--own poly|equal|theory|reference] [--newton on|off] CASE_DIR OUT_DIR
                                                answer a case (docs/formats.md) with `lmp`, or the program that LMP names
    lammps-candidate --deck CASE_DIR OUT_DIR    write deck and data, run nothing

What stock styles have no exact equivalent of ends with exit code 77 and the reason. --own lets LAMMPS's own lubrication, noise and uniform
random numbers stand for those of the scene: lubricate/poly and brownian/poly, or lubricate and brownian (equal spheres). --own theory and
--own reference are the gate's second code: lammps_reference.py. `newton` is off unless asked, on with --own equal.
"""
import os, sys
from lammps_stock import Stock


def main(words):
    option = {"--own": None, "--newton": None, "--deck": False}
    while words and words[0] in option:
        name = words.pop(0)
        option[name] = name == "--deck" or (words.pop(0) if words else "nothing")
    own, newton = option["--own"], option["--newton"]
    if len(words) != 2 or own not in (None, "poly", "equal", "theory", "reference") or newton not in (None, "on", "off"):
        print(__doc__, file=sys.stderr)
        return 2
    folder, out = words
    if own in ("theory", "reference"):
        import lammps_reference
        t = lammps_reference.Theory(folder) if own == "theory" else lammps_reference.reference(folder)(folder)
    else:
        t = Stock(folder, own, newton)
    os.makedirs(out, exist_ok=True)
    for state in t.states:
        t.write_data(state, out)
    t.write_deck(out)
    if not option["--deck"]:
        t.run_lammps(out)
        {"forces": t.answer_forces, "noise": t.answer_noise, "run": t.answer_run}[t.protocol](out)
    return 0


sys.exit(main(sys.argv[1:]))
