#include "output/checkpoint.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

enum { VERSION = 1, NAME = 40 };
static const char magic[16] = "shear checkpoint";
static const uint32_t byte_order = 0x01020304;

/* ---- the one table ---- */

static void particle_fields(struct fields *f, struct particles *p)
{
    const size_t n = (size_t)p->count;
    fields_add(f, "tag", p->tag, n * sizeof *p->tag);
    fields_add(f, "species", p->species, n * sizeof *p->species);
    fields_add(f, "image", p->image, n * sizeof *p->image);
    fields_add(f, "position", p->position, n * sizeof(vec3));
    fields_add(f, "velocity", p->velocity, n * sizeof(vec3));
    fields_add(f, "force", p->force, n * sizeof(vec3));
    if (p->body)
        fields_add(f, "body", p->body, n * sizeof *p->body);
    if (p->spin)
        fields_add(f, "spin", p->spin, n * sizeof(vec3));
    if (p->torque)
        fields_add(f, "torque", p->torque, n * sizeof(vec3));
    if (p->turn)
        fields_add(f, "turn", p->turn, n * sizeof(vec3));
    if (p->anchor)                                  /* the file of the start may have changed since */
        fields_add(f, "anchor", p->anchor, n * sizeof(vec3));
}

static void box_fields(struct fields *f, struct box *b)
{
    fields_add(f, "box.start", &b->start, sizeof b->start);
    fields_add(f, "box.cell", &b->cell, sizeof b->cell);
    fields_add(f, "box.inverse", &b->inverse, sizeof b->inverse);
    fields_add(f, "box.lattice", &b->lattice, sizeof b->lattice);
    fields_add(f, "box.volume", &b->volume, sizeof b->volume);
    fields_add(f, "box.time", &b->time, sizeof b->time);
}

static void neighbour_fields(struct fields *f, struct neighbours *n, int particles)
{
    fields_add(f, "neighbours.skin", &n->skin, sizeof n->skin);
    fields_add(f, "neighbours.count", &n->count, sizeof n->count);
    fields_add(f, "neighbours.offset_count", &n->offset_count, sizeof n->offset_count);
    fields_add(f, "neighbours.listed_time", &n->listed_time, sizeof n->listed_time);
    fields_add(f, "neighbours.made", &n->made, sizeof n->made);
    fields_add(f, "neighbours.steps_since", &n->steps_since, sizeof n->steps_since);
    fields_add(f, "neighbours.listed_at", n->listed_at, (size_t)particles * sizeof *n->listed_at);
    fields_grown(f, "neighbours.candidate", &n->candidate, (size_t)n->count * sizeof *n->candidate);
    fields_grown(f, "neighbours.offset", &n->offset, (size_t)n->offset_count * sizeof *n->offset);
    if (n->keeps_history)
        fields_grown(f, "neighbours.history", &n->history, (size_t)n->count * sizeof *n->history);
}

static void all_fields(struct fields *f, const struct checkpoint *c)
{
    struct suspension *s = c->of;
    f->count = 0;
    fields_add(f, "particles.count", &s->particles.count, sizeof s->particles.count);
    fields_add(f, "step", &s->step, sizeof s->step);
    fields_add(f, "dt", &s->dt, sizeof s->dt);
    box_fields(f, &s->box);
    particle_fields(f, &s->particles);
    neighbour_fields(f, &s->neighbours, s->particles.count);
    for (int k = 0; k < *c->observer_count; k++)
        if (c->observer[k]->remember)
            c->observer[k]->remember(c->observer[k], f);
}

/* ---- writing ---- */

/* CRC-32 of a stretch of bytes, going on from `crc` (0 at the start): polynomial 0x04C11DB7, bits reflected. */
static uint32_t crc_of(uint32_t crc, const void *bytes, size_t size)
{
    static uint32_t table[256];
    for (uint32_t k = 0; table[255] == 0 && k < 256; k++) {
        uint32_t c = k;
        for (int bit = 0; bit < 8; bit++)
            c = c & 1 ? 0xEDB88320u ^ c >> 1 : c >> 1;
        table[k] = c;
    }
    const unsigned char *b = bytes;
    crc = ~crc;
    for (size_t k = 0; k < size; k++)
        crc = table[(crc ^ b[k]) & 255u] ^ crc >> 8;
    return ~crc;
}

struct writer { FILE *file; uint32_t crc; };

static void put(struct writer *w, const void *bytes, size_t size)
{
    if (size > 0)
        fwrite(bytes, 1, size, w->file);
    w->crc = crc_of(w->crc, bytes, size);
}

/* Pointers to arrays are copied as bytes: the table does not know their types. */
static void *bytes_of(const struct field *f)
{
    void *array = f->at;
    if (f->grown)
        memcpy(&array, f->grown, sizeof array);
    return array;
}

static void put_all(struct writer *w, const struct checkpoint *c, const struct fields *f)
{
    const uint32_t version = VERSION;
    put(w, magic, sizeof magic);
    put(w, &version, sizeof version);
    put(w, &byte_order, sizeof byte_order);
    put(w, &c->fingerprint, sizeof c->fingerprint);
    for (int k = 0; k < f->count; k++) {
        char name[NAME] = "";
        const uint64_t size = f->field[k].size;
        snprintf(name, sizeof name, "%s", f->field[k].name);
        put(w, name, sizeof name);
        put(w, &size, sizeof size);
        put(w, bytes_of(&f->field[k]), f->field[k].size);
    }
    const uint32_t crc = w->crc;
    put(w, &crc, sizeof crc);
}

static bool checkpoint_save(struct checkpoint *c, struct error *e)
{
    char path[440], fresh[440];
    struct fields *f = malloc(sizeof *f);
    struct stat there;
    if (!f)
        return error_out_of_memory(e);
    snprintf(path, sizeof path, "%s/checkpoint.bin", c->to->folder);
    snprintf(fresh, sizeof fresh, "%s/checkpoint.tmp", c->to->folder);
    all_fields(f, c);
    struct writer w = { NULL, 0 };
    if (f->count > MAX_FIELDS)
        error_raise(e, ERROR_RUN, "a checkpoint has room for %d fields; this scene has %d", MAX_FIELDS, f->count);
    else if (lstat(path, &there) == 0 && !S_ISREG(there.st_mode))
        error_raise(e, ERROR_RUN, "%s is in the way and no plain file: no checkpoint is written", path);
    else if (!(w.file = fopen(fresh, "wb")))
        error_raise(e, ERROR_RUN, "%s cannot be written: %s", fresh, strerror(errno));
    else {
        put_all(&w, c, f);
        const bool written = fflush(w.file) == 0 && !ferror(w.file) && fsync(fileno(w.file)) == 0;
        if ((fclose(w.file) != 0) | !written || rename(fresh, path) != 0)
            error_raise(e, ERROR_RUN, "%s could not be written in full: %s; the checkpoint before, if any, still stands", fresh, strerror(errno));
        /* The new name too must reach the disk before anybody relies on it. */
        const int folder = open(c->to->folder, O_RDONLY);
        if (folder >= 0) {
            fsync(folder);
            close(folder);
        }
    }
    free(f);
    return !error_raised(e);
}

/* ---- reading ---- */

static bool read_whole(struct checkpoint *c, const char *path, struct error *e)
{
    FILE *in = fopen(path, "rb");
    struct stat info;
    if (!in || fstat(fileno(in), &info) != 0 || info.st_size < 0) {
        if (in)
            fclose(in);
        return error_raise(e, ERROR_INPUT, "%s cannot be read: %s; without it there is nothing to resume", path, strerror(errno));
    }
    c->read_size = (size_t)info.st_size;
    c->read = malloc(c->read_size + 1);
    const bool good = c->read && fread(c->read, 1, c->read_size, in) == c->read_size;
    fclose(in);
    return good || error_raise(e, ERROR_RUN, "%s could not be read in full", path);
}

/* The next bytes of what was read; false past its end. */
static bool take(const struct checkpoint *c, size_t *from, void *to, size_t size)
{
    if (size > c->read_size - *from)
        return false;
    if (size > 0)
        memcpy(to, c->read + *from, size);
    *from += size;
    return true;
}

bool checkpoint_read(struct checkpoint *c, struct error *e)
{
    char path[440], found[sizeof magic];
    uint32_t version, order, crc;
    uint64_t fingerprint;
    size_t from = 0, end;
    if (!c->to->resuming)
        return true;
    snprintf(path, sizeof path, "%s/checkpoint.bin", c->to->folder);
    if (!read_whole(c, path, e))
        return false;
    if (!take(c, &from, found, sizeof found) || memcmp(found, magic, sizeof magic) != 0)
        return error_raise(e, ERROR_INPUT, "%s is no checkpoint of shear", path);
    if (!take(c, &from, &version, sizeof version) || !take(c, &from, &order, sizeof order) || !take(c, &from, &fingerprint, sizeof fingerprint))
        return error_raise(e, ERROR_INPUT, "%s is cut short", path);
    if (order != byte_order)
        return error_raise(e, ERROR_INPUT, "%s was written on a machine of the other byte order", path);
    if (version != VERSION)
        return error_raise(e, ERROR_INPUT, "%s has format version %u; this program reads %d", path, version, VERSION);
    if (fingerprint != c->fingerprint)
        return error_raise(e, ERROR_INPUT, "%s belongs to another scene (fingerprint %016llx; this one has %016llx): only run and output.checkpoint "
                           "may differ", path, (unsigned long long)fingerprint, (unsigned long long)c->fingerprint);
    end = c->read_size - sizeof crc;                /* the header alone is longer */
    memcpy(&crc, c->read + end, sizeof crc);
    return crc == crc_of(0, c->read, end) || error_raise(e, ERROR_INPUT, "%s is damaged or cut short: its checksum does not match", path);
}

/* One row out of the file; the order and the names are those of the table that wrote it. */
static bool load_field(const struct checkpoint *c, size_t *from, const struct field *to, struct error *e)
{
    char name[NAME];
    uint64_t size;
    if (!take(c, from, name, NAME) || !take(c, from, &size, sizeof size) || strncmp(name, to->name, NAME) != 0)
        return error_raise(e, ERROR_INPUT, "checkpoint: \"%s\" is not where this program looks for it", to->name);
    if (size > c->read_size - *from || (!to->grown && size != to->size))
        return error_raise(e, ERROR_INPUT, "checkpoint: \"%s\" has %llu bytes where %zu are needed", to->name, (unsigned long long)size, to->size);
    if (to->grown) {
        void *room = realloc(bytes_of(to), (size_t)size + 1);
        if (!room)
            return error_out_of_memory(e);
        memcpy(to->grown, &room, sizeof room);
    }
    return take(c, from, bytes_of(to), (size_t)size);
}

/* What follows from the rows: the flow of the moment, room for the pairs, and the pairs themselves for who looks at them. */
static bool settle(struct suspension *s, struct error *e)
{
    struct neighbours *n = &s->neighbours;
    struct near_pairs *near = &n->near;
    const long steps_since = n->steps_since;
    bool relisted;
    box_set_time(&s->box, s->box.time);
    n->room = n->count;
    near->room = n->count + 1;
    free(near->pair);
    free(near->resistance);
    near->pair = malloc((size_t)near->room * sizeof *near->pair);
    near->resistance = near->keeps_resistance ? malloc((size_t)near->room * sizeof *near->resistance) : NULL;
    if (!near->pair || (near->keeps_resistance && !near->resistance))
        return error_out_of_memory(e);
    n->steps_since = 0;                             /* nothing has moved: this search makes no list */
    const bool found = neighbours_find(n, &s->box, &s->particles, &relisted, e);
    n->steps_since = steps_since;                   /* this search is one that the undisturbed run did not make */
    return found;
}

bool checkpoint_apply(struct checkpoint *c, struct error *e)
{
    struct fields *f = malloc(sizeof *f);
    size_t from = sizeof magic + 2 * sizeof(uint32_t) + sizeof(uint64_t);
    if (!f)
        return error_out_of_memory(e);
    all_fields(f, c);
    for (int k = 0; k < f->count && f->count <= MAX_FIELDS && load_field(c, &from, &f->field[k], e); k++)
        ;
    if (!error_raised(e) && from + sizeof(uint32_t) != c->read_size)
        error_raise(e, ERROR_INPUT, "checkpoint: it holds more than this program looks for");
    for (int k = 0; k < f->count && !error_raised(e); k++)
        if (f->field[k].loaded)
            f->field[k].loaded(f->field[k].owner, e);
    free(f);
    return !error_raised(e) && settle(c->of, e);
}

/* ---- when ---- */

static volatile sig_atomic_t stop_wanted;

static void want_stop(int signal_number)
{
    (void)signal_number;
    stop_wanted = 1;
}

void checkpoint_watch(void)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = want_stop;
    action.sa_flags = (int)SA_RESETHAND;            /* a second Ctrl-C ends the program at once */
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    sigaction(SIGUSR1, &action, NULL);
    signal(SIGXFSZ, SIG_IGN);                       /* a limit on file sizes then shows as an error of the file, which we name */
}

bool checkpoint_wanted(void) { return stop_wanted != 0; }

bool checkpoint_keep(struct checkpoint *c, bool last, struct error *e)
{
    const int64_t step = c->of->step;
    const bool stop = stop_wanted && !last, due = c->every > 0 && (last || step % c->every == 0);
    if ((due || (stop && *c->to->folder)) && !checkpoint_save(c, e))
        return false;
    if (!stop)
        return true;
    stop_wanted = 0;
    return error_raise(e, ERROR_INTERRUPTED, *c->to->folder ? "interrupted after step %lld; --resume goes on from there"
                                                            : "interrupted after step %lld", (long long)step);
}

void checkpoint_free(struct checkpoint *c)
{
    free(c->read);
    c->read = NULL;
}
