#!/usr/bin/env python3
"""Stock LAMMPS as a candidate of the gate, and `shear --export lammps`: a worked example of an adapter, sharing nothing with our solver.

    lammps-candidate [--own poly|equal|theory|reference] [--newton on|off] CASE_DIR OUT_DIR
                                                answer a case (docs/formats.md) with `lmp`, or the program that LMP names
    lammps-candidate --deck CASE_DIR OUT_DIR    write deck and data, run nothing

What stock styles have no exact equivalent of ends with exit code 77 and the reason. --own lets LAMMPS's own lubrication, noise and uniform
random numbers stand for those of the scene: lubricate/poly and brownian/poly, or lubricate and brownian (equal spheres): lammps_own.py.
--own theory and --own reference are the gate's second code: lammps_reference.py. --newton is for --own poly and equal: off unless asked, on with equal.
"""
import argparse, os


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--own", choices=("poly", "equal", "theory", "reference"))
    parser.add_argument("--newton", choices=("on", "off"))
    parser.add_argument("--deck", action="store_true")
    parser.add_argument("case")
    parser.add_argument("out")
    return parser.parse_args()


def adapter(o):
    """Stock LAMMPS; what stands in for it is imported only where asked for."""
    if o.own in ("poly", "equal"):
        from lammps_own import Own
        return Own(o.case, o.own, o.newton)
    if o.own:
        import lammps_reference
        return lammps_reference.Theory(o.case) if o.own == "theory" else lammps_reference.reference(o.case)(o.case)
    from lammps_stock import Stock
    return Stock(o.case)


o = options()
t = adapter(o)
os.makedirs(o.out, exist_ok=True)
for state in t.states:
    t.write_data(state, o.out)
t.write_deck(o.out)
if not o.deck:
    t.run_lammps(o.out)
    {"forces": t.answer_forces, "noise": t.answer_noise, "run": t.answer_run}[t.protocol](o.out)
