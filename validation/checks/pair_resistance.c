/*
 * The pair resistance matrix, measured: twelve frozen states per geometry, each with one unit velocity or spin, give R
 * column by column from the candidate's own forces (force = - R u; order U_1 U_2 W_1 W_2, F_1 F_2 T_1 T_2).
 *
 * Invariants of that R, without any formula: zero at rest, linear, third law, symmetric, positive semidefinite, rank 5
 * (one squeeze and two times two sliding modes), and no other terms than isotropy about n allows (no twist).
 * With one-body drag in the scene the `total` is measured: it must resist all twelve modes.
 * Then the seven coefficients X_A .. C_22 one by one, each wherever it stands in R: the verdict names the entry, and
 * tells from the pattern over gaps and sizes what kind of mistake it is.
 */
#include "pair_checks.h"
#include "pair_pattern.h"
#include "pair_picture.h"

#include <gsl/gsl_eigen.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 12, STATES = COLUMNS + 2 /* and at rest, and a random motion */, GAPS = 16, SIZES = 64 };
#define SPEED 0.7

/* An entry of R in which a coefficient stands: block row (0, 1: force, 2, 3: torque on 1, 2) and block column. */
struct entry { int coefficient, row, column; };
static const struct entry entries[] = {
    { THEORY_XA, 0, 0 },  { THEORY_XA, 0, 1 },  { THEORY_XA, 1, 0 },  { THEORY_XA, 1, 1 },  { THEORY_YA, 0, 0 },
    { THEORY_YA, 0, 1 },  { THEORY_YA, 1, 0 },  { THEORY_YA, 1, 1 },  { THEORY_B1, 0, 2 },  { THEORY_B1, 1, 2 },
    { THEORY_B1, 2, 0 },  { THEORY_B1, 2, 1 },  { THEORY_B2, 0, 3 },  { THEORY_B2, 1, 3 },  { THEORY_B2, 3, 0 },
    { THEORY_B2, 3, 1 },  { THEORY_C11, 2, 2 }, { THEORY_C12, 2, 3 }, { THEORY_C12, 3, 2 }, { THEORY_C22, 3, 3 },
};
enum { ENTRIES = sizeof entries / sizeof *entries };

struct survey {
    double xi[GAPS], ratio[SIZES];                  /* a_2/a_1 */
    size_t gaps, sizes;
    const char *force;                              /* lubrication, or total where drag acts too */
    int modes;                                      /* that R must resist: 5, or 12 */
    double measured[ENTRIES][SIZES][GAPS], expected[ENTRIES][SIZES][GAPS];
    double allowance;           /* for answers of few digits, as the gate allows them */
    struct worst rest, linear, third_law, symmetry, positive, rank, other;
    struct entry asymmetric;                        /* where the symmetry is worst */
};

static void fill_book(struct check_run *run, const struct model *m, struct survey *s, struct pair_book *book)
{
    parameter_list(run->gate_case->parameters, "xi", s->xi, &s->gaps, GAPS);
    gsl_rng *random = pair_random(run);
    s->sizes = m->species;
    for (size_t b = 0; b < s->sizes; b++) {
        s->ratio[b] = m->radius[b] / m->radius[0];
        for (size_t g = 0; g < s->gaps; g++) {
            struct pair_state p = random_pair(random, m->radius[0], m->radius[b], s->xi[g]);
            book_add(book, &p);                     /* the random motion first: it keeps its velocities */
            for (int column = -1; column < COLUMNS; column++) {
                for (int k = 0; k < COLUMNS; k++) {
                    struct theory_sphere *sphere = &p.s[k / 3 % 2];
                    (k < 6 ? sphere->u : sphere->w)[k % 3] = k == column ? SPEED : 0;
                }
                book_add(book, &p);
            }
        }
    }
    gsl_rng_free(random);
}

static void six(const struct pair_answer *a, const char *force, size_t state, double out[COLUMNS])
{
    for (int side = 0; side < 2; side++) {
        const double *own = forces_at(&a->forces, state, force, 1 + side);
        for (int k = 0; k < 3; k++) {
            out[3 * side + k] = own[k];
            out[6 + 3 * side + k] = own[3 + k];
        }
    }
}

/* R in units of length `size`, so that forces and torques can be compared. */
static void scaled(double size, const double R[COLUMNS][COLUMNS], double out[COLUMNS][COLUMNS])
{
    for (int i = 0; i < COLUMNS; i++)
        for (int j = 0; j < COLUMNS; j++)
            out[i][j] = R[i][j] / (i < 6 ? 1 : size) / (j < 6 ? 1 : size);
}

/* The coefficient in a 3 x 3 block, and what of the block is not of its form is subtracted from `rest`. */
static double project(const struct entry *e, const double n[3], double rest[COLUMNS][COLUMNS],
                      const double R[COLUMNS][COLUMNS])
{
    static const int next[3] = { 1, 2, 0 };
    double along = 0, trace = 0, skew = 0, value;
    for (int i = 0; i < 3; i++) {
        trace += R[3 * e->row + i][3 * e->column + i];
        for (int j = 0; j < 3; j++)
            along += n[i] * R[3 * e->row + i][3 * e->column + j] * n[j];
        const int j = next[i], k = next[j];
        skew += 0.5 * n[i] * (R[3 * e->row + j][3 * e->column + k] - R[3 * e->row + k][3 * e->column + j]);
    }
    const bool is_along = e->coefficient == THEORY_XA, is_skew = e->coefficient == THEORY_B1 || e->coefficient == THEORY_B2;
    value = is_along ? along : is_skew ? skew : 0.5 * (trace - along);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int k = 3 - i - j;
            const double cross_n = i == j ? 0 : next[i] == j ? n[k] : -n[k];
            const double form = is_along ? n[i] * n[j] : is_skew ? cross_n : (i == j) - n[i] * n[j];
            rest[3 * e->row + i][3 * e->column + j] -= value * form;
        }
    return value;
}

/* Smallest eigenvalue over largest, and the number of eigenvalues that are not zero. */
static void spectrum(const double R[COLUMNS][COLUMNS], double allowance, double *smallest, int *rank)
{
    gsl_matrix *matrix = gsl_matrix_alloc(COLUMNS, COLUMNS);
    gsl_vector *value = gsl_vector_alloc(COLUMNS);
    gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(COLUMNS);
    for (size_t i = 0; i < COLUMNS; i++)
        for (size_t j = 0; j < COLUMNS; j++)
            gsl_matrix_set(matrix, i, j, 0.5 * (R[i][j] + R[j][i]));
    gsl_eigen_symm(matrix, value, work);
    const double largest = gsl_vector_max(value);
    *smallest = gsl_vector_min(value) / largest;
    *rank = 0;
    for (size_t i = 0; i < COLUMNS; i++)
        *rank += fabs(gsl_vector_get(value, i)) > fmax(1e-8, allowance) * largest;
    gsl_eigen_symm_free(work);
    gsl_vector_free(value);
    gsl_matrix_free(matrix);
}

static void see_invariants(struct survey *s, const double R[COLUMNS][COLUMNS], size_t at)
{
    double largest = 0, smallest;
    int rank;
    for (int i = 0; i < COLUMNS; i++)
        largest = fmax(largest, fabs(R[i][i]));
    for (int i = 0; i < COLUMNS; i++)
        for (int j = 0; j < COLUMNS; j++) {
            const double before = s->symmetry.error;
            worst_see(&s->symmetry, R[i][j], R[j][i], largest, at);
            if (s->symmetry.error != before)
                s->asymmetric = (struct entry){ THEORY_SCALARS, i / 3, j / 3 };
            if (i < 3)
                worst_see(&s->third_law, R[3 + i][j], -R[i][j], largest, at);
        }
    spectrum(R, s->allowance, &smallest, &rank);
    worst_see(&s->positive, fmin(smallest, 0), 0, 1, at);
    if (s->allowance < 1e-6)    /* with fewer digits small eigenvalues cannot be told from zero */
        worst_see(&s->rank, rank, s->modes, 1, at);
}

/* One geometry: its states start at `first` (random motion, rest, twelve columns). */
static void measure(struct survey *s, const struct model *m, const struct pair_book *book, const struct pair_answer *a,
                    size_t size, size_t gap)
{
    const size_t first = (size * s->gaps + gap) * STATES;
    const struct pair_state *p = &book->item[first];
    double answer[COLUMNS], R[COLUMNS][COLUMNS], R_theory[COLUMNS * COLUMNS], scaled_R[COLUMNS][COLUMNS], n[3], r, unit[3];
    for (int column = 0; column < COLUMNS; column++) {
        six(a, s->force, first + 2 + (size_t)column, answer);
        for (int i = 0; i < COLUMNS; i++)
            R[i][column] = -answer[i] / SPEED;
    }
    pair_geometry(p, n, &r);
    scaled(0.5 * r, (const double (*)[COLUMNS])R, scaled_R);
    see_invariants(s, (const double (*)[COLUMNS])scaled_R, first);

    struct expected e;
    expect_lubrication(m, p, &e);
    six(a, s->force, first + 1, answer);
    worst_see_vector(&s->rest, answer, (const double[COLUMNS]){ 0 }, COLUMNS, e.force_scale, first + 1);
    six(a, s->force, first, answer);
    for (int i = 0; i < COLUMNS; i++) {
        double linear = 0;
        for (int j = 0; j < COLUMNS; j++)
            linear -= R[i][j] * (j < 6 ? p->s[j / 3].u : p->s[j / 3 - 2].w)[j % 3];
        worst_see(&s->linear, answer[i], linear, i < 6 ? e.force_scale : e.torque_scale, first);
    }
    for (int k = 0; k < 3; k++)
        unit[k] = r * n[k];
    theory_pair_resistance(&m->lubrication, p->s[0].radius, p->s[1].radius, unit, R_theory);
    double rest[COLUMNS][COLUMNS], rest_theory[COLUMNS][COLUMNS], theory[COLUMNS][COLUMNS];
    memcpy(theory, R_theory, sizeof theory);
    memcpy(rest, R, sizeof rest);
    memcpy(rest_theory, theory, sizeof theory);
    for (int k = 0; k < ENTRIES; k++) {
        s->measured[k][size][gap] = project(&entries[k], n, rest, (const double (*)[COLUMNS])R);
        s->expected[k][size][gap] = project(&entries[k], n, rest_theory, (const double (*)[COLUMNS])theory);
    }
    scaled(0.5 * r, (const double (*)[COLUMNS])rest, rest);
    for (int i = 0; i < COLUMNS; i++)
        for (int j = 0; j < COLUMNS; j++)
            worst_see(&s->other, rest[i][j], 0, scaled_R[0][0] + scaled_R[1][1] + scaled_R[2][2], first);
}

static const char *entry_name(const struct entry *e)
{
    static char text[96];
    static const char *const rows[] = { "force on 1", "force on 2", "torque on 1", "torque on 2" };
    static const char *const columns[] = { "the velocity of 1", "the velocity of 2", "the spin of 1", "the spin of 2" };
    snprintf(text, sizeof text, "%s%s from %s", rows[e->row],
             e->coefficient == THEORY_XA ? " along n" : e->coefficient == THEORY_YA ? " across n" : "", columns[e->column]);
    return text;
}

/* Coefficients that could stand in each other's place: of the same dimension. */
static const char *stands_for(const struct survey *s, int k)
{
    static char text[64];
    static const int kind[THEORY_SCALARS] = { [THEORY_XA] = 0, [THEORY_YA] = 0, [THEORY_B1] = 1, [THEORY_B2] = 1, [THEORY_C11] = 2,
                                              [THEORY_C12] = 2, [THEORY_C22] = 2 };
    const int own = entries[k].coefficient;
    for (int other = 0; other < ENTRIES; other++) {
        const int c = entries[other].coefficient;
        bool same = c != own && kind[c] == kind[own];
        for (size_t b = 0; same && b < s->sizes; b++)
            for (size_t g = 0; same && g < s->gaps; g++)
                same = fabs(fabs(s->measured[k][b][g]) - fabs(s->expected[other][b][g])) <= 1e-6 * fabs(s->expected[other][b][g]);
        if (!same)
            continue;
        snprintf(text, sizeof text, "; it has the size of %s everywhere", theory_scalar_name[c]);
        return text;
    }
    return "";
}

/* Names the wrong entries with their patterns; entries that are wrong in the same way share one. */
static void judge_coefficient(struct check_run *run, const struct survey *s, int coefficient)
{
    const double tolerance = run->gate_case->tolerance;
    struct worst all = WORST_NONE;
    char sentence[WHY_LENGTH] = "", words[640], last[640] = "";
    int stands = 0, wrong = 0, ways = 0;
    for (int k = 0; k < ENTRIES; k++) {
        struct worst w = WORST_NONE;
        struct pattern pattern;
        if (entries[k].coefficient != coefficient)
            continue;
        pattern_start(&pattern, tolerance);
        for (size_t b = 0; b < s->sizes; b++)
            for (size_t g = 0; g < s->gaps; g++) {
                const double *measured = &s->measured[k][b][g], *expected = &s->expected[k][b][g];
                worst_see(&w, *measured, *expected, fabs(*expected), 0);
                pattern_see(&pattern, measured, expected, 1, fabs(*expected), s->ratio[b], s->xi[g], NULL, NULL);
            }
        stands++;
        if (!(w.error <= all.error))
            all = w;
        if (w.error <= tolerance)
            continue;
        wrong++;
        snprintf(words, sizeof words, "%s%s", pattern_words(&pattern), stands_for(s, k));
        const bool same = strcmp(words, last) == 0;
        ways += !same;
        size_t used = strlen(sentence);
        if (same) /* before the words that both share */
            used -= strlen(last) + 2;
        snprintf(sentence + used, sizeof sentence - used, "%s%s: %s", same ? " and " : used ? "; " : "", entry_name(&entries[k]),
                 words);
        snprintf(last, sizeof last, "%s", words);
    }
    if (stands > 1 && wrong == stands && ways == 1)
        snprintf(sentence, sizeof sentence, "wherever it stands in R: %s", last);
    check_error(run, MODEL, theory_scalar_name[coefficient], all.measured, all.expected, all.error, tolerance, "%s, %s",
                theory_scalar_name[coefficient], sentence);
}

static void judge(struct check_run *run, const struct pair_book *book, const char *what, const struct worst *w,
                  const char *sentence)
{
    check_error(run, INVARIANT, what, w->measured, w->expected, w->error, run->gate_case->tolerance, "%s: %s; worst at %s",
                sentence, compare(w), describe(&book->item[w->at], w->at));
}

static void judge_all(struct check_run *run, const struct survey *s, const struct model *m, const struct pair_book *book)
{
    judge(run, book, "zero at rest", &s->rest, "lubrication acts on a pair at rest");
    judge(run, book, "linear in velocity", &s->linear, "the force is not linear in the velocities");
    if (!m->has_drag)
        judge(run, book, "third law of R", &s->third_law, "an entry of R for the force on 2 is not minus that for 1");
    char fault[256], mirror[96];
    snprintf(mirror, sizeof mirror, "%s", entry_name(&(struct entry){ THEORY_SCALARS, s->asymmetric.column, s->asymmetric.row }));
    snprintf(fault, sizeof fault, "R is not symmetric, in the %s against the %s", entry_name(&s->asymmetric), mirror);
    judge(run, book, "R symmetric", &s->symmetry, fault);
    judge(run, book, "R positive semidefinite", &s->positive,
          "R has a negative eigenvalue, in units of its largest: some motion gains energy");
    if (s->rank.error < 0)
        check_skip(run, "rank of R", "numbers of so few digits do not tell resistance from rounding");
    else
        judge(run, book, "rank of R", &s->rank, "the number of modes that R resists is wrong");
    if (m->has_drag)
        return;
    judge(run, book, "no other terms in R", &s->other, "R has terms that isotropy about n forbids, or a resistance to twist");
    for (int c = 0; c < THEORY_SCALARS; c++)
        judge_coefficient(run, s, c);
}

static double entry_error(const struct survey *s, int k, size_t size)
{
    double error = 0;
    for (size_t g = 0; g < s->gaps; g++)
        error = fmax(error, fabs(s->measured[k][size][g] / s->expected[k][size][g] - 1));
    return error;
}

/* Picture: the seven coefficients over the gap for one unequal pair, each where it is worst, on the model's lines. */
static void draw(struct check_run *run, const struct survey *s)
{
    size_t size = 0;
    for (size_t b = 0; b < s->sizes; b++)
        if (fabs(s->ratio[b] - 1.4) < fabs(s->ratio[size] - 1.4))
            size = b;
    struct curve curve[THEORY_SCALARS];
    double shown[THEORY_SCALARS];
    for (int c = 0; c < THEORY_SCALARS; c++)
        shown[c] = -1;
    for (int k = 0; k < ENTRIES; k++) {
        const int c = entries[k].coefficient;
        if (entry_error(s, k, size) > shown[c] + 1e-6) { /* the first of equals */
            shown[c] = entry_error(s, k, size);
            curve[c] = (struct curve){ theory_scalar_name[c], s->measured[k][size], s->expected[k][size] };
        }
    }
    char path[PATH_LENGTH], title[96];
    path_join(path, run->work, "coefficients.svg");
    snprintf(title, sizeof title, "coefficients, a2/a1 = %.3g", s->ratio[size]);
    if (picture_curves(path, title, "gap xi", s->xi, s->gaps, curve, THEORY_SCALARS))
        result_picture(&run->results.item[run->results.count - 1], "coefficients.svg");
}

void pair_resistance(struct check_run *run)
{
    struct model m;
    if (!model_read(run, run->gate_case->scene, &m))
        return;
    struct pair_book book = { 0 };
    struct pair_answer answer = { 0 };
    struct survey *s = calloc(1, sizeof *s);
    s->rest = s->linear = s->third_law = s->symmetry = s->positive = s->rank = s->other = (struct worst)WORST_NONE;
    s->force = m.has_drag ? "total" : "lubrication";
    s->modes = m.has_drag ? COLUMNS : 5;
    fill_book(run, &m, s, &book);
    if (book_ask(run, "columns", run->gate_case->scene, &book, s->force, &answer)) {
        s->allowance = run->allowance;
        for (size_t b = 0; b < s->sizes; b++)
            for (size_t g = 0; g < s->gaps; g++)
                measure(s, &m, &book, &answer, b, g);
        judge_all(run, s, &m, &book);
        if (!m.has_drag)
            draw(run, s);
    }
    forces_free(&answer.forces);
    book_free(&book);
    free(s);
}
