#!/usr/bin/env python3
"""Is the audit seen to fail? Each number written in validation/theory is made wrong by one part in 1e9, one at a time, in a copy, and the areas of the
audit that should see it are run. Prints how many were seen, and those that were not. What cannot be seen: bounds of a loop or a step, thresholds between two forms
that agree there, the word -1 for "no friction", a common velocity that drops out, the two ends of Simpson's rule.

Usage: perturb.py BUILD [FILE.c ...]    (after `make audit`; all files without motion: about 3 minutes of one core; motion: 20 s for each number)
"""
import glob, os, re, subprocess, sys

AREAS = {"resistance.c": "vectors", "contact.c": "vectors", "contact_laws.c": "vectors collisions", "drag.c": "vectors", "repulsion.c": "vectors", "langevin.c": "spheres",
         "free_sphere.c": "spheres", "driven_sphere.c": "spheres", "collision.c": "collisions impacts", "pair_motion.c": "motion", "encounters.c": "motion",
         "dilute.c": "crowds", "crowd.c": "crowds", "structural_stress.c": "crowds", "hard_spheres.c": "crowds"}


def numbers(text):
    """Places of decimal numbers outside comments; zeros are left alone."""
    bare = re.sub(r"/\*.*?\*/", lambda m: " " * len(m.group()), text, flags=re.S)
    found = [(m.start(), m.group()) for m in re.finditer(r"(?<![\w.])\d+\.\d*(?:e[+-]?\d+)?(?![\w.])", bare)]
    return [(at, word) for at, word in found if float(word) != 0.0]


def main(build, wanted):
    work = os.path.join(build, "perturbed")
    os.makedirs(work, exist_ok=True)
    seen, unseen = 0, []
    for path in sorted(glob.glob("validation/theory/*.c")):
        name = os.path.basename(path)
        if wanted and name not in wanted:
            continue
        text = open(path).read()
        objects = glob.glob(os.path.join(build, "obj/tools/audit/*.o")) + [o for o in glob.glob(os.path.join(build, "obj/validation/theory/*.o"))
                                                                           if os.path.basename(o) != name[:-2] + ".o"]
        for at, word in numbers(text):
            line = text.count("\n", 0, at) + 1
            wrong = os.path.join(work, name)
            open(wrong, "w").write(text[:at] + f"({word} * (1.0 + 1e-9))" + text[at + len(word):])
            program = os.path.join(work, "audit")
            subprocess.run(["cc", "-std=c11", "-D_XOPEN_SOURCE=700", "-O1", "-ffp-contract=off", "-Ivalidation/theory", wrong, *objects, "-ljansson", "-lgsl", "-lgslcblas",
                            "-lquadmath", "-lm", "-o", program], check=True)
            code = subprocess.run([program, *AREAS[name].split()], capture_output=True, text=True)
            where = f"{name}:{line} {word}: {text.splitlines()[line - 1].strip()[:100]}"
            if code.returncode == 1:
                seen += 1
            else:
                unseen.append(where)
                print(f"not seen  {where}", flush=True)
    print(f"perturb: {seen} of {seen + len(unseen)} numbers made wrong by 1e-9 seen")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
