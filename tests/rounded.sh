#!/bin/sh
# A candidate of few digits: rounded.sh DIGITS PROGRAM ... CASE_DIR OUT_DIR. Numbers of states and answers pass through DIGITS significant digits.
digits=$1
shift
n=$#
command=
for word; do
    n=$((n - 1))
    if [ $n -ge 2 ]; then command="$command $word"; elif [ $n -eq 1 ]; then question=$word; else answer=$word; fi
done
rounded() {     # from, to: every field with a point or an exponent
    awk -F, -v OFS=, -v form="%.${digits}g" '/^#/ || !/[0-9]/ { print; next }
        { for (k = 1; k <= NF; k++) if ($k ~ /^[-+]?[0-9.]+([eE][-+]?[0-9]+)?$/ && $k ~ /[.eE]/) $k = sprintf(form, $k); print }' "$1" >"$2"
}
copy=$answer.rounded
mkdir -p "$copy" && cp "$question"/* "$copy" || exit 1
for table in states contacts; do
    if [ -e "$question/$table.csv" ]; then rounded "$question/$table.csv" "$copy/$table.csv"; fi
done
$command "$copy" "$answer" || exit $?
for table in "$answer"/*.csv; do
    if [ -e "$table" ]; then rounded "$table" "$table.rounded" && mv "$table.rounded" "$table"; fi
done
