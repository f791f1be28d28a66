#!/bin/sh
# Puts each fault of validation/faults/faults.json into a copy of the solver, builds it, and lets the fast tier judge it until one case fails;
# cases that caught most per second come first. Fails if a fault passes, or an equivalent change does not.
#
#     make faults [ONLY=word] [JOBS=2] [LEVEL=A] [LIST=validation/faults/faults.json] [TABLE=docs/measured/faults.csv]
#
# Seconds are those of one core, of the gate and the candidate; LAMMPS, the reference, answers each question once for all.
# At levels B and C the cases that caught the fault at the levels above are asked first, then in their order all that execute what it changes.
# The table of all entries is docs/measured/faults.csv. Its `key`s are two hashes: of the sources and the entry, and of the case that caught the
# fault (of all cases, if none did). What was judged with the same key is not judged again, also in another clone; other cells stay as they were.
# What passed all cases of another time is asked those alone that were added or changed since (faults-suites.csv says of what each such time consisted);
# if one of them is red, all are asked in their order, so that the seconds are those of a user.
set -eu
cd "$(dirname "$0")/.."
list=${LIST:-validation/faults/faults.json}
table=${TABLE:-docs/measured/faults.csv}
level=${LEVEL:-A}
jobs=${JOBS:-$(nproc)}
kept=build/faults/$level
suites=${table%.csv}-suites.csv

hash_of() { sha1sum | cut -c1-16; }
# The sources of a level: what asks by steps (validation/level_b*) speaks at level B alone.
sources() {
    [ "$1" = B ] && other=none || other='level_b*'
    { grep -E '^(CC|CFLAGS|BASE) ' Makefile; find solver validation -name '*.[ch]' ! -name "$other" | LC_ALL=C sort | xargs cat; } | hash_of
}
# Of a case, or of all where none is named; as they were when this began.
hash_of_case() {
    known=build/faults/hashes/${1:-all}
    [ -s "$known" ] || find validation/cases -path "*/${1:-*}/case.json" | LC_ALL=C sort | xargs cat /dev/null | hash_of >"$known"
    cat "$known"
}
# The cases as they are now: a line each, name and hash.
suite() { sha1sum validation/cases/*/*/case.json | awk '{ split($2, path, "/"); print path[4] "," substr($1, 1, 16) }'; }
# The cases that an entry, of which file $1 is known, passed as they are now.
passed_before() {
    [ -s "$1" ] && [ -s "$suites" ] && [ -z "$(jq -r .case "$1")" ] || return 0
    awk -F, -v of="$(jq -r .of "$1")" 'NR == FNR { now[$1] = $2; next } $1 == of && now[$2] == $3 { print $2 }' build/faults/hashes/suite "$suites"
}
# The cases that caught entry $1 at the levels above this one, as the table says.
known_from_above() {
    jq -r --argjson entry "$1" --arg level "$level" '.[$entry.name] // {} | { A: [], B: [.A], C: [.A, .B] }[$level] | unique[] | select(. and test("^[-a-z0-9.]+$"))' \
        build/faults/before.json
}
# A table of results, by name of the entry.
rows() {
    [ ! -f "$1" ] && echo '{}' || python3 -c 'import csv, json, sys; json.dump({r["fault"]: r for r in csv.DictReader(open(sys.argv[1]))}, sys.stdout)' "$1"
}
# Line K of the list, and the hash under which it is kept.
entry() { jq -c ".faults[$1]" $list; }
key() { printf '%s %s' "$SOURCES" "$1" | hash_of; }
# Is what file $1 says of a fault said of the cases as they are now?
current() { [ -s "$1" ] && [ "$(jq -r .of "$1")" = "$(hash_of_case "$(jq -r .case "$1")")" ]; }
# Batches of cases, those that caught most per second first, as the committed table of this level says; the first takes about a second, the next more. In
# a batch the gate asks cheap layers first.
order() {
    rows docs/measured/faults.csv >"$kept/known.json"
    jq --arg level "$level" --slurpfile known "$kept/known.json" '
        ($known[0] | map(.[$level]) | group_by(.) | map({ (.[0]): length }) | add // {}) as $count
        | to_entries | map({ key, seconds: ([.value, 0.05] | max) }) | sort_by(-(($count[.key] // 0) + 1) / .seconds, .key)
        | reduce .[] as $case ({ sum: 0, batch: [[], [], [], [], [], []] };
            .sum += $case.seconds | .batch[.sum as $s | [1, 3, 8, 20, 60] | map(select($s >= .)) | length] += [$case.key])
        | .batch' "$kept/reference.json" >"$kept/batches.json"
}
# The batches, a line each, cases separated by commas, without those in $2; at levels B and C those that execute what the entry $1 changes.
batches() {
    jq -r --arg entry "$1" --arg without "$2" --slurpfile reached "$kept/reached.json" \
        '$reached[0][$entry] as $those | .[] | map(select(($those == null or IN($those[])) and (IN($without | split("\n")[]) | not))) | select(length > 0) | join(",")' \
        "$kept/batches.json"
}

# run PROGRAM WORK [options of the gate]: exit code of the gate; what it prints is in WORK/gate.txt
run() {
    program=$1 work=$2
    shift 2
    [ "$level" = A ] || set -- --level "$level" "$@"
    code=0
    build/gate run --candidate "$program --evaluate" --work "$work/cases" --report "$work/report" "$@" >"$work/gate.txt" 2>&1 || code=$?
    case $code in 0 | 1 | 3 | 77) ;; *) echo "faults: the gate itself ended with $code" >&2; cat "$work/gate.txt" >&2; exit 255 ;; esac
}

# The right solver must pass; how long its cases take is one half of the order in which they are asked.
reference() {
    mkdir -p "$kept"
    now="$SOURCES $(hash_of_case)"
    [ "$(cat "$kept/reference" 2>/dev/null)" = "$now" ] && return
    echo "faults: the right solver first"
    run build/shear "$kept" --jobs "$(nproc)"
    [ $code = 0 ] || { echo "faults: the right solver is red"; cat "$kept/gate.txt"; exit 1; }
    awk '/ pass .*[0-9]$/ { print $2, $NF }' "$kept/gate.txt" | jq -Rn '[inputs / " " | { (.[0]): (.[1] | tonumber) }] | add' >"$kept/reference.json"
    rm -rf "$kept/cases" "$kept/report"
    echo "$now" >"$kept/reference"
}
# Which cases can see an entry at all (tools/reached.py): those that run the lines it changes. At level A every case is asked, so that the seconds are those of a user.
reach() {
    [ "$level" != A ] || { echo '{}' >"$kept/reached.json"; return 0; }
    now="$SOURCES $(hash_of_case) $(hash_of <$list)"
    [ "$(cat "$kept/reached" 2>/dev/null)" != "$now" ] || return 0
    echo "faults: which cases execute what"
    tools/reached.py "$level" "$list" "$kept/reference.json" "$kept/reached.json"
    echo "$now" >"$kept/reached"
}

# ask WORK BATCH...: cases until one is red. Sets where, layer, said, and the seconds of one core.
ask() {
    work=$1 where="" layer="" said=""
    shift
    times >"$work/before"
    for cases in "$@"; do
        run "$work/build/shear" "$work" --case "$cases" --stop-after 1
        case $code in 0 | 77) continue ;; esac
        layer=$(awk '/ FAIL | inconclusive / { print $1; exit }' "$work/gate.txt")
        where=$(awk '/ FAIL | inconclusive / { print $2; exit }' "$work/gate.txt")
        said=$(jq -r '[.results[] | select(.verdict == "FAIL" or .verdict == "inconclusive")] | sort_by(.verdict != "FAIL", .judgement) | .[0].sentence' \
            "$work/cases/$where/results.json" 2>/dev/null || echo "the gate's own check ended")
        break
    done
    times >"$work/after"
    seconds=$(awk 'FNR == 2 { split($1, u, /[ms]/); split($2, s, /[ms]/); t = 60 * (u[1] + s[1]) + u[2] + s[2]; if (n++) printf "%.2f", t - first; else first = t }' \
        "$work/before" "$work/after")
}

# One line of JSON about entry K. The verdict is that of the first case that is red.
judge() {
    entry=$(entry "$1")
    key=$(key "$entry")
    ! current "$kept/$key.json" || return 0
    work=build/faults/$level-$1
    rm -rf "$work" && mkdir -p "$work/build/obj" && cp -a solver Makefile "$work"
    cp -a build/obj/solver "$work/build/obj" && cp -a build/commit "$work/build"     # with their times: only what the fault touches is compiled anew
    FIND=$(printf %s "$entry" | jq -r '.find | @base64') REPLACE=$(printf %s "$entry" | jq -r '.replace | @base64') \
        perl -MMIME::Base64 -0777 -i -pe 'BEGIN { $f = decode_base64($ENV{FIND}); $r = decode_base64($ENV{REPLACE}) }
            $n = () = /\Q$f\E/g; die "found $n times, not once\n" unless $n == 1; s/\Q$f\E/$r/' "$work/$(printf %s "$entry" | jq -r .file)"
    make --no-print-directory -s -C "$work" B=build CFLAGS="-O2 -w" build/shear 2>"$work/make.txt" ||
        { echo "faults: does not build: $entry" >&2; cat "$work/make.txt" >&2; exit 255; }
    name=$(printf %s "$entry" | jq -r .name)
    passed=$(passed_before "$kept/$key.json") where=not_asked
    if [ -n "$passed" ]; then
        ask "$work" $(batches "$name" "$passed")
        seconds=$(jq -r --argjson more "$seconds" '(.seconds + $more) * 100 | round / 100' "$kept/$key.json")
    fi
    [ -z "$where" ] || ask "$work" $(known_from_above "$entry") $(batches "$name" "")
    jq -cn --arg case "$where" --arg layer "$layer" --argjson seconds "$seconds" --arg sentence "$said" --arg of "$(hash_of_case "$where")" '$ARGS.named' >"$kept/$key.json.new"
    mv "$kept/$key.json.new" "$kept/$key.json"
    rm -rf "$work"
    right=$(printf %s "$entry" | jq -r --arg case "$where" 'if (.class == "equivalent") == ($case == "") then "ok " else "WRONG" end')
    printf '%s\t%s s\t%s\t%s\t%s\n' "$right" "$seconds" "$name" "${where:-passed everything}" "$said" | cut -c1-250
}

# What the table knows from before, under its key.
restore() {
    [ ! -f $table ] || python3 - $table <<'EOF'
import csv, json, os, sys
for row in csv.DictReader(open(sys.argv[1])):
    for level, prefix in ("A", ""), ("B", "B "), ("C", "C "):
        key, _, of = (row.get("key " + level) or "").partition(" ")
        path = f"build/faults/{level}/{key}.json"
        if of and not os.path.exists(path):
            os.makedirs(os.path.dirname(path), exist_ok=True)
            json.dump({"case": "" if row[level] in ("passes, as it must", "NOT CAUGHT") else row[level], "layer": row["layer"] if level == "A" else "",
                       "seconds": float(row[prefix + "seconds"]), "sentence": row["sentence at level A"] if level == "A" else "", "of": of}, open(path, "w"))
EOF
}

# The table: what each level has said of each entry; of levels that have no answer the old cells.
assemble() {
    jq -c '.faults[]' $list | python3 -c '
import glob, hashlib, json, os, sys
def hashed(data): return hashlib.sha1(data).hexdigest()[:16]
cases = {}
def of_case(name):          # as hash_of_case
    if name not in cases:
        files = sorted(glob.glob("validation/cases/*/%s/case.json" % (name or "*")), key=os.fsencode)
        cases[name] = hashed(b"".join(open(f, "rb").read() for f in files))
    return cases[name]
for line in sys.stdin:
    entry = json.loads(line)
    for level, sources in zip("ABC", sys.argv[1:]):
        key = hashed(("%s %s" % (sources, line.rstrip("\n"))).encode())
        path = "build/faults/%s/%s.json" % (level, key)
        said = json.load(open(path)) if os.path.exists(path) else {}
        entry[level] = dict(said, key=key + " " + said["of"]) if said and said["of"] == of_case(said["case"]) else None
    print(json.dumps(entry))' "$(sources A)" "$(sources B)" "$(sources C)" >build/faults/all.jsonl
    rows "$table" >build/faults/before.json
    jq -rn --slurpfile old build/faults/before.json '
        def number: if . == "" or . == null then "" else tonumber end;
        def caught(x; equivalent): if x.case == "" then (if equivalent then "passes, as it must" else "NOT CAUGHT" end) else x.case end;
        ["fault", "class", "origin", "file", "A", "layer", "seconds", "B", "B seconds", "C", "C seconds", "sentence at level A", "key A", "key B", "key C"],
        (inputs | . as $f | ($old[0][.name] // {}) as $was | (.class == "equivalent") as $e | [.name, .class, .origin, .file]
            + (if .A then [caught(.A; $e), .A.layer, .A.seconds] else [$was.A, $was.layer, ($was.seconds | number)] end)
            + (if .B then [caught(.B; $e), .B.seconds] else [$was.B, ($was["B seconds"] | number)] end)
            + (if .C then [caught(.C; $e), .C.seconds] else [$was.C, ($was["C seconds"] | number)] end)
            + [if .A then .A.sentence else $was["sentence at level A"] end]
            + [.A.key // $was["key A"], .B.key // $was["key B"], .C.key // $was["key C"]]) | map(. // "") | @csv' build/faults/all.jsonl >$table.new
    mv $table.new $table
    # Of which cases those times consisted that the table still names (the second word of a key).
    { echo "cases as of,case,hash"; { tail -n +2 "$suites" 2>/dev/null || true; sed "s/^/$(hash_of_case),/" build/faults/hashes/suite; } | LC_ALL=C sort -u |
        awk -F, 'NR == FNR { for (k = 1; k <= NF; k++) { gsub(/"/, "", $k); if (split($k, part, " ") == 2) named[part[2]] = 1 } next } $1 in named' "$table" -; } >"$suites.new"
    if [ "$(wc -l <"$suites.new")" -gt 1 ]; then mv "$suites.new" "$suites"; else rm -f "$suites.new" "$suites"; fi
}

summary() {
    jq -rs --arg level "$level" 'def at: .[$level];
        map(select(at)) | (map(select(.class != "equivalent"))) as $faults | (map(select(.class == "equivalent"))) as $same
        | ($faults | map(select(at.case != ""))) as $caught | ($caught | map(at.seconds) | sort) as $t
        | "faults at level \($level): \($caught | length) of \($faults | length) caught, median \($t[($t | length) / 2 | floor]) s, longest \($t[-1]) s; "
          + "\($same | map(select(at.case == "")) | length) of \($same | length) equivalent changes pass",
          ($faults[] | select(at.case == "") | "  not caught: \(.name)"), ($same[] | select(at.case != "") | "  flagged: \(.name): \(at.sentence)")' build/faults/all.jsonl
}

export SOURCES="${SOURCES:-$(sources "$level")}" GATE_REFERENCE="$PWD/tools/once.sh $PWD/build/faults/reference $PWD/build/lammps-candidate --own reference"
[ "${1:-}" = judge ] && { judge "$2"; exit; }
count=$(jq '.faults | length' $list)
rm -rf build/faults/reference build/faults/hashes && mkdir -p build/faults/reference build/faults/hashes
suite >build/faults/hashes/suite
restore
rows "$table" >build/faults/before.json
reference
reach
order
jq -r --arg only "${ONLY:-}" '.faults | to_entries[] | select(.value.name | contains($only)) | .key' $list | xargs -r -P "$jobs" -n 1 "$0" judge
assemble
summary | tee build/faults/summary.txt
[ "$(wc -l <build/faults/summary.txt)" = 1 ]
