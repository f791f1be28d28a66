#include "forces/friction.h"

#include <stddef.h>

struct grip friction_plain(const struct friction_rule *f, double load, int a, int b)
{
    (void)a, (void)b;
    return (struct grip){ f->coefficient * load, true };
}

struct grip friction_critical(const struct friction_rule *f, double load, int a, int b)
{
    (void)a, (void)b;
    return load >= f->critical_load ? (struct grip){ f->coefficient * load, true } : (struct grip){ 0.0, false };
}

struct grip friction_soft(const struct friction_rule *f, double load, int a, int b)
{
    (void)a, (void)b;
    return (struct grip){ f->coefficient * load * (load < f->critical_load ? load / f->critical_load : 1.0), true };
}

struct grip friction_shifted(const struct friction_rule *f, double load, int a, int b)
{
    (void)a, (void)b;
    return load >= f->critical_load ? (struct grip){ f->coefficient * (load - f->critical_load), true } : (struct grip){ 0.0, false };
}

struct grip friction_binary(const struct friction_rule *f, double load, int a, int b)
{
    return f->rough[a] && f->rough[b] ? (struct grip){ f->coefficient * load, true } : (struct grip){ 0.0, false };
}

void friction_read(struct friction_rule *f, double coefficient, const struct particles *p, struct settings *s, struct error *e)
{
    static const char *const names[] = { "plain", "critical", "soft", "shifted", "binary", NULL };
    static friction_law *const laws[] = { friction_plain, friction_critical, friction_soft, friction_shifted, friction_binary };
    const int chosen = settings_has(s, "law") ? settings_choice(s, "law", names, e) : 0;
    f->law = laws[chosen];
    f->coefficient = coefficient;
    if (chosen >= 1 && chosen <= 3)
        f->critical_load = settings_at_least(s, "critical_load", 0.0, e);
    if (chosen == 4)
        settings_flags(s, "rough", f->rough, p->species_count, e);
}
