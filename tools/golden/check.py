#!/usr/bin/env python3
"""make vectors: golden/vectors against what makes them, and against our solver.

1. golden/MANIFEST: every checksum. 2. Each file has the form of docs/vectors.schema.json, and its decimal and hexadecimal numbers are the
same. 3. The generator (build/vectors) makes the same bytes today. 4. `build/shear --evaluate` reproduces every vector: forces, torques and
stresses within the tolerance that the file states; resistances column by column; sampled covariances within six standard errors.

A failing vector is never mended by editing its file. Usage: check.py BUILD [COMMAND]; COMMAND is the program to hold to the vectors,
called as COMMAND CASE_DIR OUT_DIR (default: BUILD/shear --evaluate).
"""
import array, csv, filecmp, glob, hashlib, json, math, os, re, shlex, shutil, subprocess, sys

BOX = [41.3, 47.1, 43.9]
DRAWS = 4000            # of the sampled covariances: resolves 13 % of a diagonal element at six standard errors; layer 2 of the gate is finer


class Wrong(Exception):
    pass


# ---- the form ----

def check_form(value, schema, where, root):
    """The part of JSON Schema that docs/vectors.schema.json uses."""
    if "$ref" in schema:
        schema = root["definitions"][schema["$ref"].split("/")[-1]]
    kinds = {"object": dict, "array": list, "string": str, "number": (int, float), "integer": int}
    if "anyOf" in schema:
        for choice in schema["anyOf"]:
            try:
                return check_form(value, choice, where, root)
            except Wrong:
                pass
        raise Wrong(f"{where}: fits none of the forms allowed")
    if "type" in schema and (not isinstance(value, kinds[schema["type"]]) or isinstance(value, bool)):
        raise Wrong(f"{where}: is no {schema['type']}")
    if "enum" in schema and value not in schema["enum"]:
        raise Wrong(f"{where}: {value!r} is none of {schema['enum']}")
    if "pattern" in schema and not re.search(schema["pattern"], value):
        raise Wrong(f"{where}: {value!r} does not match {schema['pattern']}")
    if isinstance(value, list):
        if len(value) < schema.get("minItems", 0):
            raise Wrong(f"{where}: is too short")
        for k, item in enumerate(value):
            check_form(item, schema.get("items", {}), f"{where}[{k}]", root)
    if isinstance(value, dict):
        for key in schema.get("required", []):
            if key not in value:
                raise Wrong(f"{where}: lacks \"{key}\"")
        for key, item in value.items():
            inner = schema.get("properties", {}).get(key, schema.get("additionalProperties", {}))
            if inner is False:
                raise Wrong(f"{where}: has no key \"{key}\"")
            check_form(item, inner, f"{where}.{key}", root)


def check_twins(decimal, hexadecimal, where):
    """The same numbers twice; words stand in the decimal object only."""
    wanted = {k: v for k, v in decimal.items() if not isinstance(v, str)}
    if list(wanted) != list(hexadecimal):
        raise Wrong(f"{where}: decimal and hexadecimal names differ")
    for key, value in wanted.items():
        hexes = hexadecimal[key] if isinstance(value, list) else [hexadecimal[key]]
        values = value if isinstance(value, list) else [value]
        if [float(v) for v in values] != [float.fromhex(h) for h in hexes]:
            raise Wrong(f"{where}.{key}: decimal and hexadecimal numbers differ")


# ---- asking the program ----

def ask(command, folder, scene, rows, contacts=(), protocol="forces", draws=None):
    """Particles: (state, id, species, x, u, w). Returns the output folder."""
    case, out = os.path.join(folder, "case"), os.path.join(folder, "out")
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(case)
    os.makedirs(out)
    about = {"suite": "1.0", "name": "golden-vectors", "about": "golden vectors", "protocol": protocol, "scene": "scene.json", "states": "states.csv",
             "needs": list(scene["forces"])}
    if draws:
        about["draws"] = draws
    with open(os.path.join(case, "states.csv"), "w") as f:
        f.write("state,id,species,x,y,z,ux,uy,uz,wx,wy,wz\n")
        for state, number, kind, *vectors in rows:
            f.write(f"{state},{number},{kind}," + ",".join(f"{c:.17g}" for v in vectors for c in v) + "\n")
    if contacts:
        about["contacts"] = "contacts.csv"
        with open(os.path.join(case, "contacts.csv"), "w") as f:
            f.write("state,i,j,sx,sy,sz\n")
            for state, s in contacts:
                f.write(f"{state},1,2," + ",".join(f"{c:.17g}" for c in s) + "\n")
    json.dump(about, open(os.path.join(case, "case.json"), "w"))
    json.dump(scene, open(os.path.join(case, "scene.json"), "w"))
    done = subprocess.run(shlex.split(command) + [case, out], capture_output=True, text=True)
    if done.returncode != 0:
        raise Wrong(f"{command} ended with {done.returncode}: {(done.stderr or done.stdout).strip()[:300]}")
    return out


def forces_of(out, force):
    """[state][id] -> fx fy fz tx ty tz."""
    table = {}
    with open(os.path.join(out, "forces.csv")) as f:
        for row in csv.DictReader(line for line in f if not line.startswith("#")):
            if row["force"] == force:
                table[int(row["state"]), int(row["id"])] = [float(row[c]) for c in ("fx", "fy", "fz", "tx", "ty", "tz")]
    return table


def stress_of(out, origins, volume):
    """[state] -> nine components, times the volume."""
    table = {}
    with open(os.path.join(out, "stress.csv")) as f:
        for row in csv.DictReader(line for line in f if not line.startswith("#")):
            table[int(row["state"])] = [volume * sum(float(row[f"{o}_{a}{b}"]) for o in origins) for a in "xyz" for b in "xyz"]
    return table


def scene_of(force, model, species, shear=()):
    """The scene of a group; the names of a model's numbers are those of docs/formats.md."""
    inner = {k: v for k, v in model.items() if k not in ("viscosity", "kT", "dt", "second", "rough", "force" if force == "applied" else "", "torque")}
    scene = {"about": "golden vectors", "dimensions": 3, "seed": 5, "fluid": {"viscosity": model.get("viscosity", 0.7), "kT": model.get("kT", 0.0)},
             "box": {"lengths": BOX, "periodic": [True, True, True]}, "shear": list(shear),
             "species": [{"name": f"s{k}", "radius": a, "density": d, **({"motion": "held"} if held else {})} for k, (a, d, held) in enumerate(species)],
             "forces": {force: inner}, "dynamics": {"verlet": {"dt": model.get("dt", 0.001)}}}
    if "rough" in model:
        inner["rough"] = [model["rough"] == "both" or not second for (_, _, second) in ROLES]
    if force == "drag":
        scene["forces"]["drag"] = {"torque": model["torque"] == "on"}
    if inner.get("law") == "plain":
        del inner["law"]
    return scene


ROLES = []              # species of the group being asked: (radius, density, second sphere of a one-sided law)


def compare(worst, vector, measured, key, scale):
    """Largest |measured - expected|/scale of a list, into `worst`: (error, what)."""
    expected = vector["expected"][key]
    for a, b in zip(measured, expected if isinstance(expected, list) else [expected]):
        error = abs(a - b) / scale if a != b else 0.0
        if not error <= worst[0]:
            worst[0], worst[1] = error, f"{vector['id']} ({vector['comment']}): {key} {a:.17g}, expected {b:.17g}"


def pairs_of(group, held):
    """Species list and rows for the pairs of a group: held or smooth second spheres are species of their own."""
    species, rows, contacts = [], [], []
    del ROLES[:]
    for state, v in enumerate(group["vectors"]):
        i = v["input"]
        for side in (0, 1):
            density = i.get("density", [1.0, 1.0])[side]
            kind = (i["radius"][side], density, held and side == 1)
            role = (i["radius"][side], density, side == 1 and ("rough" in group["model"] or held))
            if (kind, role) not in [(s, r) for s, r in zip(species, ROLES)]:
                species.append(kind)
                ROLES.append(role)
            number = [(s, r) for s, r in zip(species, ROLES)].index((kind, role)) + 1
            at = slice(3 * side, 3 * side + 3)
            rows.append((state, side + 1, number, i["position"][at], i.get("velocity", [0] * 6)[at], i.get("spin", [0] * 6)[at]))
        if "history" in i:
            contacts.append((state, i["history"]))
    return species, rows, contacts


def check_pairs(command, folder, group, tolerance, worst):
    force = {"contact": "contact", "repulsion": "repulsion", "lubrication": "lubrication"}[group["kind"]]
    origins = {"contact": ["contact_normal", "contact_tangential"]}.get(force, [force])
    species, rows, contacts = pairs_of(group, group["model"].get("second") == "held")
    if group["model"].get("friction") == 0:
        contacts, origins = [], ["contact_normal"]
    out = ask(command, folder, scene_of(force, group["model"], species), rows, contacts)
    forces, stress = forces_of(out, force), stress_of(out, origins, math.prod(BOX))
    for state, v in enumerate(group["vectors"]):
        both = [forces[state, 1], forces[state, 2]]
        compare(worst, v, both[0][:3] + both[1][:3], "force", v["scale"]["force"])
        compare(worst, v, both[0][3:] + both[1][3:], "torque", v["scale"]["torque"])
        compare(worst, v, stress[state], "stress", v["scale"]["stress"])


def check_ones(command, folder, group, tolerance, worst):
    """One sphere at a time: drag in its flow, forces from outside."""
    for v in group["vectors"]:
        i, force = v["input"], group["kind"]
        gradient = i.get("gradient", [0] * 9)
        shear = [{"flow": "xyz"[k // 3], "gradient": "xyz"[k % 3], "rate": gradient[k]} for k in range(9) if gradient[k]]
        scene = scene_of(force, group["model"], [(i["radius"], 1.0, False)], shear)
        if force == "applied":
            scene["forces"]["applied"] = {"s0": {"force": group["model"]["force"], "torque": group["model"]["torque"]}}
        out = ask(command, folder, scene, [(0, 1, 1, i["position"], i["velocity"], i["spin"])])
        load = forces_of(out, force)[0, 1]
        compare(worst, v, load[:3], "force", v["scale"]["force"])
        compare(worst, v, load[3:], "torque", v["scale"]["torque"])
        if force == "drag":
            compare(worst, v, stress_of(out, ["drag"], math.prod(BOX))[0], "stress", v["scale"]["stress"])


def columns_of(command, folder, scene, geometries):
    """R of each pair (position, species numbers) from the forces of its twelve unit motions."""
    rows = []
    for k, (position, numbers) in enumerate(geometries):
        for c in range(13):             # the thirteenth: at rest
            motion = [float(c == m) for m in range(12)]
            for side in (0, 1):
                rows.append((13 * k + c, side + 1, numbers[side], position[3 * side:3 * side + 3], motion[3 * side:3 * side + 3],
                             motion[6 + 3 * side:9 + 3 * side]))
    forces, answer = forces_of(ask(command, folder, scene, rows), "lubrication"), []
    for k in range(len(geometries)):
        load = [forces[13 * k + c, 1][:3] + forces[13 * k + c, 2][:3] + forces[13 * k + c, 1][3:] + forces[13 * k + c, 2][3:] for c in range(13)]
        answer.append([load[12][r] - load[c][r] for r in range(12) for c in range(12)])
    return answer


def check_resistance(command, folder, group, tolerance, worst):
    scalars = group["kind"] == "lubrication-scalars"
    geometries, radii = [], []
    for v in group["vectors"]:
        for a in v["input"]["radius"]:
            if a not in radii:
                radii.append(a)
    for v in group["vectors"]:
        position = [1.0, 20.0, 20.0, 1.0 + v["input"]["distance"], 20.0, 20.0] if scalars else v["input"]["position"]
        geometries.append((position, [radii.index(a) + 1 for a in v["input"]["radius"]]))
    scene = scene_of("lubrication", {**group["model"], "kT": 0.0}, [(a, 1.0, False) for a in radii])
    for v, R in zip(group["vectors"], columns_of(command, folder, scene, geometries)):
        at = lambda row, column: R[12 * row + column]
        if scalars:
            # n = x. Column 1 is U_1 along y, so dU = -y and dU x n = z: torques about z are B; spins about z are columns 8 and 11.
            seen = {"X_A": at(0, 0), "Y_A": at(1, 1), "B_1": -at(8, 1), "B_2": -at(11, 1), "C_11": at(8, 8), "C_12": at(8, 11), "C_22": at(11, 11)}
            for key, value in seen.items():
                compare(worst, v, [value], key, abs(v["expected"][key]) or 1.0)
        elif "resistance" in v["expected"]:
            for k in range(144):
                scale = v["scale"]["torque"] if k // 12 >= 6 or k % 12 >= 6 else v["scale"]["force"]
                compare(worst, {**v, "expected": {"element": [v["expected"]["resistance"][k]]}}, [R[k]], "element", scale)
        else:
            factor = 2 * group["model"]["kT"] / group["model"]["dt"]
            compare(worst, v, [factor * x for x in R], "covariance", v["scale"]["covariance"])


def draws_of(path):
    """Rows of an NPY file of doubles, C order."""
    data = open(path, "rb").read()
    start = 10 + int.from_bytes(data[8:10], "little")
    numbers = array.array("d")
    numbers.frombytes(data[start:])
    return numbers


def check_sampled(command, folder, group, tolerance, worst):
    """Covariance of draws: all bodies of the group in one crowd, far from each other, so one run serves all."""
    pair = group["kind"] == "noise-pair"
    radii, rows, x = [], [], 12.0
    for v in group["vectors"]:
        for a in v["input"]["radius"] if pair else [v["input"]["radius"]]:
            if a not in radii:
                radii.append(a)
    for v in group["vectors"]:
        i = v["input"]
        a, place = (i["radius"], i["position"]) if pair else ([i["radius"]], [0.0, 0.0, 0.0])
        for side in range(len(a)):
            rows.append((0, len(rows) + 1, radii.index(a[side]) + 1, [x + place[3 * side] - place[0], 25 + place[3 * side + 1] - place[1], 25 + place[3 * side + 2] - place[2]],
                         [0] * 3, [0] * 3))
        x += 45.0
    scene = scene_of("lubrication" if pair else "drag", {**group["model"], "torque": "on"}, [(a, 1.0, False) for a in radii])
    scene["box"]["lengths"] = [x + 12.0, 50.0, 50.0]
    scene["forces"]["lubrication_noise" if pair else "drag_noise"] = {"distribution": "gaussian"}
    out = ask(command, folder, scene, rows, protocol="noise", draws=DRAWS)
    numbers, width, first = draws_of(os.path.join(out, "noise_lubrication_noise.npy" if pair else "noise_drag_noise.npy")), 6 * len(rows), 0
    sampled = [0.0, "nothing"]
    for v in group["vectors"]:
        n = 12 if pair else 6
        order = [0, 1, 2, 6, 7, 8, 3, 4, 5, 9, 10, 11] if pair else range(6)        # F_1 F_2 T_1 T_2
        series = [[numbers[width * d + first + c] for d in range(DRAWS)] for c in order]
        expected = v["expected"]["covariance"]
        for r in range(n):
            for c in range(r, n):
                mean = sum(map(lambda p, q: p * q, series[r], series[c])) / DRAWS
                error = math.sqrt(max((expected[n * r + r] * expected[n * c + c] + expected[n * r + c] ** 2) / DRAWS, 1e-30 * v["scale"]["covariance"] ** 2))
                z = abs(mean - expected[n * r + c]) / error
                if not z <= sampled[0]:
                    sampled = [z, f"{v['id']}: element {r},{c} {mean:.6g}, expected {expected[n * r + c]:.6g}"]
        first += n
    if not sampled[0] <= 6.0:
        raise Wrong(f"{sampled[1]}: {sampled[0]:.1f} standard errors off, six are allowed")
    return sampled[0]


KINDS = {"contact": [check_pairs], "repulsion": [check_pairs], "lubrication": [check_pairs], "drag": [check_ones], "applied": [check_ones],
         "lubrication-scalars": [check_resistance], "lubrication-resistance": [check_resistance],
         "noise-pair": [check_resistance, check_sampled], "noise-one-body": [check_sampled]}


def check_manifest(folder):
    listed = {}
    for line in open(os.path.join(folder, "MANIFEST")):
        if line.strip() and not line.startswith("#"):
            checksum, name = line.split()
            listed[name] = checksum
    for name, checksum in listed.items():
        if hashlib.sha256(open(os.path.join(folder, name), "rb").read()).hexdigest() != checksum:
            raise Wrong(f"golden/{name} is not the file whose checksum golden/MANIFEST has")
    for path in sorted(glob.glob(os.path.join(folder, "vectors", "*.json"))):
        if os.path.relpath(path, folder) not in listed:
            raise Wrong(f"golden/{os.path.relpath(path, folder)} is not in golden/MANIFEST")
    return len(listed)


def main(build, command):
    root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    golden, now = os.path.join(root, "golden"), os.path.join(build, "golden-now")
    files = check_manifest(golden)
    print(f"manifest: {files} files, checksums agree")
    shutil.rmtree(now, ignore_errors=True)
    os.makedirs(now)
    subprocess.run([os.path.join(build, "vectors"), now], check=True, stdout=subprocess.DEVNULL)
    if sorted(os.listdir(now)) != sorted(os.listdir(os.path.join(golden, "vectors"))):
        raise Wrong("the generator makes other files than golden/vectors holds")
    schema, total, largest = json.load(open(os.path.join(root, "docs", "vectors.schema.json"))), 0, 0.0
    for name in sorted(os.listdir(now)):
        path = os.path.join(golden, "vectors", name)
        if not filecmp.cmp(path, os.path.join(now, name), shallow=False):
            raise Wrong(f"golden/vectors/{name} is not what the generator makes now; see what differs: diff {path} {os.path.join(now, name)}")
        book, worst, extra = json.load(open(path)), [0.0, "nothing"], ""
        check_form(book, schema, name, schema)
        for g, group in enumerate(book["groups"]):
            check_twins(group["model"], group["model_hex"], f"{name}: groups[{g}].model")
            for v in group["vectors"]:
                check_twins(v["input"], v["input_hex"], f"{v['id']}: input")
                check_twins(v["expected"], v["expected_hex"], f"{v['id']}: expected")
                unknown = [f for f in v["flags"] if f not in book["flags"]]
                if unknown:
                    raise Wrong(f"{v['id']}: flag {unknown[0]} is not explained")
            for check in KINDS[group["kind"]]:
                z = check(command, os.path.join(build, "golden-cases"), group, book["agreement"]["tolerance"], worst)
                extra = f", sampled covariances within {z:.1f} standard errors" if z is not None else extra
        if not worst[0] <= book["agreement"]["tolerance"]:
            raise Wrong(f"{worst[1]}: off by {worst[0]:.3g} of the terms, {book['agreement']['tolerance']:g} is allowed")
        total += book["count"]
        largest = max(largest, worst[0])
        print(f"{name:32} {book['count']:4} vectors, same bytes; program off by {worst[0]:.1e} at most, {book['agreement']['tolerance']:g} allowed{extra}")
    print(f"vectors: {total} of {total} reproduced, worst {largest:.1e} of the size of the terms")


if __name__ == "__main__":
    try:
        main(sys.argv[1] if len(sys.argv) > 1 else "build", sys.argv[2] if len(sys.argv) > 2 else os.path.join(sys.argv[1] if len(sys.argv) > 1 else "build", "shear") + " --evaluate")
    except Wrong as wrong:
        sys.exit(f"vectors: {wrong}")
