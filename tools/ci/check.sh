#!/bin/sh
# Runs the CI files of this folder as their services would: in a fresh repository with an adapter for our solver, line by line, with the gate
# cloned from here and built. Once with the adapter as it is (must end green), once with the drag torque 2 % too large (must end red,
# and say so where the service looks). `check.sh BUILD_FOLDER`. What is not run: actions (`uses:`), and installing packages.
set -eu
cd "$(dirname "$0")/../.."
shear=$(realpath "$1/shear")
here=$PWD
work=$(mktemp -d /tmp/ci-files-XXXXXX)
trap 'rm -rf "$work"' EXIT
fail() { echo "ci-files: $1"; [ -z "${2:-}" ] || tail -n 20 "$2"; exit 1; }

# Where the clone comes from: this tree as it stands, committed in a copy, so that what is tested is what is here.
mkdir "$work/origin" "$work/bin"
git ls-files --cached --others --exclude-standard | while IFS= read -r f; do [ ! -e "$f" ] || echo "$f"; done | tar -cf - -T - | tar -xf - -C "$work/origin"
git -C "$work/origin" init -q -b main
git -C "$work/origin" add -A
git -C "$work/origin" -c user.name=ci -c user.email=ci@localhost -c commit.gpgsign=false commit -q -m "as it stands"
printf '#!/bin/sh\nexit 0\n' >"$work/bin/apt-get"       # packages are there (make setup); nothing is installed from here
chmod +x "$work/bin/apt-get"

# A repository of somebody's code: `make` makes ./adapter, which calls our solver and, if asked, spoils a torque.
repository() {
    mkdir -p "$1"
    cat >"$1/Makefile" <<END
adapter: adapter.in
	cp adapter.in adapter && chmod +x adapter
END
    cat >"$1/adapter.in" <<END
#!/bin/sh
set -e
"$shear" --evaluate "\$1" "\$2"
awk -F, -v OFS=, '\$2 == "drag" || \$2 == "total" { for (k = 7; k <= 9; k++) \$k = sprintf("%.17g", $2 * \$k) } 1' "\$2/forces.csv" >"\$2/spoilt"
mv "\$2/spoilt" "\$2/forces.csv"
END
}

# in_service FILE ENVIRONMENT_FILTER LINES_FILE: the lines in bash with -e, in an environment that has what the file says and little else.
in_service() {
    file=$1 filter=$2 lines=$3
    yq -r "$filter | to_entries[] | \"\(.key)=\(.value)\"" "$file" >"$work/environment"
    set --
    while IFS= read -r setting; do set -- "$@" "$setting"; done <"$work/environment"
    env -i PATH="$work/bin:$PATH" HOME="$work" CFLAGS=-O0 "$@" SHEARGATE="file://$work/origin" \
        OPTIONS="--case drag,units-drag" GITHUB_ACTIONS="${on_github:-}" GITHUB_STEP_SUMMARY="$PWD/summary.md" \
        bash -e "$lines"
}

# The objects of the first build serve the later ones: the same sources, newer than any clone.
lend_objects() { [ ! -d "$work/obj" ] || [ -d sheargate/build ] || { mkdir -p sheargate/build && cp -r "$work/obj" sheargate/build/obj; }; }
keep_objects() { [ -d "$work/obj" ] || cp -r sheargate/build/obj "$work/obj"; }

# github DIRECTORY: every `run:` in its order; stops at the first that fails, as GitHub does.
github() {
    (cd "$1" && on_github=true && for k in $(yq -r '.jobs.gate.steps | keys[]' "$here/tools/ci/github.yml"); do
        yq -r ".jobs.gate.steps[$k].run // empty" "$here/tools/ci/github.yml" >step.sh
        if grep -q 'git clone' step.sh; then # in two halves, to lend objects between them
            grep 'git clone' step.sh >clone.sh
            grep -v 'git clone' step.sh >step2.sh && mv step2.sh step.sh
            in_service "$here/tools/ci/github.yml" .env clone.sh || exit 1
            lend_objects
        fi
        in_service "$here/tools/ci/github.yml" .env step.sh || exit 1
    done && keep_objects) >"$1.txt" 2>&1
}

gitlab() {
    (cd "$1" && yq -r '.gate.before_script[], .gate.script[]' "$here/tools/ci/gitlab.yml" >job.sh
     clone=$(grep -n 'git clone' job.sh | cut -d: -f1)
     sed -n "1,${clone}p" job.sh >first.sh
     sed "1,${clone}d" job.sh >second.sh
     in_service "$here/tools/ci/gitlab.yml" .gate.variables first.sh && lend_objects &&
         in_service "$here/tools/ci/gitlab.yml" .gate.variables second.sh) >"$1.txt" 2>&1
}

for service in github gitlab; do
    yq . "tools/ci/$service.yml" >/dev/null || fail "$service.yml is no YAML"
    repository "$work/$service-right" 1
    $service "$work/$service-right" || fail "$service.yml: a right candidate ends red" "$work/$service-right.txt"
    [ "$(tail -n 1 "$work/$service-right.txt")" = "2 passed, 0 failed, 0 skipped" ] || fail "$service.yml: no verdict" "$work/$service-right.txt"
    repository "$work/$service-wrong" 1.02
    ! $service "$work/$service-wrong" || fail "$service.yml: a wrong candidate ends green" "$work/$service-wrong.txt"
    grep -q '8 pi eta a^3 (half the vorticity - w) is 1.02 of expected' "$work/$service-wrong.txt" ||
        fail "$service.yml: red, but not for the torque" "$work/$service-wrong.txt"
done

# What each service shows of it, at the places that the files name.
grep -q '^::error file=adapter,title=pair / drag (FAIL)::' "$work/github-wrong.txt" || fail "github.yml: no annotation" "$work/github-wrong.txt"
! grep -q '^::' "$work/github-right.txt" || fail "github.yml: an annotation where nothing is wrong"
grep -q '^### What is wrong' "$work/github-wrong/summary.md" || fail "github.yml: no summary"
kept=$(yq -r '.jobs.gate.steps[] | select(.uses // "" | startswith("actions/upload-artifact")) | .with.path' tools/ci/github.yml)
[ -s "$work/github-wrong/$kept/index.html" ] || fail "github.yml: nothing to keep at $kept"
junit=$(yq -r .gate.artifacts.reports.junit tools/ci/gitlab.yml)
xmllint --noout --nonet --dtdvalid validation/junit.dtd "$work/gitlab-wrong/$junit" || fail "gitlab.yml: no valid report at $junit"
grep -q 'failures="1"' "$work/gitlab-wrong/$junit" || fail "gitlab.yml: the report does not count the failure"
[ -s "$work/gitlab-wrong/$(yq -r '.gate.artifacts.paths[0]' tools/ci/gitlab.yml)/index.html" ] || fail "gitlab.yml: nothing to keep"
echo "ci-files: github.yml and gitlab.yml green for a right candidate, red for a wrong one"
