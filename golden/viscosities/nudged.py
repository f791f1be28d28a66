#!/usr/bin/env python3
"""`shear` from a start whose first coordinate is moved by a little: is the spread between two codes more than that of one code against itself?

    GATE_REFERENCE="build/shear --evaluate" build/gate run --candidate "python3 golden/viscosities/nudged.py 1e-6" --tier full --case viscosities-repulsion

An adapter (docs/adapter.md): nudged.py DISTANCE CASE_DIR OUT_DIR.
"""
import os, shutil, subprocess, sys, tempfile

distance, case, out = float(sys.argv[1]), sys.argv[2], sys.argv[3]
with tempfile.TemporaryDirectory() as folder:
    mine = os.path.join(folder, "case")
    shutil.copytree(case, mine)
    path = os.path.join(mine, "states.csv")
    lines = open(path).read().split("\n")
    x = lines[0].split(",").index("x")
    first = lines[1].split(",")
    first[x] = repr(float(first[x]) + distance)
    lines[1] = ",".join(first)
    open(path, "w").write("\n".join(lines))
    sys.exit(subprocess.run(["build/shear", "--evaluate", mine, out]).returncode)
