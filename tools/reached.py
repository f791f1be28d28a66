#!/usr/bin/env python3
"""Which cases of the fast tier execute the lines that an entry of a list of faults changes.

    tools/reached.py LEVEL LIST REFERENCE OUT

A case that does not execute a line gives the same answers whatever that line says, so `make faults` at levels B and C, where many faults pass, asks
only the others. REFERENCE: JSON whose keys are the cases that the right solver passes at this level. OUT: JSON, name of the entry -> its cases.
Where the compiler has no code for the lines of an entry (declarations, tables, macros), or where it touches the labels of a switch, all cases count.
"""
import collections, concurrent.futures, glob, gzip, json, os, re, shutil, subprocess, sys

level, list_path, reference, out = sys.argv[1:]
os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
B = "build/reached"
cases = sorted(json.load(open(reference)))
subprocess.run(["make", "--no-print-directory", "-s", "-j2", "B=" + B, "CFLAGS=-O0 -g0 --coverage -w", B + "/shear"], check=True, stdout=subprocess.DEVNULL)


def executed(case):
    """{file: {line: count}} of the solver in one case."""
    prefix = os.path.abspath(f"{B}/of/{level}-{case}")
    shutil.rmtree(prefix, ignore_errors=True)
    counts = prefix + os.path.abspath(B + "/obj")
    os.makedirs(counts)
    options = [] if level == "A" else ["--level", level]
    run = subprocess.run(["build/gate", "run", "--candidate", B + "/shear --evaluate", *options, "--case", case, "--patience", "50", "--work", prefix + "/cases",
                          "--report", prefix + "/report"], env=dict(os.environ, GCOV_PREFIX=prefix), stdout=subprocess.PIPE, text=True)
    if run.returncode:
        sys.exit(f"reached: {case} is not green\n{run.stdout}")
    lines = collections.defaultdict(collections.Counter)
    for data in glob.glob(counts + "/**/*.gcda", recursive=True):
        shutil.copy(f"{B}/obj/{os.path.relpath(data, counts)}"[:-4] + "gcno", data[:-4] + "gcno")
        said = subprocess.run(["gcov", "--json-format", "--stdout", data], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
        for file in json.loads(said)["files"]:
            for line in file["lines"]:
                lines[os.path.relpath(file["file"])][line["line_number"]] += line["count"]
    shutil.rmtree(prefix)
    return lines


with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    reached = dict(zip(cases, pool.map(executed, cases)))


def reach(entry):
    text = open(entry["file"]).read()
    first = text[: text.index(entry["find"])].count("\n") + 1
    span = range(first, first + entry["find"].count("\n") + 1)
    known = any(line in reached[case][entry["file"]] for case in cases for line in span)
    if not known or re.search(r"\b(case|default)\b", entry["find"] + entry["replace"]):
        return cases
    return [case for case in cases if any(reached[case][entry["file"]][line] for line in span)]


json.dump({e["name"]: reach(e) for e in json.load(open(list_path))["faults"]}, open(out + ".new", "w"), indent=0)
os.replace(out + ".new", out)
