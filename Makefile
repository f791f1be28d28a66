# sheargate: `make help` lists the targets.

CC       ?= gcc
VERSION  := 0.1.0
COMMIT   := $(shell git rev-parse --short HEAD 2>/dev/null || echo unknown)
JOBS     ?= $(shell nproc)

# -std=c11 (not gnu11) also switches floating-point contraction off in gcc; said again for clang.
# -fno-math-errno only tells the compiler that nobody reads errno after sqrt; results are the same bits.
WARN     := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wstrict-prototypes -Wmissing-prototypes -Werror
OPT      ?= -O2
CFLAGS   ?= $(OPT) -g
BASE     := -std=c11 -D_XOPEN_SOURCE=700 -ffp-contract=off -fno-math-errno $(WARN) -MMD -MP
B        ?= build

SOLVER   := $(wildcard solver/*.c solver/*/*.c)
GATE     := $(wildcard validation/*.c validation/checks/*.c validation/theory/*.c)
TESTS    := $(wildcard tests/*.c)
LAMMPS   := $(wildcard tools/lammps/*.c)

SOLVER_O := $(SOLVER:%.c=$B/obj/%.o)
GATE_O   := $(GATE:%.c=$B/obj/%.o)
TESTS_O  := $(TESTS:%.c=$B/obj/%.o)

all: $B/shear $B/gate $B/lammps-candidate ## build the programs

$B/obj/solver/%.o: solver/%.c
	@mkdir -p $(@D)
	$(CC) $(BASE) $(CFLAGS) -DSHEAR_VERSION='"$(VERSION) ($(COMMIT))"' -Isolver -c $< -o $@

$B/obj/validation/%.o: validation/%.c
	@mkdir -p $(@D)
	$(CC) $(BASE) $(CFLAGS) -DGATE_VERSION='"$(VERSION) ($(COMMIT))"' -Ivalidation -c $< -o $@

$B/obj/tests/%.o: tests/%.c
	@mkdir -p $(@D)
	$(CC) $(BASE) $(CFLAGS) -Isolver -Ivalidation -Itests -c $< -o $@

$B/shear: $(SOLVER_O)
	$(CC) $(CFLAGS) $^ -o $@ -ljansson -lm

$B/gate: $(GATE_O)
	$(CC) $(CFLAGS) $^ -o $@ -ljansson -lgsl -lgslcblas -lm

$B/unit-tests: $(TESTS_O) $(filter-out $B/obj/solver/shear.o,$(SOLVER_O)) $(filter-out $B/obj/validation/gate.o,$(GATE_O))
	$(CC) $(CFLAGS) $^ -o $@ -lcunit -ljansson -lgsl -lgslcblas -lm

$B/lammps-candidate: $(LAMMPS)
	@mkdir -p $(@D)
	$(CC) $(BASE) $(CFLAGS) $^ -o $@ -ljansson -lm

test: all $B/unit-tests ## build and run the unit tests
	$B/unit-tests

validate: all ## run the fast tier against our own solver; report in build/report/index.html
	$B/gate run --candidate "$B/shear --evaluate" --jobs $(JOBS) --report $B/report

bench: all ## instructions and time per particle-step, against stock LAMMPS; build/bench.txt
	tools/bench/bench.sh $B

help: ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 16

clean: ## remove build/
	rm -rf $B

.PHONY: all test validate bench help clean
-include $(SOLVER_O:.o=.d) $(GATE_O:.o=.d) $(TESTS_O:.o=.d)
