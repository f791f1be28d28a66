#include "calibrate.h"

#include "statistics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_LENGTH = 1 << 16, FIXED = 4 };      /* offset, seconds, failed, inconclusive */

static void quiet(const struct finished_case *done)
{
    (void)done;
}

/* A column's name: "case: result" without what separates columns. */
static void column_name(char *text, size_t room, const char *case_name, const char *what)
{
    snprintf(text, room, "%s: %s", case_name, what);
    for (char *c = text; *c; c++)
        if (*c == ',' || *c == '\n')
            *c = ';';
}

/* Who made the rows that follow. */
static void write_builds(FILE *file, const struct provenance *p)
{
    fprintf(file, "# gate %s, candidate %s (%s)\n", p->gate_version, p->candidate_hash, p->candidate);
}

static void write_header(FILE *file, const struct provenance *p, const struct finished_case *done, size_t count)
{
    char name[WHY_LENGTH];
    fprintf(file, "# statistical cases %s\n# first p-value of every statistical result of the fast tier, by seed offset\n", p->suite_hash);
    write_builds(file, p);
    fprintf(file, "offset,seconds,failed,inconclusive");
    for (size_t k = 0; k < count; k++)
        for (size_t r = 0; r < done[k].results.count; r++)
            if (!isnan(done[k].results.item[r].first_p)) {
                column_name(name, sizeof name, done[k].gate_case->name, done[k].results.item[r].what);
                fprintf(file, ",%s", name);
            }
    fprintf(file, "\n");
}

/* The first p-value that has this column's name; NaN where a run gave none. */
static double p_of(const char *column, const struct finished_case *done, size_t count)
{
    char name[WHY_LENGTH];
    for (size_t k = 0; k < count; k++)
        for (size_t r = 0; r < done[k].results.count; r++) {
            column_name(name, sizeof name, done[k].gate_case->name, done[k].results.item[r].what);
            if (strcmp(name, column) == 0)
                return done[k].results.item[r].first_p;
        }
    return NAN;
}

/* `header`: the line that names the columns. */
static void write_row(FILE *file, const char *header, unsigned offset, double seconds, const struct finished_case *done, size_t count)
{
    const struct tally t = report_tally(done, count);
    char *names = strcpy(malloc(strlen(header) + 1), header);
    int at = 0;
    fprintf(file, "%u,%.1f,%d,%d", offset, seconds, t.failed - t.inconclusive, t.inconclusive);
    for (char *word = strtok(names, ",\n"); word; word = strtok(NULL, ",\n"))
        if (at++ >= FIXED)
            fprintf(file, ",%.4g", p_of(word, done, count));
    fprintf(file, "\n");
    fflush(file);
    free(names);
}

/* Where a table ends: the line that names the columns (empty if there is none yet), the last offset, whether this build made the last rows. */
struct end { char *header; unsigned last; bool same_build; };

/* False if the table was made by other cases. */
static bool where_it_ends(const char *path, const struct provenance *p, struct end *end, char why[WHY_LENGTH])
{
    char *line = malloc(LINE_LENGTH), cases[80], build[200];
    FILE *file = fopen(path, "r");
    bool mine = true;
    end->last = 0;
    *end->header = '\0';
    snprintf(cases, sizeof cases, "# statistical cases %s\n", p->suite_hash);
    snprintf(build, sizeof build, "# gate %s, candidate %s ", p->gate_version, p->candidate_hash);
    if (file && line && fgets(line, LINE_LENGTH, file)) {
        mine = strcmp(line, cases) == 0;
        while (fgets(line, LINE_LENGTH, file)) {
            if (*line == 'o')
                strcpy(end->header, line);
            else if (*line == '#')
                end->same_build = strstr(line, build) == line;
            else if (strchr(line, '\n'))
                end->last = (unsigned)strtoul(line, NULL, 10);
        }
    }
    if (file)
        fclose(file);
    free(line);
    return mine || why_not(why, "%s was made by other statistical cases; remove it or name another file", path);
}

bool calibrate_run(struct run_plan *plan, const struct provenance *p, unsigned seeds, const char *path, char why[WHY_LENGTH])
{
    struct end end = { .header = calloc(LINE_LENGTH, 1) };
    if (!end.header || !where_it_ends(path, p, &end, why)) {
        free(end.header);
        return false;
    }
    FILE *file = fopen(path, "a");
    if (!file) {
        free(end.header);
        return why_not(why, "%s cannot be written", path);
    }
    if (*end.header && !end.same_build && end.last < seeds)
        write_builds(file, p);
    for (unsigned offset = end.last + 1; offset <= seeds; offset++) {
        struct finished_case *done = calloc(plan->count, sizeof *done);
        const double start = candidate_now();
        plan->seed_offset = offset;
        run_all(plan, done, quiet);
        if (!*end.header) {
            struct end begun = { .header = end.header };
            write_header(file, p, done, plan->count);
            fflush(file);
            where_it_ends(path, p, &begun, why);
        }
        write_row(file, end.header, offset, candidate_now() - start, done, plan->count);
        const struct tally t = report_tally(done, plan->count);
        printf("seed %u of %u: %d passed, %d failed (%d inconclusive)\n", offset, seeds, t.passed, t.failed, t.inconclusive);
        fflush(stdout);
        for (size_t k = 0; k < plan->count; k++)
            results_free(&done[k].results);
        free(done);
    }
    free(end.header);
    return fclose(file) == 0 || why_not(why, "%s was not written in full", path);
}

struct column { char *name; double *p; size_t count; };

static size_t below(const struct column *c, double limit)
{
    size_t n = 0;
    for (size_t k = 0; k < c->count; k++)
        n += c->p[k] < limit;
    return n;
}

static double smallest(const struct column *c)
{
    double least = 1.0;
    for (size_t k = 0; k < c->count; k++)
        least = fmin(least, c->p[k]);
    return least;
}

static void print_column(const struct column *c, const char *name)
{
    printf("%-64.64s %6zu %6zu %6zu %6zu %9.2g %9.2g\n", name, c->count, below(c, 0.01), below(c, 0.001), below(c, 1e-4), smallest(c),
           statistics_uniform_p(c->p, c->count));
}

int calibrate_summary(const char *path, char why[WHY_LENGTH])
{
    char *line = malloc(LINE_LENGTH);
    struct column *column = NULL, all = { NULL, NULL, 0 };
    size_t columns = 0, seeds = 0, failed = 0, inconclusive = 0;
    double seconds = 0.0;
    FILE *file = fopen(path, "r");
    if (!file || !line) {
        free(line);
        why_not(why, "%s cannot be read", path);
        return 2;
    }
    while (fgets(line, LINE_LENGTH, file)) {
        if (*line == '#' || !strchr(line, '\n'))
            continue;
        size_t at = 0;
        double value[FIXED] = { 0 };
        const bool header = !columns;
        for (char *word = strtok(line, ",\n"); word; word = strtok(NULL, ",\n"), at++) {
            if (header && at >= FIXED) {
                column = realloc(column, (columns + 1) * sizeof *column);
                column[columns++] = (struct column){ strcpy(malloc(strlen(word) + 1), word), NULL, 0 };
            } else if (!header && at < FIXED)
                value[at] = strtod(word, NULL);
            else if (!header && at - FIXED < columns) {
                struct column *c = &column[at - FIXED];
                if (!isfinite(strtod(word, NULL)))
                    continue;
                c->p = realloc(c->p, (c->count + 1) * sizeof *c->p);
                all.p = realloc(all.p, (all.count + 1) * sizeof *all.p);
                c->p[c->count++] = all.p[all.count++] = strtod(word, NULL);
            }
        }
        if (header)
            continue;
        seeds++;
        seconds += value[1];
        failed += value[2] > 0;
        inconclusive += value[3] > 0;
    }
    fclose(file);
    printf("%-64s %6s %6s %6s %6s %9s %9s\n", "check", "p's", "<0.01", "<1e-3", "<1e-4", "smallest", "uniform p");
    for (size_t k = 0; k < columns; k++)
        print_column(&column[k], column[k].name);
    print_column(&all, "all together");
    printf("expected %69s %6.1f %6.1f %6.1f   (conservative checks give fewer, and are not uniform)\n", "", 0.01 * (double)all.count,
           0.001 * (double)all.count, 1e-4 * (double)all.count);
    /* 0 events in n trials bound the rate below 1 - 0.05^(1/n) with 95 % confidence; more events are a failure anyhow. */
    printf("calibrate: %zu seeds, %.1f s each, %zu p-values: %zu with a false failure, %zu inconclusive", seeds,
           seeds ? seconds / (double)seeds : 0.0, all.count, failed, inconclusive);
    if (seeds && !failed && !inconclusive)
        printf("; the rate is below %.2g with 95 %% confidence", 1.0 - pow(0.05, 1.0 / (double)seeds));
    printf("\n");
    for (size_t k = 0; k < columns; k++) {
        free(column[k].name);
        free(column[k].p);
    }
    free(column);
    free(all.p);
    free(line);
    return !seeds || failed || inconclusive;
}
