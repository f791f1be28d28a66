#!/bin/sh
# A candidate that answers another question: altered.sh SED_SCRIPT PROGRAM ... CASE_DIR OUT_DIR. The scene goes through sed, one key a line.
script=$1
shift
n=$#
command=
for word; do
    n=$((n - 1))
    if [ $n -ge 2 ]; then command="$command $word"; elif [ $n -eq 1 ]; then question=$word; else answer=$word; fi
done
copy=$answer.altered
mkdir -p "$copy" && cp "$question"/* "$copy" && sed "$script" "$question/scene.json" >"$copy/scene.json" || exit 1
$command "$copy" "$answer"
