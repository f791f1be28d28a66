/*
 * compare-checkpoints A B: how far two runs of the same scene are from each other, from their checkpoints alone.
 *
 * Prints one line per quantity: the largest difference of any component of any particle over the largest component of A; positions as a
 * length, up to whole cells (where a run wraps is its own affair); contact histories by pair.
 * Reads the file by its description (named fields: 40 bytes of name, 8 of size, bytes), not with the program's code.
 */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HEAD = 16 + 4 + 4 + 8, NAME = 40 };

struct file { unsigned char *bytes; size_t size; };

static struct file read_file(const char *path)
{
    struct file f = { NULL, 0 };
    FILE *in = fopen(path, "rb");
    if (!in || fseek(in, 0, SEEK_END) != 0) {
        fprintf(stderr, "compare-checkpoints: %s cannot be read\n", path);
        exit(2);
    }
    f.size = (size_t)ftell(in);
    rewind(in);
    f.bytes = malloc(f.size + 1);
    if (!f.bytes || fread(f.bytes, 1, f.size, in) != f.size || f.size < HEAD || memcmp(f.bytes, "shear checkpoint", 16) != 0) {
        fprintf(stderr, "compare-checkpoints: %s is no checkpoint\n", path);
        exit(2);
    }
    fclose(in);
    return f;
}

/* A copy of a field, aligned, and its size; NULL if the file has none of that name. */
static void *field(const struct file *f, const char *name, size_t *size)
{
    size_t at = HEAD;
    while (at + NAME + 8 <= f->size) {
        uint64_t length;
        memcpy(&length, f->bytes + at + NAME, sizeof length);
        if (strncmp((const char *)f->bytes + at, name, NAME) == 0) {
            void *copy = malloc((size_t)length + 1);
            memcpy(copy, f->bytes + at + NAME + 8, (size_t)length);
            *size = (size_t)length;
            return copy;
        }
        at += NAME + 8 + (size_t)length;
    }
    return NULL;
}

static double largest(const double *x, int n)
{
    double most = 0.0;
    for (int k = 0; k < n; k++)
        most = fabs(x[k]) <= most ? most : fabs(x[k]);          /* NaN stays */
    return most;
}

static bool print(const char *name, double difference, double scale, double limit)
{
    const double relative = scale > 0.0 ? difference / scale : difference;
    printf("%-10s %.3g\n", name, relative);
    return relative <= limit;
}

static bool compare_vectors(const char *name, const struct file *A, const struct file *B, double limit)
{
    size_t size, other;
    double *a = field(A, name, &size), *b = field(B, name, &other);
    bool good = (!a && !b) || (a && b && size == other);
    if (good && a) {
        const int n = (int)(size / sizeof *a);
        const double scale = largest(a, n);
        for (int k = 0; k < n; k++)
            b[k] -= a[k];
        good = print(name, largest(b, n), scale, limit);
    }
    free(a);
    free(b);
    return good;
}

/* d less the nearest vector of the lattice with the columns A (along x), B (in the xy plane) and C of H. */
static void reduce(double d[3], const double H[9])
{
    for (int c = 2; c >= 0; c--) {
        const double times = round(d[c] / H[4 * c]);
        for (int r = 0; r < 3; r++)
            d[r] -= times * H[3 * r + c];
    }
}

static bool compare_positions(const struct file *A, const struct file *B, double limit)
{
    size_t size, other;
    double *x = field(A, "position", &size), *y = field(B, "position", &other), *H = field(A, "box.cell", &(size_t){ 0 }), worst = 0.0;
    bool good = x && y && H && size == other;
    for (size_t i = 0; good && i < size / sizeof *x; i += 3) {
        double d[3] = { y[i] - x[i], y[i + 1] - x[i + 1], y[i + 2] - x[i + 2] };
        reduce(d, H);
        worst = largest(d, 3) <= worst ? worst : largest(d, 3);
    }
    good = good && print("position", worst, 1.0, limit);
    free(x);
    free(y);
    free(H);
    return good;
}

struct contact { int i, j; double h[3]; };

static int by_pair(const void *left, const void *right)
{
    const struct contact *a = left, *b = right;
    return a->i != b->i ? (a->i > b->i) - (a->i < b->i) : (a->j > b->j) - (a->j < b->j);
}

static struct contact *contacts_of(const struct file *f, int *count)
{
    size_t size, candidates;
    unsigned char *c = field(f, "neighbours.candidate", &candidates);
    double *h = field(f, "neighbours.history", &size);
    const int n = h ? (int)(size / 24) : 0;
    struct contact *all = malloc(((size_t)n + 1) * sizeof *all);
    *count = 0;
    for (int k = 0; k < n; k++)
        if (h[3 * k] != 0.0 || h[3 * k + 1] != 0.0 || h[3 * k + 2] != 0.0) {
            int ends[2];
            memcpy(ends, c + (candidates / (size_t)n) * (size_t)k, sizeof ends);
            all[(*count)++] = (struct contact){ ends[0], ends[1], { h[3 * k], h[3 * k + 1], h[3 * k + 2] } };
        }
    qsort(all, (size_t)*count, sizeof *all, by_pair);
    free(c);
    free(h);
    return all;
}

static bool compare_contacts(const struct file *A, const struct file *B, double limit)
{
    int n, m;
    struct contact *a = contacts_of(A, &n), *b = contacts_of(B, &m);
    double worst = 0.0, scale = 0.0;
    bool same = n == m;
    for (int k = 0; same && k < n; k++) {
        same = by_pair(&a[k], &b[k]) == 0;
        for (int c = 0; c < 3; c++) {
            scale = fmax(scale, fabs(a[k].h[c]));
            worst = fmax(worst, fabs(a[k].h[c] - b[k].h[c]));
        }
    }
    printf("contacts   %d and %d with a history%s\n", n, m, same ? "" : ": not the same");
    free(a);
    free(b);
    return same && print("history", worst, scale, limit);
}

int main(int argc, char **argv)
{
    if (argc != 5) {
        fputs("usage: compare-checkpoints A B FORCE_LIMIT POSITION_LIMIT\n"
              "Forces, torques, spins and histories relative to the largest of A, positions as a length. Exit code 1 where a limit is missed.\n", stderr);
        return 2;
    }
    const struct file A = read_file(argv[1]), B = read_file(argv[2]);
    const double force = strtod(argv[3], NULL), position = strtod(argv[4], NULL);
    size_t size, other;
    int64_t *a = field(&A, "step", &size), *b = field(&B, "step", &other);
    bool good = a && b && *a == *b;
    printf("step       %lld and %lld\n", a ? (long long)*a : -1, b ? (long long)*b : -1);
    good &= compare_vectors("force", &A, &B, force);
    good &= compare_vectors("torque", &A, &B, force);
    good &= compare_vectors("spin", &A, &B, force);
    good &= compare_contacts(&A, &B, force);
    good &= compare_positions(&A, &B, position);
    free(a);
    free(b);
    free(A.bytes);
    free(B.bytes);
    return good ? 0 : 1;
}
