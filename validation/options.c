/* See options.h. */
#include "options.h"

#include "versions.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char options_help[] =
    "gate: judges a program that computes suspension physics, through files\n"
    "\n"
    "  gate run --candidate COMMAND [options]   ask the cases, print verdicts, write a report\n"
    "  gate list [options]                      the cases that `run` would ask\n"
    "  gate export DIR [options]                write the questions to a folder, to be answered elsewhere (DIR/README.txt)\n"
    "  gate judge DIR [options]                 verdicts from the answers in it\n"
    "  gate explain [FLAG]                      a class of mistakes: what it is, what it does, where it was seen, which cases\n"
    "                                           would show it; without FLAG the list of classes\n"
    "  gate calibrate --candidate COMMAND --seeds N --table FILE [options]\n"
    "                                           the cases with p-values under N seeds, for a candidate that is right:\n"
    "                                           false verdicts and the spread of p; goes on where FILE ends\n"
    "  gate freeze                              write suite-" GATE_SUITE ".json: what this suite asks from now on, and how strictly\n"
    "\n"
    "  --candidate COMMAND   called as COMMAND CASE_DIR OUT_DIR (docs/adapter.md)\n"
    "  --capabilities FILE   what the candidate is (default: <program>.capabilities.json beside it, if there is one)\n"
    "  --level LEVEL         ask as if the candidate were of this level: A forces, B a few steps, C runs only\n"
    "  --layer LAYER         only this layer, by number or name: 1 pair, 2 noise, 3 single, 4 two-bodies, 5 dilute,\n"
    "                        6 dense, 7 published; several separated by commas\n"
    "  --case NAME           only these cases, separated by commas\n"
    "  --needs PHYSICS       only cases that need this: contact, drag, lubrication, ...\n"
    "  --tier TIER           fast (default), standard, full; each includes the ones before it\n"
    "  --jobs N              worker processes (default 1)\n"
    "  --stop-after N        end the run once N cases have failed\n"
    "  --patience FACTOR     time limits of the cases times this (default 1), for a slow candidate or machine\n"
    "  --suite VERSION       the suite as it was frozen, for example " GATE_SUITE ": newer cases only warn, and a case that has\n"
    "                        changed since is an error (default: the cases as they are)\n"
    "  --known FILE          failures that are accepted, with reason and expiry (docs/known.schema.json)\n"
    "  --seed-offset K       other seeds for everything random (default 0: those written in the cases)\n"
    "  --seeds N             calibrate: seed offsets 1 to N\n"
    "  --table FILE          calibrate: CSV with a row per seed\n"
    "  --keep DIR            finished realisations of long tables are kept there as CSV and not computed again (make golden)\n"
    "  --report DIR          index.html and junit.xml (default build/report)\n"
    "  --work DIR            what candidates are given and answer (default build/cases)\n"
    "  --suite-dir DIR       the folder that holds cases/ and flags.json (default: validation/, found from the program)\n"
    "\n"
    "Exit codes: 0 pass, 1 fail, 2 wrong usage, 3 only inconclusive, 77 nothing supported.\n";

int usage(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "gate: ");
    vfprintf(stderr, format, arguments);
    fprintf(stderr, "\n");
    va_end(arguments);
    return EXIT_USAGE;
}

/* 0, or the exit code after a message. */
static int whole_number(const char *option, const char *text, long least, long most, long *value)
{
    char *end;
    *value = strtol(text, &end, 10);
    const bool good = *text && *end == '\0' && *value >= least && *value <= most;
    return good ? 0 : usage("%s '%s' is no whole number from %ld to %ld", option, text, least, most);
}

int options_parse(struct options *o, const char *name, const char *value)
{
    long n;
    int code = 0;
    if (!value)
        return usage("%s needs a value", name);
    const struct { const char *name, **place; } texts[] = {
        { "--candidate", &o->candidate }, { "--capabilities", &o->capabilities }, { "--level", &o->level }, { "--layer", &o->layers },
        { "--case", &o->cases },          { "--needs", &o->needs },               { "--report", &o->report }, { "--keep", &o->keep },
        { "--table", &o->table },         { "--work", &o->work },                 { "--suite", &o->suite }, { "--known", &o->known },
    };
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++)
        if (strcmp(name, texts[k].name) == 0) {
            *texts[k].place = value;
            return 0;
        }
    if (strcmp(name, "--suite-dir") == 0)
        snprintf(o->suite_dir, sizeof o->suite_dir, "%s", value);
    else if (strcmp(name, "--tier") == 0)
        return tier_parse(value, &o->tier) ? 0 : usage("there is no tier '%s'; there are fast, standard, full", value);
    else if (strcmp(name, "--jobs") == 0) {
        code = whole_number(name, value, 1, 256, &n);
        o->jobs = (int)n;
    } else if (strcmp(name, "--stop-after") == 0) {
        code = whole_number(name, value, 1, 1000, &n);
        o->stop_after = (int)n;
    } else if (strcmp(name, "--patience") == 0) {
        char *end;
        o->patience = strtod(value, &end);
        if (end == value || *end || !(o->patience > 0 && o->patience <= 1e6))
            return usage("--patience '%s' is no number above 0", value);
    } else if (strcmp(name, "--seed-offset") == 0) {
        code = whole_number(name, value, 0, 2147483647, &n);
        o->seed_offset = (unsigned)n;
    } else if (strcmp(name, "--seeds") == 0) {
        code = whole_number(name, value, 1, 1000000, &n);
        o->seeds = (unsigned)n;
    } else
        return usage("unknown option '%s'; see gate --help", name);
    return code;
}

/* Whether `word` is one of the comma-separated `list`. */
static bool in_list(const char *list, const char *word)
{
    for (const size_t length = strlen(word); *list;) {
        const size_t n = strcspn(list, ",");
        if (n == length && strncmp(list, word, n) == 0)
            return true;
        list += n + (list[n] == ',');
    }
    return false;
}

bool options_want(const struct options *o, const struct gate_case *c)
{
    char number[2] = { (char)('0' + c->layer), '\0' };
    return c->tier <= o->tier && (!o->calibrating || c->p_values > 0) && (!o->cases || in_list(o->cases, c->name)) && (!o->needs || case_lists(c->needs, o->needs))
           && (!o->layers || in_list(o->layers, layer_name(c->layer)) || in_list(o->layers, number));
}

/* A word that no case names, and those that some do. */
static int check_needs(const char *needs, const struct suite_of_cases *suite)
{
    json_t *words = json_object();
    char list[1024] = "";
    for (size_t k = 0; k < suite->count; k++) {
        size_t n;
        json_t *word;
        json_array_foreach(suite->item[k].needs, n, word)
            json_object_set_new(words, json_string_value(word), json_true());
    }
    const bool known = json_object_get(words, needs) != NULL;
    const char *word;
    json_t *value;
    json_object_foreach(words, word, value)
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", *list ? ", " : "", word);
    json_decref(words);
    return known ? 0 : usage("--needs '%s': no case names this as what it is about; some name %s", needs, list);
}

int options_check(const struct options *o, const struct suite_of_cases *suite)
{
    char word[128];
    enum layer layer;
    for (const char *at = o->layers ? o->layers : ""; *at; at += strcspn(at, ","), at += *at == ',') {
        snprintf(word, sizeof word, "%.*s", (int)strcspn(at, ","), at);
        if (!layer_parse(word, &layer))
            return usage("there is no layer '%s'; see gate --help", word);
    }
    for (const char *at = o->cases ? o->cases : ""; *at; at += strcspn(at, ","), at += *at == ',') {
        bool known = false;
        snprintf(word, sizeof word, "%.*s", (int)strcspn(at, ","), at);
        for (size_t k = 0; k < suite->count; k++)
            known = known || strcmp(suite->item[k].name, word) == 0;
        if (!known)
            return usage("there is no case '%s'; see gate list --tier full", word);
    }
    return o->needs ? check_needs(o->needs, suite) : 0;
}
