# sheargate: `make help` lists the targets.

VERSION  := 0.1.0
COMMIT   := $(shell git rev-parse --short HEAD 2>/dev/null || echo unknown)
JOBS     ?= $(shell nproc)
B        ?= build

# -std=c11 (not gnu11) also switches floating-point contraction off in gcc; said again for clang.
# -fno-math-errno only tells the compiler that nobody reads errno after sqrt; results are the same bits.
WARN     := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wstrict-prototypes -Wmissing-prototypes -Werror
CFLAGS   ?= -O2 -g
BASE     := -std=c11 -D_XOPEN_SOURCE=700 -ffp-contract=off -fno-math-errno $(WARN) -MMD -MP

SOLVER   := $(wildcard solver/*.c solver/*/*.c)
GATE     := $(wildcard validation/*.c validation/checks/*.c validation/theory/*.c)
TESTS    := $(wildcard tests/*.c)
ENGINE   := $(wildcard tools/engine/*.c)
objects   = $(1:%.c=$B/obj/%.o)
PROGRAMS := $B/shear $B/gate $B/lammps-candidate $B/lammps-host $B/shear-lammps $B/compare-checkpoints $B/retrace
# Takes part in the jobs of a `make -jN` that called it; else uses all cores.
PARALLEL  = --no-print-directory $(if $(findstring jobserver,$(MAKEFLAGS)),,-j$(JOBS))

all: ## build the programs
	@$(MAKE) $(PARALLEL) $(PROGRAMS)

setup: ## install what is missing (Debian packages; as root or with sudo)
	@tools/setup.sh

# `make -j setup validate` must not build before the libraries are there.
ifneq ($(filter setup,$(MAKECMDGOALS)),)
all test validate: | setup
endif

validate: all ## the fast tier against our own solver, and its report
	$B/gate run --candidate "$B/shear --evaluate" --jobs $(JOBS) --work $B/cases --report $B/report

test: ## build and run the unit tests, and run the CI files of tools/ci
	@$(MAKE) $(PARALLEL) $(PROGRAMS) $B/unit-tests
	$B/unit-tests
	@tools/ci/check.sh $B

# ---- programs ----

# The commit that programs print: a file that changes with it, so that what names it is compiled anew.
$B/commit: FORCE
	@mkdir -p $(@D)
	@echo '$(COMMIT)' | cmp -s - $@ || echo '$(COMMIT)' >$@
$B/obj/solver/shear.o $B/obj/solver/describe.o $B/obj/validation/gate.o $B/obj/validation/checks/kept.o $B/obj/validation/checks/dense_viscosities.o \
  $B/obj/validation/checks/published_shear.o $B/obj/tools/engine/main.o: $B/commit
FORCE:

$B/obj/solver/%.o: solver/%.c
	@mkdir -p $(@D)
	$(CC) $(BASE) $(CFLAGS) -DSHEAR_VERSION='"$(VERSION) ($(COMMIT))"' -Isolver -c $< -o $@

$B/obj/validation/%.o: validation/%.c
	@mkdir -p $(@D)
	$(CC) $(BASE) $(CFLAGS) -DGATE_VERSION='"$(VERSION) ($(COMMIT))"' -Ivalidation -c $< -o $@

# Half of the time of the statistical checks is spent in sums over draws: -O3 makes loops out of them that run several at a time.
$B/obj/validation/statistics.o: CFLAGS += -O3

$B/obj/tests/%.o: tests/%.c
	@mkdir -p $(@D)
	$(CC) $(BASE) $(CFLAGS) -Isolver -Ivalidation -Ivalidation/theory -Itests -Itools/engine -Itools/golden -c $< -o $@

# LAMMPS as a library, and MPI; as system headers, for their warnings are not ours to mend.
HOST_CFLAGS = $(patsubst -I%,-isystem %,$(shell pkg-config --cflags liblammps ompi-c))
HOST_LIBS   = $(shell pkg-config --libs liblammps ompi-c)

$B/obj/tools/engine/%.o: tools/engine/%.c
	@mkdir -p $(@D)
	$(CC) $(BASE) $(CFLAGS) -DSHEAR_VERSION='"$(VERSION) ($(COMMIT))"' -Isolver -Itools/engine $(HOST_CFLAGS) -c $< -o $@

$B/shear: $(call objects,$(SOLVER))
	$(CC) $(CFLAGS) $^ -o $@ -ljansson -lm

$B/gate: $(call objects,$(GATE))
	$(CC) $(CFLAGS) $^ -o $@ -ljansson -lgsl -lgslcblas -lm

# The gate's own resistances inside LAMMPS's library: a second code where stock styles are wrong.
$B/lammps-host: $B/obj/tools/lammps/host.o $B/obj/validation/theory/resistance.o $B/obj/validation/theory/repulsion.o
	$(CC) $(CFLAGS) $^ -o $@ -llammps -lm

$B/obj/tools/lammps/%.o: tools/lammps/%.c
	@mkdir -p $(@D)
	$(CC) $(BASE) $(CFLAGS) -DLAMMPS_SMALLBIG -Ivalidation/theory -c $< -o $@

# Golden vectors: the gate's closed forms, written down.
GOLDEN  := $(wildcard tools/golden/*.c)
$B/obj/tools/golden/%.o: tools/golden/%.c
	@mkdir -p $(@D)
	$(CC) $(BASE) $(CFLAGS) -Ivalidation/theory -c $< -o $@

$B/vectors: $(call objects,$(GOLDEN) $(addprefix validation/theory/,contact.c contact_laws.c drag.c repulsion.c resistance.c))
	$(CC) $(CFLAGS) $^ -o $@ -lm

# The audit: everything of validation/theory again, in quadruple precision.
AUDIT   := $(wildcard tools/audit/*.c)
$B/obj/tools/audit/%.o: tools/audit/%.c
	@mkdir -p $(@D)
	$(CC) $(BASE) $(CFLAGS) -Ivalidation/theory -c $< -o $@

$B/audit: $(call objects,$(AUDIT) $(wildcard validation/theory/*.c))
	$(CC) $(CFLAGS) $^ -o $@ -ljansson -lgsl -lgslcblas -lquadmath -lm

$B/lammps-candidate: tools/lammps/candidate.py $B/lammps_stock.py $B/lammps_own.py $B/lammps_reference.py
	@mkdir -p $(@D)
	install -m 755 $< $@

$B/lammps_%.py: tools/lammps/lammps_%.py
	@mkdir -p $(@D)
	install -m 644 $< $@

$B/obj/tools/compare/%.o: tools/compare/%.c
	@mkdir -p $(@D)
	$(CC) $(BASE) $(CFLAGS) -c $< -o $@

$B/shear-lammps: $(call objects,$(ENGINE) $(filter-out solver/shear.c,$(SOLVER)))
	$(CC) $(CFLAGS) $^ -o $@ -ljansson $(HOST_LIBS) -lm

$B/compare-checkpoints: $B/obj/tools/compare/checkpoints.o
	$(CC) $(CFLAGS) $^ -o $@ -lm

$B/obj/tools/compare/retrace.o: private BASE += -Isolver
$B/retrace: $(call objects,tools/compare/retrace.c $(filter-out solver/shear.c,$(SOLVER)))
	$(CC) $(CFLAGS) $^ -o $@ -ljansson -lm

$B/unit-tests: $(call objects,$(TESTS) tools/engine/refuse.c $(filter-out tools/golden/main.c,$(GOLDEN)) $(filter-out solver/shear.c,$(SOLVER)) $(filter-out validation/gate.c,$(GATE)))
	$(CC) $(CFLAGS) $^ -o $@ -lcunit -ljansson -lgsl -lgslcblas -lm

# ---- measuring: each prints its figure on its last line and fails when its bar is not met ----

lines: ## length of the tour through the solver (at most 2000 lines)
	@tools/lines.sh

coverage: ## lines of solver/ that tests and fast tier execute (at least 90 %)
	@tools/coverage.sh

# gcc warns falsely of its own instrumentation, so here alone warnings are no errors.
sanitize: all ## unit tests and the gate's cases under address and undefined-behaviour sanitizers
	@$(MAKE) $(PARALLEL) B=$B/sanitize CFLAGS="-O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all -Wno-error" $B/sanitize/unit-tests $B/sanitize/shear $B/sanitize/gate $B/sanitize/lammps-candidate \
		$B/sanitize/shear-lammps $B/sanitize/compare-checkpoints
	$B/sanitize/unit-tests
	$B/sanitize/gate run --candidate "$B/sanitize/shear --evaluate" --jobs $(JOBS) --work $B/sanitize/cases --report $B/sanitize/report
	@echo "sanitize: clean"

memcheck: all ## valgrind on one run of everything at once
	@tools/memcheck.sh

adapters: all ## the worked examples of docs/adapter.md (Fortran, Python, a LAMMPS dump) and mistakes planted in them
	@tools/adapters/adapters.sh $B

corrupted: all ## right answers, spoilt on the way (rows, steps, times, files missing): each must be noticed
	@BUILD=$B tools/corrupted.py $(ONLY)

scenes: all ## run every sample scene and draw its plot (at most 20 s each)
	@tools/scenes.sh

faults: all ## each fault of validation/faults/ against the fast tier (ONLY=word for some)
	@tools/faults.sh

SEEDS ?= 100
calibrate: all ## false verdicts of the statistical checks on the correct solver, over SEEDS seeds (default 100; none allowed); goes on where docs/measured/calibration.csv ends
	@code=0; $B/gate calibrate --candidate "$B/shear --evaluate" --jobs $(JOBS) --seeds $(SEEDS) --table docs/measured/calibration.csv --work $B/calibrating || code=$$?; \
	$B/gate calibrate --candidate "$B/shear --evaluate" --seeds 1 --table docs/measured/calibration.csv --work $B/calibrating >$B/calibration.txt; \
	tools/docs/calibration.py docs/measured/calibration.csv $B/calibration.txt docs/calibration.png; exit $$code

levels: all ## the fast tier against our own solver as if it were of entry level B, then C
	@for l in B C; do echo "== level $$l"; \
		$B/gate run --candidate "$B/shear --evaluate" --level $$l --jobs $(JOBS) --work $B/levels --report $B/levels-report || exit 1; done

OFFSETS ?= 1 2 3 4
seeds: all ## the whole fast tier on our solver under other seeds (OFFSETS="1 2 3 4"; a minute each): none may be red
	@for k in $(OFFSETS); do \
		code=0; $B/gate run --candidate "$B/shear --evaluate" --jobs $(JOBS) --seed-offset $$k --work $B/seeds --report $B/seeds-report >$B/seeds.txt || code=$$?; \
		echo "seeds: offset $$k: $$(tail -1 $B/seeds.txt)"; [ $$code = 0 ] || { grep -A3 " FAIL \| inconclusive " $B/seeds.txt; exit 1; }; done

bench: all ## particle-steps per second and instructions per particle-step, beside stock LAMMPS
	@tools/bench/bench.sh $B

scaling: all ## time of a step against the number of spheres, 1e2 to 1e5 (exponent at most 1.08)
	@tools/bench/scaling.sh $B

VISCOSITIES := $(shell cd validation/cases/6-dense && echo viscosities-* | tr ' ' ',')
golden: all ## sheared viscosities, code against code: hours of two cores, kept row by row in golden/viscosities; goes on where it stopped
	@code=0; $B/gate run --candidate "$B/shear --evaluate" --tier full --case $(VISCOSITIES) --jobs $(JOBS) --keep golden/viscosities --work $B/golden-cases --report $B/golden-report || code=$$?; \
	golden/viscosities/page.py golden/viscosities docs/viscosities.md && (cd golden/viscosities && gnuplot plot.gp) && \
	echo "golden: $$(grep -h ',viscosity,' golden/viscosities/*-table.csv | wc -l) rows computed, $$(cat validation/cases/6-dense/viscosities-*/case.json | grep -c '"dear"') listed with their cost; verdicts above, exit code $$code"; exit $$code

retrace: all ## the four rows in which paths part: each step of a run of LAMMPS, done again by shear (5 minutes)
	@tools/compare/retrace.sh $B

engine: all $B/unit-tests ## shear-lammps against shear, pathwise on 1, 2 and 4 ranks; restart; broken engines must be seen
	@tools/engine/measure.sh $B

engine-cost: all ## a step of shear-lammps against one of shear, and on 2 ranks against 1 (quiet machine)
	@tools/engine/cost.sh $B

second-opinion: ## LAMMPS's lubrication and noise styles, coefficient by coefficient (docs/lammps.md)
	@python3 tools/lammps/coefficients.py

ci-files: $B/shear ## run tools/ci/*.yml as GitHub and GitLab would, with a right and a wrong candidate
	@tools/ci/check.sh $B

suite-manifest: $B/gate ## freeze what the suite asks and how strictly (validation/suite-1.0.json); once, when it is released
	$B/gate freeze

vectors: all ## golden/vectors against what makes them (same bytes) and against our solver
	@$(MAKE) $(PARALLEL) $B/vectors
	@python3 tools/golden/check.py $B
audit: ## golden vectors and closed forms of the gate, recomputed in quadruple precision by other derivations
	@$(MAKE) $(PARALLEL) $B/audit
	@$B/audit

verdicts: ## docs/verdicts.md against the cases and the results of the last make validate
	@python3 tools/docs/verdicts.py --run

findings: all ## what is wrong in stock LAMMPS: the smallest decks, and the gate's own words, beside docs/findings.md
	@B=$B python3 tools/lammps/findings.py

work-precision: all ## seconds for 1 % of the pairs near contact, by integrator and step (about 5 minutes; keeps finished rows)
	@tools/work-precision.sh $B

help: ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 16

clean: ## remove build/
	rm -rf $B

.PHONY: all setup validate test lines coverage sanitize memcheck adapters corrupted scenes faults calibrate levels seeds bench scaling golden retrace engine engine-cost second-opinion ci-files \
	suite-manifest findings vectors audit verdicts work-precision help clean FORCE
-include $(patsubst %.o,%.d,$(call objects,$(SOLVER) $(GATE) $(TESTS) $(ENGINE) $(GOLDEN) $(AUDIT) tools/compare/checkpoints.c tools/compare/retrace.c))
