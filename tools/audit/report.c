/* Books of the audit: one line for each quantity, with its worst value. */
#include "audit.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct {
    const char *what, *how, *reason;
    double tolerance, worst, theory, audit;
    long values;
    char where[120];
} now;
static char covered[4096] = " ", worst_name[120], broken[2048];
static long values, faults, quantities;
static double worst_difference, worst_share;    /* difference, and of what is allowed the largest share; of second derivations, that is, of narrow bars */
static long coarse;                             /* quantities that confirm only to per mille or per cent: the exact series */
static const double narrow = 1e-5;

static void close_quantity(void)
{
    if (!now.what)
        return;
    const bool good = now.worst <= now.tolerance;
    if (now.values > 0)
        printf("%s %-46s %6ld values  theory %.17g  audit %.17g  difference %.1e  allowed %.0e: %s  [%s]%s%s\n", good ? "ok  " : "FAIL", now.what,
               now.values, now.theory, now.audit, now.worst, now.tolerance, now.reason, now.how, good ? "" : "  worst at ", good ? "" : now.where);
    if (now.values == 0 || !good) {
        faults++;
        if (now.values == 0)
            printf("FAIL %s: no value was compared\n", now.what);
        snprintf(broken + strlen(broken), sizeof broken - strlen(broken), "%s%s", *broken ? ", " : "", now.what);
    }
    quantities++;
    values += now.values;
    coarse += now.tolerance > narrow;
    if (now.worst > worst_difference && now.tolerance <= narrow)
        worst_difference = now.worst;
    if (now.worst / now.tolerance > worst_share && now.tolerance <= narrow) {
        worst_share = now.worst / now.tolerance;
        snprintf(worst_name, sizeof worst_name, "%s", now.what);
    }
    fflush(stdout);
    now.what = NULL;
}

void audit_quantity(const char *what, const char *how, double tolerance, const char *reason, const char *functions)
{
    close_quantity();
    memset(&now, 0, sizeof now);
    now.what = what;
    now.how = how;
    now.tolerance = tolerance;
    now.reason = reason;
    now.worst = -1.0;
    snprintf(covered + strlen(covered), sizeof covered - strlen(covered), "%s ", functions);
}

void audit_see(double theory, quad audit, double scale, const char *where)
{
    const double error = (quad)theory == audit ? 0.0 : (double)fabsq(((quad)theory - audit) / (quad)scale);
    now.values++;
    if (error <= now.worst)
        return;
    now.worst = isnan(error) ? (double)INFINITY : error;
    now.theory = theory;
    now.audit = (double)audit;
    snprintf(now.where, sizeof now.where, "%s", where ? where : "");
}

void audit_see_list(const double *theory, const quad *audit, int count, double scale, const char *where)
{
    for (int k = 0; k < count; k++)
        audit_see(theory[k], audit[k], scale, where);
}

void audit_fault(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    printf("FAIL ");
    vprintf(format, arguments);
    printf("\n");
    va_end(arguments);
    faults++;
    snprintf(broken + strlen(broken), sizeof broken - strlen(broken), "%s%s", *broken ? ", " : "", now.what ? now.what : "input");
}

/* Functions that the header declares and no quantity covers: "2 functions: theory_a, theory_b". */
static int uncovered(const char *header, char *text, size_t room)
{
    FILE *file = header ? fopen(header, "r") : NULL;
    char line[512];
    int count = 0;
    text[0] = '\0';
    if (!header)
        return 0;
    if (!file) {
        audit_fault("cannot read %s", header);
        return 0;
    }
    while (fgets(line, sizeof line, file))
        for (char *at = line; (at = strstr(at, "theory_")) != NULL;) {
            char name[80];
            size_t n = strspn(at, "abcdefghijklmnopqrstuvwxyz0123456789_");
            snprintf(name, sizeof name, " %.*s ", (int)n, at);
            const bool called = at[n] == '(', first = at == line || !(isalnum((unsigned char)at[-1]) || at[-1] == '_');
            at += n;
            if (!called || !first || strstr(covered, name))
                continue;
            name[strlen(name) - 1] = '\0';
            snprintf(text + strlen(text), room - strlen(text), "%s%s", count++ ? "," : "", name);
        }
    fclose(file);
    return count;
}

int audit_close(const char *header)
{
    char names[2048];
    close_quantity();
    const int without = uncovered(header, names, sizeof names);
    if (faults)
        printf("not met: %s\n", broken);
    printf("audit: %ld values of %ld quantities, worst relative difference %.1e, at most %.2f of what is allowed (%s), and %ld coarse confirmations by the exact "
           "series; %ld bars not met; ",
           values, quantities - coarse, worst_difference, worst_share, worst_name, coarse, faults);
    if (header)
        printf("%d quantities without a second derivation:%s\n", without, without ? names : " none");
    else
        printf("some areas only\n");
    return faults > 0;
}
